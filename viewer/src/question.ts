import { ask, type Configuration, type Count, type Where } from './api';

/** A question in words, as the API asks it. */
export interface Question {
  what: 'where' | 'count';
  parameters: Record<string, string>;
}

export interface Answer {
  text: string;
  /** Ids that the answer names. */
  objects: string[];
  /** How probable, or how many, by place. */
  places: Map<string, number>;
}

const SHOWN = 5;
const FILLING = new Set([
  'is', 'are', 'the', 'a', 'an', 'my', 'in', 'on', 'at', 'of', 'how', 'many', 'there', 'all', 'any',
]);

/**
 * Reads `where blue cup`, `where is cup-1`, `count person in hall`, `how many cups on the kitchen
 * table`: symbols and predicates of the configuration, names of places, ids of objects. An error
 * names the word that means nothing.
 */
export function readQuestion(text: string, configuration: Configuration, ids: string[]): Question {
  const words = text.toLowerCase().replace(/[?!,.]/g, ' ').trim().split(/\s+/).filter(Boolean);
  const counts = words[0] === 'count' || (words[0] === 'how' && words[1] === 'many');
  const rest = words.slice(words[0] === 'count' || words[0] === 'where' ? 1 : 0);
  const parameters: Record<string, string> = {};
  const meaning = meanings(configuration, ids);
  for (let i = 0; i < rest.length; ) {
    const [read, name, value] = longest(rest, i, meaning);
    if (read > 0) parameters[name] = value;
    else if (!FILLING.has(rest[i])) throw new Error(`"${rest[i]}" is no object, attribute or place here`);
    i += Math.max(read, 1);
  }
  if (!counts && !parameters.object && Object.keys(parameters).every((name) => name === 'place'))
    throw new Error('say which: where blue cup, where cup-1, count person in hall');
  return { what: counts ? 'count' : 'where', parameters };
}

/** What each phrase stands for: a parameter and its value. */
function meanings(configuration: Configuration, ids: string[]): Map<string, [string, string]> {
  const out = new Map<string, [string, string]>();
  for (const [name, attribute] of Object.entries(configuration.attributes ?? {}))
    for (const value of [...(attribute.symbols ?? []), ...Object.keys(attribute.predicates ?? {})]) {
      const words = value.toLowerCase().replaceAll('_', ' ');
      out.set(words, [name, value]);
      if (name === 'class') out.set(words === 'person' ? 'people' : words + 's', [name, value]);
    }
  for (const place of configuration.places ?? [])
    out.set(place.name.toLowerCase().replaceAll('_', ' '), ['place', place.name]);
  for (const id of ids) out.set(id.toLowerCase(), ['object', id]);
  return out;
}

function longest(
  words: string[], from: number, meaning: Map<string, [string, string]>,
): [number, string, string] {
  for (let count = Math.min(4, words.length - from); count > 0; --count) {
    const phrase = words.slice(from, from + count).join(' ').replaceAll('_', ' ');
    const found = meaning.get(phrase);
    if (found) return [count, ...found];
  }
  return [0, '', ''];
}

const percent = (p: number): string => p.toFixed(2);
const called = (place: string | null): string => place?.replaceAll('_', ' ') ?? 'elsewhere';

export async function answerTo(question: Question, at?: number): Promise<Answer> {
  const parameters = at ? { ...question.parameters, at } : question.parameters;
  return question.what === 'where'
    ? tellWhere(await ask<Where>('/v1/where', parameters))
    : tellCount(await ask<Count>('/v1/count', parameters), question.parameters.place);
}

function tellWhere(where: Where): Answer {
  const lines: string[] = [];
  const places = new Map<string, number>();
  for (const answer of where.answers.slice(0, SHOWN)) {
    const shown = answer.places.filter((place) => place.p >= 0.02).sort((a, b) => b.p - a.p);
    const words = shown.slice(0, 4).map((place) => `${called(place.place)} ${percent(place.p)}`);
    lines.push(`${answer.object} (${percent(answer.p * answer.match)}): ${words.join(', ') || 'anywhere'}`);
  }
  const [first] = where.answers;
  for (const { place, p } of first?.places ?? []) if (place) places.set(place, p);
  if (!first)
    for (const { place, expected } of where.undetected) places.set(place, expected);
  const unseen = where.undetected.reduce((most, u) => Math.max(most, u.expected), 0);
  if (!first) lines.push('none has been seen');
  if (where.answers.length > SHOWN) lines.push(`and ${where.answers.length - SHOWN} more`);
  if (unseen >= 0.01) lines.push(`never seen: up to ${unseen.toFixed(2)} in a place`);
  return { text: lines.join('\n'), objects: where.answers.map((answer) => answer.object), places };
}

function tellCount(count: Count, place?: string): Answer {
  const likely = count.distribution
    .map((p, n) => ({ p, n }))
    .filter(({ p }) => p >= 0.05)
    .map(({ p, n }) => `${n} with ${percent(p)}`);
  const text = `${count.expected.toFixed(2)} expected: ${likely.join(', ')}\n` +
    `never seen: ${count.undetected.toFixed(2)}`;
  return { text, objects: [], places: new Map(place ? [[place, count.expected]] : []) };
}
