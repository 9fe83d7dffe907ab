import { ask } from './api';
import type { Overlay } from './overlay';
import { element } from './element';

interface Worlds {
  worlds: {
    p: number;
    differs: {
      object: string;
      change: 'absent' | 'present' | 'class' | 'moved';
      class?: string;
      position?: number[];
    }[];
  }[];
}

/** Steps through competing explanations: in each, what differs from the best one, as ghosts. */
export class Explanations {
  private index = 0;
  private readonly now = element('world-now');

  constructor(
    private readonly overlay: Overlay,
    private readonly time: () => number | undefined,
    private readonly draw: () => void,
  ) {
    element('world-back').onclick = () => this.step(-1);
    element('world-on').onclick = () => this.step(1);
  }

  private async step(by: number): Promise<void> {
    const at = this.time();
    const { worlds } = await ask<Worlds>('/v1/hypotheses', { limit: 20, ...(at ? { at } : {}) });
    this.index = Math.max(0, Math.min(worlds.length - 1, this.index + by));
    const world = worlds[this.index];
    if (!world) return;
    const name = this.index === 0 ? 'the best' : `number ${this.index + 1}`;
    const changes = world.differs.map(({ object, change, class: kind }) =>
      `${object} ${change === 'class' ? 'is a ' + kind : change}`);
    this.now.textContent = [`${name}, ${world.p.toPrecision(2)}`, ...changes].join('; ');
    this.overlay.haunt(
      world.differs.flatMap(({ object, change, position }) =>
        position ? [{ position, p: Math.max(0.2, world.p), text: `${object}: ${change}` }] : []),
    );
    this.draw();
  }
}
