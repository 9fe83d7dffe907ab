import { ask } from './api';
import type { Anchor, Scene } from './scene';

interface Listed {
  utime: number;
  objects: {
    id: string;
    p: number;
    position: number[];
    covariance: number[];
    attributes: Record<string, Record<string, number>>;
    last_seen: number;
    place: string | null;
    in_best: boolean;
    extent?: number[];
    yaw?: number;
    alias?: string;
  }[];
}

/** The likeliest symbol of each distribution; scalars are left out. */
function likeliest(attributes: Record<string, Record<string, number>>): Record<string, string> {
  const out: Record<string, string> = {};
  for (const [name, symbols] of Object.entries(attributes))
    if (!('mean' in symbols))
      out[name] = Object.entries(symbols).reduce((best, s) => (s[1] > best[1] ? s : best))[0];
  return out;
}

/** Of a full covariance, row by row. */
function triangle(covariance: number[]): number[] {
  const n = Math.sqrt(covariance.length);
  return covariance.filter((_, i) => i % n >= Math.floor(i / n));
}

/** The best world as it was at a time. */
export async function sceneAt(at: number): Promise<Scene> {
  const listed = await ask<Listed>('/v1/objects', { at, min_p: 0.05 });
  const objects: Record<string, Anchor> = {};
  let expected = 0;
  for (const o of listed.objects) {
    expected += o.p;
    if (!o.in_best) continue;
    const { class: kind, ...attributes } = likeliest(o.attributes);
    objects[o.id] = {
      class: kind ?? 'object', p: o.p, position: o.position, covariance: triangle(o.covariance),
      attributes, seen: o.last_seen / 1e6, place: o.place ?? undefined, extent: o.extent,
      yaw: o.yaw, alias: o.alias,
    };
  }
  return {
    utime: listed.utime, expected_count: expected, hypotheses: 0, clusters: 0, objects, tasks: {},
    robots: {},
  };
}
