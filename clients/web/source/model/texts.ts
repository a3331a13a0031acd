// Texts of robots, scenes and recordings may have any length, and a browser takes seconds to break a long one without
// spaces into lines: a bounded part of each is kept and shown.

export const mostKept = 10_000; // characters of a text that can be looked at
export const mostShown = 300; // of it at first

/** The beginning of a text; “…” says that there is more. */
export function beginning(text: string, most = mostShown): string {
  return text.length > most ? `${text.slice(0, most)}…` : text;
}

/** The same, without the memory of the whole text: a part of a string may hold on to it. */
export function kept(text: string, most = mostKept): string {
  return text.length > most ? new TextDecoder().decode(new TextEncoder().encode(text.slice(0, most))) : text;
}
