import { Vector3 } from 'three';
import { ask, type Configuration } from './api';
import { Details } from './details';
import { element } from './element';
import { Home } from './home';
import { Lists } from './list';
import { Objects } from './objects';
import { Overlay } from './overlay';
import { sceneAt } from './past';
import { answerTo, readQuestion } from './question';
import type { Scene } from './scene';
import { Stage } from './stage';
import { StatusLine } from './status';
import { Stream } from './stream';
import { Timeline } from './timeline';
import { Explanations } from './worlds';

const REFRESH = 500; // ms

/** What the page shows now: the live scene, or one of the past, and what is chosen of it. */
class Page {
  private live?: Scene;
  private past?: Scene;
  private chosen: string | null = null;
  private meant: string[] = [];
  private refreshing = false;
  private readonly stage = new Stage(element<HTMLCanvasElement>('stage'));
  private readonly objects: Objects;
  private readonly overlay = new Overlay();
  private readonly home: Home;
  private readonly details: Details;
  private readonly lists = new Lists((id) => this.choose(id));
  private readonly status = new StatusLine(this.stage);
  private readonly timeline = new Timeline((at) => void this.goTo(at));

  constructor(private readonly configuration: Configuration) {
    this.home = new Home(configuration);
    this.objects = new Objects(this.home.across);
    this.stage.scene.add(this.home, this.objects, this.overlay);
    this.stage.frame(this.home.box);
    this.details = new Details(element('details'), this.overlay, () => this.choose(null));
    new Explanations(this.overlay, () => this.timeline.at, () => this.stage.draw());
    element<HTMLFormElement>('question').onsubmit = (event) => {
      event.preventDefault();
      void this.answer(element<HTMLInputElement>('ask').value);
    };
    const canvas = element<HTMLCanvasElement>('stage');
    canvas.addEventListener('click', (event) => {
      const hit = this.stage.pick(event.clientX, event.clientY, this.objects.shapes);
      this.choose((hit?.userData.id as string) ?? null);
    });
    addEventListener('keydown', (event) => {
      if (event.key === 'Escape') this.choose(null);
      if (event.key === '/' && document.activeElement?.tagName !== 'INPUT') {
        event.preventDefault();
        element('ask').focus();
      }
    });
    this.status.watch(
      new Stream(
        (scene) => {
          this.live = scene;
          this.timeline.reach(scene.utime);
          this.show();
        },
        (why) => this.status.lost(why),
      ),
    );
  }

  private get scene(): Scene | undefined {
    return this.timeline.at === undefined ? this.live : this.past;
  }

  private show(): void {
    const scene = this.scene;
    if (!scene) return;
    if (this.chosen && this.timeline.at === undefined) this.refresh();
    this.objects.show(scene.objects, this.chosen);
    this.overlay.show(scene);
    this.lists.show(scene, this.chosen, this.meant);
    this.stage.draw();
  }

  /** The panel of what is chosen follows what happens, though not as often. */
  private refresh(): void {
    if (this.refreshing) return;
    this.refreshing = true;
    setTimeout(() => {
      this.refreshing = false;
      if (this.chosen && this.timeline.at === undefined)
        void this.details.show(this.chosen).then(() => this.stage.draw());
    }, REFRESH);
  }

  private async goTo(at: number | undefined): Promise<void> {
    if (at !== undefined) {
      try {
        const past = await sceneAt(at);
        if (this.timeline.at !== at) return; // it has been moved on meanwhile
        this.past = past;
        this.say('');
      } catch (error) {
        this.say((error as Error).message);
      }
    }
    this.show();
    if (this.chosen) await this.details.show(this.chosen, at);
    this.stage.draw();
  }

  private choose(id: string | null): void {
    this.chosen = id;
    const object = id ? this.scene?.objects[id] : undefined;
    if (!id) this.details.close();
    else void this.details.show(id, this.timeline.at).then(() => this.stage.draw());
    if (object) {
      const [x, y, z = 0] = object.position;
      this.stage.lookAt(new Vector3(x, y, z));
    }
    this.show();
    this.stage.draw();
  }

  private async answer(text: string): Promise<void> {
    this.meant = [];
    this.home.heat(new Map());
    try {
      if (text.trim()) {
        const ids = Object.keys(this.scene?.objects ?? {});
        const question = readQuestion(text, this.configuration, ids);
        const answer = await answerTo(question, this.timeline.at);
        this.say(answer.text);
        this.meant = answer.objects.slice(0, 1);
        this.home.heat(answer.places);
      } else {
        this.say('');
      }
    } catch (error) {
      this.say((error as Error).message);
    }
    this.show();
  }

  private say(text: string): void {
    element<HTMLOutputElement>('answer').textContent = text;
  }
}

/** Once the daemon tells what the world is; it may still be starting. */
async function begin(): Promise<void> {
  for (;;) {
    try {
      new Page(await ask<Configuration>('/v1/configuration'));
      return;
    } catch (error) {
      element('status').textContent = (error as Error).message;
      await new Promise((resolve) => setTimeout(resolve, 1000));
    }
  }
}

void begin();
