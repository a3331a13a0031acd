// SPDX-License-Identifier: MIT
// Collisions: two entities that begin to touch each other. Resting on each other is none.
import type { Contacts, World } from "./messages";

const apartNs = 500_000_000; // simulated; a pair that was apart for less still touches, or in no message

export class Collisions {
  private touched = new Map<string, number>(); // when a pair touched last [ns]
  private lastNs = -Infinity;

  /** Who began to touch since the call before, as a text; empty: no pair. Of messages in any order older ones are skipped. */
  take(contacts: Contacts, timeNs: number, world: World): string {
    if (timeNs < this.lastNs) this.touched.clear(); // the world began again
    const isFirst = this.lastNs === -Infinity || timeNs < this.lastNs;
    const lastNs = this.lastNs; // fast worlds send few of their ticks
    this.lastNs = timeNs;
    const found: string[] = [];
    for (let i = 0; i + 1 < contacts.links.length; i += 2) {
      const a = world.links[contacts.links[i]]?.entity, b = world.links[contacts.links[i + 1]]?.entity;
      if (a === undefined || b === undefined || a === b) continue; // -1 is the floor
      const [low, high] = a < b ? [a, b] : [b, a];
      const pair = `${low} ${high}`;
      const before = this.touched.get(pair);
      if (!isFirst && (before === undefined || (before < lastNs && timeNs - before > apartNs))) {
        found.push(`${world.entities[low]?.id} and ${world.entities[high]?.id}`);
      }
      this.touched.set(pair, timeNs);
    }
    if (this.touched.size > 20_000) this.touched.clear();
    return found.length === 0 ? "" : `collision: ${found.slice(0, 3).join(", ")}${found.length > 3 ? `, ${found.length - 3} more` : ""}`;
  }
}
