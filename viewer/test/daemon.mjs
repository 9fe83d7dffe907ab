// A daemon of its own for a test: the program that was built, on free ports, with a kitchen.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const HERE = fileURLToPath(new URL('.', import.meta.url));
const BUILD = resolve(process.env.ANCHORD_BUILD ?? join(HERE, '../../build'));
const VIEWER = resolve(process.env.ANCHORD_VIEWER ?? join(BUILD, 'viewer'));
export const START = 1_700_000_000_000_000; // us

const KITCHEN = {
  world: { bounds: { min: [0, 0, 0], max: [8, 6, 2.5] }, walls: [[[0, 0], [8, 0]], [[0, 0], [0, 6]]] },
  places: [
    { name: 'kitchen', kind: 'room', polygon: [[0, 0], [5, 0], [5, 6], [0, 6]] },
    { name: 'hall', kind: 'room', polygon: [[5, 0], [8, 0], [8, 6], [5, 6]] },
    { name: 'table', kind: 'surface', parent: 'kitchen', z: [0.6, 1.1],
      polygon: [[1, 1], [3, 1], [3, 2.5], [1, 2.5]] },
    { name: 'sink', kind: 'surface', parent: 'kitchen', z: [0.6, 1.1],
      polygon: [[1, 4.5], [3, 4.5], [3, 5.5], [1, 5.5]] },
  ],
  attributes: {
    class: { kind: 'categorical', symbols: ['cup', 'person'] },
    color: { kind: 'categorical', symbols: ['red', 'blue'] },
  },
  classes: {
    default: { models: [{ kind: 'constant_position', position_psd: 1e-3 }, { kind: 'somewhere', rate: 1e-3 }] },
    cup: { extent: [0.1, 0.1, 0.12] },
    person: { extent: [0.4, 0.5, 1.7] },
  },
};

export async function freePort() {
  const server = createServer().listen(0, '127.0.0.1');
  await new Promise((ready) => server.once('listening', ready));
  const { port } = server.address();
  await new Promise((closed) => server.close(closed));
  return port;
}

export class Daemon {
  folder = mkdtempSync(join(tmpdir(), 'anchord-viewer-'));
  number = 0;

  async start() {
    this.port ??= await freePort();
    writeFileSync(join(this.folder, 'kitchen.json'), JSON.stringify(KITCHEN));
    this.process = spawn(join(BUILD, 'anchord'), [
      '--config', join(this.folder, 'kitchen.json'), '--data', join(this.folder, 'data'),
      '--lcm', 'memq://', '--http', `127.0.0.1:${this.port}`, '--viewer', VIEWER,
    ], { stdio: 'ignore' });
    for (;;) {
      try {
        if ((await this.get('/v1/status')).ready) return;
      } catch { /* it is not there yet */ }
      await new Promise((later) => setTimeout(later, 50));
    }
  }

  async end(signal) {
    const ended = new Promise((done) => this.process.once('exit', done));
    this.process.kill(signal);
    await ended;
  }

  async stop() {
    await this.end('SIGTERM');
    rmSync(this.folder, { recursive: true });
  }

  get url() {
    return `http://127.0.0.1:${this.port}/`;
  }

  async get(path) {
    const response = await fetch(new URL(path, this.url));
    return response.json();
  }

  /** Some frames in which these things are seen: [class, color, x, y, z]. */
  async see(things, frames = 5) {
    for (let i = 0; i < frames; ++i) {
      this.number += 1;
      const body = {
        utime: START + this.number * 200_000,
        sensor: 'camera',
        view: { type: 'world' },
        detections: things.map(([kind, color, x, y, z]) => ({
          position: [x, y, z],
          covariance: [1e-3, 0, 0, 0, 1e-3, 0, 0, 0, 1e-3],
          attributes: { class: { [kind]: 0.95 }, color: { [color]: 0.95 } },
        })),
      };
      const response = await fetch(new URL('/v1/detections', this.url), {
        method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(body),
      });
      if (response.status !== 200) throw new Error(await response.text());
    }
  }
}
