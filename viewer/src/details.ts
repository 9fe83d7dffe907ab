import { ask, type Detailed, type Mixture } from './api';
import type { Overlay } from './overlay';

interface History {
  samples: { utime: number; p?: number; position?: number[]; place?: string | null }[];
}

/** The panel of one object: what is believed of it, its models, its past, where else it may be. */
export class Details {
  private shown: string | null = null;

  constructor(
    private readonly panel: HTMLElement,
    private readonly overlay: Overlay,
    private readonly onClose: () => void,
  ) {}

  close(): void {
    this.shown = null;
    this.panel.hidden = true;
    this.overlay.haunt([]);
  }

  /** As of a time; live without one. */
  async show(id: string, at?: number): Promise<void> {
    this.shown = id;
    const when: Record<string, number> = at ? { at } : {};
    try {
      const object = await ask<Detailed>('/v1/objects/' + encodeURIComponent(id), when);
      if (this.shown !== id) return; // another one was clicked meanwhile
      this.write(object);
      const history = await ask<History>('/v1/history', { object: id, ...(at ? { to: at } : {}) });
      if (this.shown !== id) return;
      const past = history.samples.flatMap((sample) => (sample.position ? [sample.position] : []));
      this.overlay.haunt(
        object.alternatives
          .slice(object.alternatives.length > 1 ? 0 : 1)
          .map(({ position, p, place }) => ({ position, p, text: `${p.toFixed(2)} ${place ?? ''}` })),
        past,
      );
    } catch (error) {
      this.panel.replaceChildren(this.head(id), paragraph((error as Error).message));
      this.panel.hidden = false;
    }
  }

  private write(object: Detailed): void {
    const parts: HTMLElement[] = [
      this.head(object.id),
      paragraph(`exists with ${object.p.toFixed(3)}`),
      paragraph(`${object.place?.replaceAll('_', ' ') ?? 'outside every place'} (${object.position.map((x) => x.toFixed(2)).join(', ')}) m`),
      paragraph('last seen ' + new Date(object.last_seen / 1000).toLocaleString() +
        (object.seen?.sensor ? ' by ' + object.seen.sensor : '')),
    ];
    for (const [name, belief] of Object.entries(object.attributes)) {
      parts.push(heading(name));
      if ('mean' in belief && 'variance' in belief) parts.push(paragraph(mixture(belief as Mixture)));
      else parts.push(...bars(belief as Record<string, number>));
    }
    parts.push(heading('behaviour'));
    const models: Record<string, number> = {};
    for (const model of object.models) {
      const name = model.kind.replaceAll('_', ' ') + (model.place ? ' ' + model.place : '');
      models[name] = (models[name] ?? 0) + model.weight;
    }
    parts.push(...bars(models));
    if (object.alternatives.length > 1) {
      parts.push(heading('it may be'));
      parts.push(...bars(Object.fromEntries(object.alternatives.map(
        (other, i) => [`${i + 1}. ${other.class} ${other.place ?? ''}`, other.p]))));
    }
    this.panel.replaceChildren(...parts);
    this.panel.hidden = false;
  }

  private head(id: string): HTMLElement {
    const row = document.createElement('div');
    row.className = 'row';
    const name = document.createElement('strong');
    name.className = 'grow';
    name.textContent = id;
    const close = document.createElement('button');
    close.type = 'button';
    close.textContent = '×';
    close.setAttribute('aria-label', 'close');
    close.onclick = () => this.onClose();
    row.append(name, close);
    return row;
  }
}

function paragraph(text: string): HTMLElement {
  const p = document.createElement('div');
  p.textContent = text;
  return p;
}

function heading(text: string): HTMLElement {
  const h = document.createElement('h2');
  h.textContent = text;
  return h;
}

const mixture = ({ mean, variance, unit }: Mixture): string =>
  `${mean.toFixed(3)} ± ${Math.sqrt(variance).toFixed(3)} ${unit ?? ''}`;

/** The probable ones, largest first. */
function bars(shares: Record<string, number>): HTMLElement[] {
  return Object.entries(shares)
    .filter(([, p]) => p >= 0.01)
    .sort((a, b) => b[1] - a[1])
    .slice(0, 8)
    .map(([name, p]) => {
      const bar = document.createElement('div');
      bar.className = 'bar';
      const label = document.createElement('span');
      label.textContent = name;
      const meter = document.createElement('meter');
      meter.value = p;
      meter.setAttribute('aria-label', name);
      const number = document.createElement('span');
      number.textContent = p.toFixed(2);
      bar.append(label, meter, number);
      return bar;
    });
}
