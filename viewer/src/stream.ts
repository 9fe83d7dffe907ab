import { mergePatch, type Scene } from './scene';
import { token } from './api';

/** Follows GET /v1/stream, and begins again by itself whenever it ends. */
export class Stream {
  messages = 0;
  bytes = 0;
  private scene?: Scene;
  private wait = FIRST_WAIT;

  constructor(
    private readonly onScene: (scene: Scene) => void,
    private readonly onLost: (why: string) => void,
    private readonly rate = 10,
  ) {
    this.open();
  }

  private open(): void {
    const url = new URL('/v1/stream', location.href);
    url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
    url.searchParams.set('rate', String(this.rate));
    const secret = token();
    const socket = new WebSocket(
      url,
      secret ? ['anchord.v1', 'anchord.token.' + base64url(secret)] : ['anchord.v1'],
    );
    socket.onmessage = (event) => {
      this.wait = FIRST_WAIT;
      this.hear(event.data as string);
    };
    socket.onclose = (event) => {
      this.onLost(event.reason || 'the daemon does not answer');
      setTimeout(() => this.open(), this.wait);
      this.wait = Math.min(2 * this.wait, LAST_WAIT);
    };
  }

  private hear(text: string): void {
    this.messages += 1;
    this.bytes += text.length;
    const message = JSON.parse(text);
    if (message.world) this.scene = message.world as Scene;
    else this.scene = mergePatch(this.scene as never, message.change) as unknown as Scene;
    this.onScene(this.scene);
  }
}

const FIRST_WAIT = 250; // ms before the first attempt to begin again
const LAST_WAIT = 4000;

function base64url(text: string): string {
  return btoa(text).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
}
