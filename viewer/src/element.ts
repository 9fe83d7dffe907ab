/** The element of the page that has an id; the page is ours, so it is there. */
export function element<E extends HTMLElement>(id: string): E {
  return document.getElementById(id) as E;
}
