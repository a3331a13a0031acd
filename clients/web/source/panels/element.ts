// SPDX-License-Identifier: MIT
// Elements of the page, made in one expression.
import { beginning, mostKept, mostShown, visible } from "../model/texts";

const mostText = 1000; // characters of any text; longText() shows more
const mostTitle = 2000;
const wordLength = 8; // of the pieces of long words

type Child = Node | string | null;
interface Options {
  class?: string;
  title?: string;
  click?: (event: MouseEvent) => void;
  [attribute: string]: unknown;
}

/** make("button.primary", { title: "…", click: f }, "text") */
export function make(what: string, options: Options = {}, ...children: Child[]): HTMLElement {
  const [tag, ...classes] = what.split(".");
  const element = document.createElement(tag);
  if (classes.length > 0) element.className = classes.join(" ");
  for (const [name, value] of Object.entries(options)) {
    if (name === "style") element.style.cssText = String(value); // an attribute is against the security policy
    else if (name === "click") element.addEventListener("click", value as EventListener);
    else if (name === "title") element.title = beginning(String(value), mostTitle);
    else if (value !== undefined && value !== false) element.setAttribute(name, value === true ? "" : String(value));
  }
  element.append(...children.filter((child) => child !== null)
    .map((child) => (typeof child === "string" ? beginning(child, mostText) : child)));
  return element;
}

/** A text that somebody else wrote: its beginning; a click shows what is kept of it. @param length  of all of it */
export function longText(what: string, text: string, length = text.length): HTMLElement {
  const element = make(what, {}, beginning(text));
  if (length <= mostShown) return element;
  const more = make("button.more", { title: "Show more of it, or less", click: (event) => {
    event.stopPropagation();
    fill(!more.classList.contains("open"));
  } });
  const fill = (isOpen: boolean): void => {
    more.classList.toggle("open", isOpen);
    more.textContent = isOpen ? "less" : `${length} characters`;
    const rest = length > mostKept ? ` … and ${length - mostKept} more ` : " ";
    element.replaceChildren(...(isOpen ? [...breakable(visible(text.slice(0, mostKept))), rest] : [beginning(text), " "]), more);
  };
  fill(false);
  return element;
}

/** Long words with places where a line may end: the browser needs seconds to find some by itself. */
function breakable(text: string): Node[] {
  const parts = text.match(new RegExp(`\\S{${wordLength}}|[^]`, "gu")) ?? [];
  const nodes: Node[] = [];
  let line = "";
  for (const part of parts) {
    line += part;
    if (part.length < wordLength) continue;
    nodes.push(document.createTextNode(line), document.createElement("wbr"));
    line = "";
  }
  nodes.push(document.createTextNode(line));
  return nodes;
}

const paths: Record<string, string> = {
  play: "M4 2.5v11l9-5.5z",
  pause: "M4 2.5h3v11H4zM9 2.5h3v11H9z",
  step: "M3 2.5v11l7-5.5zM11 2.5h2v11h-2z",
  back: "M13 2.5v11L6 8zM3 2.5h2v11H3z",
  reset: "M8 3a5 5 0 1 1-4.6 3l1.4.6A3.5 3.5 0 1 0 8 4.5V7L4 3.7 8 .5z",
  select: "M3 2l10 5-4.2 1.3L7 13z",
  move: "M8 .5l2.5 3H9V7h3.500V5.500l3 2.500-3 2.500V9H9v3.500h1.500L8 15.500 5.500 12.500H7V9H3.500v1.500l-3-2.500 3-2.500V7H7V3.500H5.500z",
  ruler: "M1 11 11 1l4 4L5 15zM2.800 11 5 13.200 13.200 5 11 2.800zM6 8l1.500 1.500.700-.7L6.700 7.300zM8.500 5.500 10 7l.7-.7-1.500-1.500z",
  bookmark: "M3.500 1.500h9v13l-4.500-3.500-4.500 3.500z",
  lanes: "M1.500 2.500h13v2.500h-13zM1.500 6.750h8v2.500h-8zM1.500 11h11v2.500h-11z",
  picture: "M5.500 2.500l-1 1.500h-3v9.500h13V4h-3l-1-1.500zM8 5.500a3 3 0 1 1 0 6 3 3 0 0 1 0-6z",
  film: "M1.500 3.500h9v9h-9zM11.500 7l3.500-2.500v7L11.500 9z",
  link: "M6.500 5H4.800a3 3 0 0 0 0 6h1.700V9.500H4.800a1.500 1.500 0 0 1 0-3h1.700zM9.500 5h1.700a3 3 0 0 1 0 6H9.500V9.500h1.700a1.500 1.500 0 0 0 0-3H9.500zM5.300 7.250h5.400v1.500H5.300z",
  plot: "M1.500 1.500v13h13v-1.500H3V1.500zM4 10l3-4 3 2.500 4-5.500 1 .8-4.700 6.700-3.100-2.600L5 11z",
};

export function icon(name: keyof typeof paths): SVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 16 16");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  path.setAttribute("d", paths[name]);
  svg.append(path);
  return svg;
}

/** The same of several lines, each with its beginning. */
export function setLines(element: Element, lines: string[]): void {
  const text = lines.map((line) => beginning(line, mostText)).join("\n");
  if (element.textContent !== text) element.textContent = text;
}

/** “… and N more”, if a list of so many has more than are shown. */
export function restOf(count: number, shown: number): HTMLElement | null {
  return count > shown ? make("p.muted", {}, `… and ${count - shown} more`) : null;
}

/** Sets the text, or its beginning, if it differs: cheap for what is often the same. */
export function setText(element: Element, text: string): void {
  const shown = beginning(text, mostText);
  if (element.textContent !== shown) element.textContent = shown;
}
