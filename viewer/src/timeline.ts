import { element } from './element';

const STEPS = 1000; // of the slider
const TICK = 250; // ms between two pictures of what is played
const SPEED = 4; // times as fast as it was

/** The slider through the past: gives a time (us), or nothing while it is live. */
export class Timeline {
  /** us; nothing: live. */
  at: number | undefined;
  private newest = 0;
  private playing = 0;

  private readonly when = element<HTMLInputElement>('when');
  private readonly shown = element<HTMLOutputElement>('shown');
  private readonly span = element<HTMLSelectElement>('span');
  private readonly play = element<HTMLButtonElement>('play');

  constructor(private readonly onTime: (at: number | undefined) => void) {
    this.when.oninput = () => this.goTo(this.timeOf(Number(this.when.value)));
    this.span.onchange = () => this.goTo(this.at);
    this.play.onclick = () => (this.playing ? this.pause() : this.start());
    element<HTMLButtonElement>('live').onclick = () => this.goTo(undefined);
  }

  /** The newest time that there is. */
  reach(utime: number): void {
    this.newest = utime;
    if (this.at === undefined) this.tell();
  }

  goTo(at: number | undefined): void {
    const live = at === undefined || at >= this.newest;
    this.at = live ? undefined : Math.round(at);
    if (live) this.pause();
    this.when.value = String(live ? STEPS : this.stepOf(at));
    this.tell();
    this.onTime(this.at);
  }

  private start(): void {
    if (this.at === undefined) this.goTo(this.timeOf(0));
    this.playing = window.setInterval(() => {
      if (this.at !== undefined) this.goTo(this.at + SPEED * TICK * 1000);
    }, TICK);
    this.play.textContent = '❚❚';
    this.play.setAttribute('aria-pressed', 'true');
  }

  private pause(): void {
    clearInterval(this.playing);
    this.playing = 0;
    this.play.textContent = '▶';
    this.play.setAttribute('aria-pressed', 'false');
  }

  private timeOf(step: number): number {
    return this.newest - (1 - step / STEPS) * this.length();
  }
  private stepOf(at: number): number {
    return STEPS * (1 - (this.newest - at) / this.length());
  }
  private length(): number {
    return Number(this.span.value) * 1e6;
  }

  private tell(): void {
    const date = new Date((this.at ?? this.newest) / 1000);
    const text = this.newest ? date.toLocaleString() : 'nothing yet';
    this.shown.textContent = this.at === undefined ? `live, ${text}` : text;
    document.body.dataset.time = this.at === undefined ? 'live' : 'past';
  }
}
