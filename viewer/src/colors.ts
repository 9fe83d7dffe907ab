/** Colours that those who see fewer of them tell apart, too: Okabe and Ito (2008). */
const PALETTE = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#8c6d00', '#7a4fbf'];

/** What is called red looks red. */
const NAMED: Record<string, string> = {
  red: '#d03030', orange: '#e69f00', yellow: '#d8c520', green: '#2f9e5f', blue: '#2f6fd0',
  purple: '#7a4fbf', pink: '#d977a8', brown: '#8b5a2b', black: '#333333', grey: '#888888',
  gray: '#888888', white: '#f2f2f2',
};

const given = new Map<string, string>();

/** One for each class, in the order in which they are met. */
export function colorOf(name: string): string {
  let color = given.get(name);
  if (!color) given.set(name, (color = PALETTE[given.size % PALETTE.length]));
  return color;
}

/** That of the object itself where one is believed of it, else its class's. */
export function shade(name: string, attributes?: Record<string, string | number>): string {
  return NAMED[String(attributes?.color)] ?? colorOf(name);
}
