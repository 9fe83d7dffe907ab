import { shade } from './colors';
import type { Scene } from './scene';
import { element } from './element';

/** The side panel's lists, by which everything can be reached with a keyboard. */
export class Lists {
  private readonly objects = element<HTMLUListElement>('objects');
  private readonly tasks = element<HTMLUListElement>('tasks');
  private readonly count = element('count');
  private readonly rows = new Map<string, HTMLLIElement>();

  constructor(private readonly onChoose: (id: string) => void) {}

  show(scene: Scene, chosen: string | null, meant: string[]): void {
    const entries = Object.entries(scene.objects).sort(([a], [b]) =>
      a.localeCompare(b, undefined, { numeric: true }));
    this.count.textContent = `${entries.length}, ${scene.expected_count.toFixed(1)} expected`;
    for (const [id, row] of this.rows)
      if (!(id in scene.objects)) {
        row.remove();
        this.rows.delete(id);
      }
    let before: Element | null = null;
    for (const [id, object] of entries) {
      let row = this.rows.get(id);
      if (!row) this.rows.set(id, (row = this.newRow(id)));
      const [dot, name, where] = row.firstElementChild!.children as unknown as HTMLElement[];
      dot.style.background = shade(object.class, object.attributes);
      name.textContent = object.alias ?? id;
      where.textContent = `${object.place?.replaceAll('_', ' ') ?? ''} ${object.p.toFixed(2)}`;
      row.firstElementChild!.setAttribute('aria-pressed', String(id === chosen || meant.includes(id)));
      const next: Element | null = before ? before.nextElementSibling : this.objects.firstElementChild;
      if (next !== row) this.objects.insertBefore(row, next);
      before = row;
    }
    this.tasks.replaceChildren(
      ...Object.entries(scene.tasks).map(([id, task]) => {
        const item = document.createElement('li');
        item.textContent = `${id}. ${task.object}: ${task.state}` +
          (task.robot ? ` by ${task.robot}` : '') + (task.reason ? `, ${task.reason}` : '');
        return item;
      }),
    );
  }

  private newRow(id: string): HTMLLIElement {
    const row = document.createElement('li');
    const button = document.createElement('button');
    button.type = 'button';
    button.dataset.id = id;
    for (const name of ['dot', 'grow', 'faint']) {
      const part = document.createElement('span');
      part.className = name;
      button.append(part);
    }
    button.onclick = () => this.onChoose(id);
    row.append(button);
    return row;
  }
}
