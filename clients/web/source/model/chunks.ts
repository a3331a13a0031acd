// SPDX-License-Identifier: MIT
// Chunks of a recording: their frames' places in the file's order, and the messages of those that are in memory, which
// has a bound. Nothing is decoded here.
import type { Chunk, Container, RawMessage } from "../data/container";

const mostBytes = 192 * 1024 * 1024; // of messages in memory
const ofMessage = 500; // memory beside its bytes, decoded frames among it

export interface Part {
  readonly chunk: Chunk;
  readonly first: number; // frame
  readonly last: number;
  state: "away" | "coming" | "here" | "damaged";
  messages: RawMessage[]; // in the order of the file
  byFrame: Map<number, RawMessage[]>;
  sequences: number[]; // of its frames, ascending
  bytes: number;
  used: number; // when, in calls
}

export class Chunks {
  readonly parts: Part[];
  private bytes = 0;
  private largest = 0; // bytes of a part
  private calls = 0;

  /** @param sequenceOf  the frame at a time of the file */
  constructor(private readonly container: Container, private readonly sequenceOf: (timeNs: bigint) => number,
              private readonly byteLimit = mostBytes) {
    this.parts = container.chunks.map((chunk) => ({ chunk, first: sequenceOf(chunk.startNs), last: sequenceOf(chunk.endNs),
      state: "away", messages: [], byFrame: new Map(), sequences: [], bytes: 0, used: 0 }));
  }

  /** The parts that have a frame, in their order: one, or several where one ends within the frame. If none has it, the one before. */
  at(sequence: number): Part[] {
    const last = Math.max(upperBound(this.parts, sequence, ({ first }) => first) - 1, 0);
    const found = [this.parts[last]];
    for (let i = last - 1; i >= 0 && i > last - 4 && this.parts[i].last >= sequence; --i) found.unshift(this.parts[i]);
    return found;
  }

  after(part: Part): Part | undefined { return this.parts[this.parts.indexOf(part) + 1]; }
  before(part: Part): Part[] { return this.parts.slice(0, this.parts.indexOf(part)).reverse(); }

  /** A part is looked at now: it stays longest. */
  use(part: Part): void { part.used = ++this.calls; }

  /** Whether another chunk fits without forgetting one. */
  hasRoomFor(part: Part): boolean { return part.state === "away" && this.bytes + 2 * this.largest < this.byteLimit; }

  /** Takes the messages that were read of a part. */
  keep(part: Part, messages: RawMessage[]): void {
    part.messages = messages;
    part.byFrame = new Map();
    part.bytes = 0;
    for (const message of messages) {
      const sequence = this.sequenceOf(message.timeNs);
      const list = part.byFrame.get(sequence);
      if (list) list.push(message);
      else part.byFrame.set(sequence, [message]);
      part.bytes += message.data.byteLength + ofMessage;
    }
    part.bytes = Math.max(part.bytes, messages[0]?.data.buffer.byteLength ?? 0);
    part.sequences = [...part.byFrame.keys()].sort((a, b) => a - b);
    part.state = "here";
    this.bytes += part.bytes;
    this.largest = Math.max(this.largest, part.bytes);
  }

  /** Forgets what was not looked at for longest, until the rest has its bound. @param forgotten  is called with each part */
  trim(forgotten: (part: Part) => void): void {
    while (this.bytes > this.byteLimit) {
      const here = this.parts.filter(({ state, used }) => state === "here" && used < this.calls);
      if (here.length < 2) return;
      const old = here.reduce((a, b) => (a.used < b.used ? a : b));
      forgotten(old);
      this.bytes -= old.bytes;
      Object.assign(old, { state: "away", messages: [], byFrame: new Map(), sequences: [], bytes: 0 });
    }
  }

  /** The frame in memory that is nearest to a place; null: none is. */
  nearest(sequence: number): number | null {
    let best: number | null = null;
    for (const { state, sequences } of this.parts) {
      if (state !== "here" || sequences.length === 0) continue;
      const behind = upperBound(sequences, sequence, (one) => one);
      for (const found of [sequences[behind - 1], sequences[behind]]) {
        if (found !== undefined && (best === null || Math.abs(found - sequence) < Math.abs(best - sequence))) best = found;
      }
    }
    return best;
  }

  /** The last frame at or before a place of those in memory that has a message of a topic; it looks back so many frames. */
  newestWith(topic: string, sequence: number, back: number): number | null {
    const least = Math.max(sequence - back, -1);
    for (const part of [this.at(sequence).at(-1)!].flatMap((last) => [last, ...this.before(last)])) {
      if (part.last <= least) return null;
      for (let i = upperBound(part.sequences, sequence, (one) => one) - 1; i >= 0 && part.sequences[i] > least; --i) {
        const messages = part.byFrame.get(part.sequences[i]) ?? [];
        if (messages.some(({ channel }) => this.container.channels.get(channel)?.topic === topic)) return part.sequences[i];
      }
    }
    return null;
  }
}

/** Number of elements of an ascending list that are not above a value. */
export function upperBound<T>(list: readonly T[], value: number, keyOf: (one: T) => number): number {
  let low = 0, high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (keyOf(list[middle]) <= value) low = middle + 1;
    else high = middle;
  }
  return low;
}
