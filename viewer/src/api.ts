/** Questions to the daemon that has served this page. */

const KEY = 'anchord-token';

/** The token that was given as #token=..., kept for this tab. */
export function token(): string | null {
  const given = new URLSearchParams(location.hash.slice(1)).get('token');
  if (given) {
    sessionStorage.setItem(KEY, given);
    history.replaceState(null, '', location.pathname + location.search);
  }
  return sessionStorage.getItem(KEY);
}

/** The answer to a GET, or an error with the daemon's own words. */
export async function ask<Answer>(
  path: string,
  parameters: Record<string, string | number> = {},
): Promise<Answer> {
  const url = new URL(path, location.href);
  for (const [name, value] of Object.entries(parameters)) url.searchParams.set(name, String(value));
  const secret = token();
  const headers: Record<string, string> = secret ? { Authorization: 'Bearer ' + secret } : {};
  const response = await fetch(url, { headers });
  const answer = await response.json();
  if (!response.ok) throw new Error(answer.error?.message ?? response.statusText);
  return answer as Answer;
}

export interface Place {
  name: string;
  kind: string;
  parent?: string;
  polygon: number[][];
  z?: number[];
}

export interface Attribute {
  kind: string;
  symbols?: string[];
  predicates?: Record<string, unknown>;
}

/** Of the configuration, what the page shows: docs/formats.md. */
export interface Configuration {
  world: {
    dimensions?: number;
    bounds: { min: number[]; max: number[] };
    walls?: (number[][] | { line: number[][]; z?: number[] })[];
  };
  places?: Place[];
  attributes?: Record<string, Attribute>;
}

export interface Mixture {
  mean: number;
  variance: number;
  unit?: string;
}

export interface Detailed {
  id: string;
  p: number;
  position: number[];
  covariance: number[];
  attributes: Record<string, Record<string, number> | Mixture>;
  place: string | null;
  last_seen: number;
  models: { kind: string; weight: number; place?: string | null }[];
  alternatives: { p: number; position: number[]; place: string | null; class: string }[];
  seen?: { sensor?: string; utime?: number };
}

export interface Where {
  answers: {
    object: string;
    p: number;
    match: number;
    last_seen: number;
    places: { place: string | null; p: number; parent?: string | null }[];
  }[];
  undetected: { place: string; expected: number }[];
}

export interface Count {
  distribution: number[];
  expected: number;
  undetected: number;
}
