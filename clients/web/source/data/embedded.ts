// SPDX-License-Identifier: MIT
// The recording inside of a page that `ziggurat export --html` wrote: parts of it in base64, of which those bytes are
// decoded that are read.
import type { IReadable } from "@mcap/core";

/** null: the page has none. */
export function embedded(): { file: IReadable; name: string } | null {
  const place = document.getElementById("recording");
  if (!place) return null;
  const { name = "recording", size = "", part = "" } = place.dataset;
  const texts = new Map<number, string>();
  const textOf = (number: number): string => {
    let text = texts.get(number);
    if (text === undefined) {
      const element = document.getElementById(`part${number}`);
      texts.set(number, text = element?.textContent ?? "");
      element?.remove(); // it holds the same again
    }
    return text;
  };
  return { file: partsReadable(Number(size), Number(part), textOf), name };
}

/** @param part  bytes of all parts but the last, a multiple of three
    @param textOf  a part in base64 */
export function partsReadable(bytes: number, part: number, textOf: (number: number) => string): IReadable {
  return {
    size: () => Promise.resolve(BigInt(bytes)),
    read: async (offset, size) => {
      const from = Number(offset), to = Number(offset + size);
      if (!(from >= 0 && to >= from && to <= bytes)) throw new Error("it points behind its own end");
      const all = new Uint8Array(to - from);
      for (let number = Math.floor(from / part); number * part < to; ++number) {
        const begin = number * part, first = Math.max(from - begin, 0);
        decode(textOf(number), first, Math.min(to - begin, part), all.subarray(begin + first - from));
      }
      return all;
    },
  };
}

/** Writes some bytes of a text in base64. @throws Error if the text is too short */
function decode(text: string, begin: number, end: number, to: Uint8Array): void {
  const group = Math.floor(begin / 3), skipped = begin - 3 * group;
  const letters = atob(text.slice(4 * group, 4 * Math.ceil(end / 3)));
  if (letters.length < skipped + end - begin) throw new Error("the page is cut off");
  for (let i = 0; i < end - begin; ++i) to[i] = letters.charCodeAt(skipped + i);
}
