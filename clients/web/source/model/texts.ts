// SPDX-License-Identifier: MIT
// Texts of robots, scenes and recordings may have any length, and a browser takes seconds to break a long one without
// spaces into lines: a bounded part of each is kept and shown.

export const mostKept = 10_000; // characters of a text that can be looked at
export const mostShown = 300; // of it at first

const unseen = /[\u0000-\u0008\u000b-\u001f\u007f-\u009f\p{Cf}\p{Zl}\p{Zp}]/gu;

/** Characters that are not seen, or change the order of what stands around them, as \u202e: as the server writes it on a terminal. */
export function visible(text: string): string {
  return text.replace(unseen, (one) => `\\u${(one.codePointAt(0) ?? 0).toString(16).padStart(4, "0")}`);
}

/** The beginning of a text as it is shown; “…” says that there is more. */
export function beginning(text: string, most = mostShown): string {
  return visible(text.length > most ? `${text.slice(0, most)}…` : text);
}

/** The same, without the memory of the whole text: a part of a string may hold on to it. */
export function kept(text: string, most = mostKept): string {
  return text.length > most ? new TextDecoder().decode(new TextEncoder().encode(text.slice(0, most))) : text;
}
