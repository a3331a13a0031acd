// SPDX-License-Identifier: MIT
// Marks of the time line, in lanes by kind, and who connects and leaves.
import type { Session } from "./messages";
import type { Mark, MarkKind } from "./timeline";

/** From the top; a lane has a row if it has marks and is switched on. */
export const lanes = [
  { name: "bookmarks", label: "Bookmarks", kinds: ["bookmark"], color: "#e69f00" },
  { name: "acts", label: "Resets and other acts", kinds: ["reset"], color: "#3d8bfd" },
  { name: "connections", label: "Controllers: connections, missed deadlines", kinds: ["session", "missed"], color: "#cc5a9a" },
  { name: "collisions", label: "Collisions", kinds: ["collision"], color: "#8e5bd0" },
  { name: "log", label: "Log lines, warnings, errors", kinds: ["log", "warning", "error"], color: "#8a919b" },
] as const satisfies readonly { name: string; label: string; kinds: readonly MarkKind[]; color: string }[];
export type Lane = (typeof lanes)[number]["name"];

/** Marks with a colour of their own in their lane. */
export const colors: Partial<Record<MarkKind, string>> = { warning: "#e6a417", error: "#e0402c", missed: "#d6336c" };

export interface LaneMarks { name: Lane; color: string; marks: Mark[] }

/** The lanes that have marks, from the top. @param hidden  lanes that are switched off */
export function lanesOf(marks: readonly Mark[], hidden: readonly Lane[]): LaneMarks[] {
  return lanes.filter(({ name }) => !hidden.includes(name))
    .map(({ name, color, kinds }) => ({ name, color, marks: marks.filter(({ kind }) => (kinds as readonly MarkKind[]).includes(kind)) }))
    .filter((lane) => lane.marks.length > 0);
}

const lost = 6; // of protocol.proto's Session.State

export class Connections {
  private known: Map<string, string> | null = null; // clients with their robots

  /** Who came and left since the call before, as texts. */
  take(sessions: readonly Session[]): string[] {
    const now = new Map(sessions.filter(({ state }) => state !== lost)
      .map(({ client, robots }) => [`${client} ${robots.join()}`, client]));
    const before = this.known;
    this.known = now;
    if (!before) return [];
    return [...[...now].filter(([key]) => !before.has(key)).map(([, client]) => `${client} connected`),
            ...[...before].filter(([key]) => !now.has(key)).map(([, client]) => `${client} left`)];
  }
}
