/** What the stream tells: see docs/stream.md. Positions are m in the map frame. */

export interface Anchor {
  class: string;
  p: number;
  position: number[];
  /** Upper triangle, row by row. */
  covariance: number[];
  seen: number;
  somewhere?: number;
  attributes?: Record<string, string | number>;
  place?: string;
  extent?: number[];
  yaw?: number;
  alias?: string;
  held_by?: string;
}

export interface Task {
  state: string;
  object: string;
  reason: string;
  robot?: string;
  sensor?: string;
  viewpoint?: Pose;
  gain?: number;
  cost?: number;
}

export interface Pose {
  position: number[];
  /** w, x, y, z. */
  orientation: number[];
}

export interface Scene {
  utime: number;
  expected_count: number;
  hypotheses: number;
  clusters: number;
  objects: Record<string, Anchor>;
  tasks: Record<string, Task>;
  robots: Record<string, Pose>;
}

type Json = null | boolean | number | string | Json[] | { [name: string]: Json };

/** A JSON merge patch (RFC 7396) applied to a value, which it may change. */
export function mergePatch(value: Json | undefined, patch: Json): Json {
  if (patch === null || typeof patch !== 'object' || Array.isArray(patch)) return patch;
  const target =
    value !== null && typeof value === 'object' && !Array.isArray(value) ? value : {};
  for (const [name, change] of Object.entries(patch)) {
    if (change === null) delete target[name];
    else target[name] = mergePatch(target[name], change);
  }
  return target;
}
