// SPDX-License-Identifier: MIT
// Numbers over time: any number of any channel, named by its topic and its path in the decoded message,
// for example "jointReadings.2".
import type { Value } from "../data/source";
import type { Label } from "./labels";
import { metricsIn, metricsTopic } from "./metrics";
import type { Frame, Timeline } from "./timeline";

export interface SeriesName { topic: string; path: string }

/** The number at a path, or null. */
export function numberAt(value: unknown, path: string): number | null {
  let found: unknown = value;
  for (const key of path.split(".")) {
    if (found === null || typeof found !== "object") return null;
    found = (found as Record<string, unknown>)[key];
  }
  if (typeof found === "bigint") return Number(found);
  if (typeof found === "boolean") return found ? 1 : 0;
  return typeof found === "number" ? found : null;
}

/** The number of a series in a message of its topic. */
function numberOf({ topic, path }: SeriesName, message: unknown): number | null {
  if (topic !== metricsTopic) return numberAt(message, path);
  return metricsIn(message).find((metric) => metric.path === path)?.value ?? null;
}

/** All numbers of a message that can be plotted. */
export function plottable(topic: string, message: unknown): { path: string; value: number }[] {
  return topic === metricsTopic ? metricsIn(message) : numbersIn(message);
}

const mostVisited = 20_000; // parts of a message, in which numbers are looked for

/** Paths of all numbers in a message, at most so many, in its order. A message may have millions of parts: the rest is not looked at. */
export function numbersIn(value: unknown, limit = 500, prefix = ""): { path: string; value: number }[] {
  const found: { path: string; value: number }[] = [];
  let visited = 0;
  const isOver = (): boolean => found.length >= limit || visited > mostVisited;
  const visit = (inner: unknown, path: string): void => {
    ++visited;
    if (isOver() || inner === null || inner instanceof Uint8Array) return;
    if (typeof inner === "number" || typeof inner === "bigint" || typeof inner === "boolean") {
      found.push({ path, value: Number(inner) });
    } else if (typeof inner === "object") {
      for (const key of keysOf(inner)) {
        if (isOver()) return;
        visit((inner as Value)[key], path ? `${path}.${key}` : String(key));
      }
    }
  };
  visit(value, prefix);
  return found;
}

/** One after the other: a list of all would take more memory than the message. */
function *keysOf(value: object): Generator<string | number> {
  const { length } = value as { length?: unknown };
  if (Array.isArray(value) || ArrayBuffer.isView(value)) {
    for (let i = 0; i < (length as number); ++i) yield i;
  } else {
    yield* Object.keys(value);
  }
}

/** A series is "topic:path" in the address. */
export function nameOf({ topic, path }: SeriesName): string { return `${topic}:${path}`; }
export function parseName(text: string): SeriesName | null {
  const at = text.lastIndexOf(":");
  return at > 0 ? { topic: text.slice(0, at), path: text.slice(at + 1) } : null;
}

/** The values of one series in the frames of a timeline; it reads each frame once. */
export class Series {
  readonly sequences: number[] = [];
  readonly times: number[] = []; // simulated [s]
  readonly values: (number | null)[] = [];
  label: Label | null = null; // null: not known yet
  private next = 0;

  constructor(readonly name: SeriesName) {}

  /** Takes the frames that are new, except the newest, which may still be incomplete. */
  update(timeline: Timeline, most = 6000): void {
    this.next = Math.max(this.next, timeline.first, timeline.last - most);
    for (; this.next < timeline.last; ++this.next) {
      const frame = timeline.at(this.next);
      if (frame) this.push(frame);
    }
    const drop = this.sequences.findIndex((sequence) => sequence >= timeline.last - most);
    if (drop > 500) for (const list of [this.sequences, this.times, this.values]) list.splice(0, drop);
  }

  private push(frame: Frame): void {
    const message = frame.messages.get(this.name.topic);
    if (message) this.add(frame.sequence, Number(frame.timeNs) * 1e-9, message.read());
  }

  /** Takes the number out of a message. @param time  simulated [s] */
  add(sequence: number, time: number, message: unknown): void {
    const value = numberOf(this.name, message);
    if (value === null && this.name.topic === metricsTopic) return; // it holds until it is set again
    this.sequences.push(sequence);
    this.times.push(time);
    this.values.push(value);
  }

  get latest(): number | null { return this.values[this.values.length - 1] ?? null; }
}
