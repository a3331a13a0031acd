// SPDX-License-Identifier: MIT
// Past that the page has seen: a bounded buffer of frames. A frame has the messages of one tick; they
// stay encoded, so that an hour of a small world fits.
import type { Message } from "../data/source";
import type { Poses, World } from "./messages";
import { kept, mostShown } from "./texts";

export const mostBytes = 192 * 1024 * 1024;
export const mostFrames = 40_000;

export interface Frame {
  readonly sequence: number; // counts frames since the page was opened
  readonly timeNs: bigint; // simulated
  tick: number;
  world: World | null;
  readonly messages: Map<string, Message>;
}

export type MarkKind = "log" | "warning" | "error" | "missed" | "session" | "collision" | "reset" | "bookmark";

/** Something that happened. */
export interface Mark {
  sequence: number; // of the frame
  kind: MarkKind;
  text: string;
}

/** Frames by their numbers: those that the page has seen of a running world, or those of a recording. */
export interface Frames {
  readonly length: number;
  readonly first: number;
  readonly last: number;
  readonly newest: Frame | null;
  readonly marks: Mark[];
  /** The frame, or the nearest one before; null while it is being read. */
  at(sequence: number): Frame | null;
  /** The tick of a frame. A recording counts on where its world was reset: each has its own number. null: not known yet. */
  tickOf(sequence: number): number | null;
  /** The frame at a tick, or the last one before; null: none is, yet. */
  sequenceOf(tick: number): number | null;
  /** Simulated time from a frame to the next one [ns]; null: not known yet. */
  stepNs(sequence: number): number | null;
  /**
   * The newest message of a topic at or before a frame; it looks back so many frames.
   * @param entity  whose topic it is in the world of that frame: messages of another one with the same id are not taken
   */
  message(topic: string, sequence: number, back?: number, entity?: number): Message | null;
}

/** Whether an entity of a frame's world was in the world of an earlier one: lists grow at their ends only, until a reset. */
function wasThere(entity: number, { world, tick }: Frame, earlier: Frame): boolean {
  if (!world || !earlier.world || world === earlier.world) return true;
  return earlier.tick <= tick && earlier.world.entities[entity]?.id === world.entities[entity]?.id;
}

/** Frames.message. @param frames  from the frame on, backwards; null: not held */
export function newestMessage(topic: string, frames: Iterable<Frame | null | undefined>, entity?: number): Message | null {
  let later: Frame | null = null;
  for (const frame of frames) {
    if (!frame) continue;
    if (entity !== undefined && later && !wasThere(entity, later, frame)) return null;
    const found = frame.messages.get(topic);
    if (found) return found;
    if (frame.world) later = frame;
  }
  return null;
}

export class Timeline implements Frames {
  private frames: Frame[] = [];
  private begin = 0; // of the frames in use; the array is cut now and then
  private bytes = 0;
  private next = 0;
  private runBegin = 0; // frame, since the last reset
  private generation = -1;
  private worlds = new Map<number, World>();
  private lastMissed = 0;
  marks: Mark[] = [];

  constructor(private readonly byteLimit = mostBytes, private readonly frameLimit = mostFrames) {}

  get length(): number { return this.frames.length - this.begin; }
  get first(): number { return this.length > 0 ? this.frames[this.begin].sequence : 0; }
  get last(): number { return this.length > 0 ? this.frames[this.frames.length - 1].sequence : -1; }
  get newest(): Frame | null { return this.length > 0 ? this.frames[this.frames.length - 1] : null; }
  get heldBytes(): number { return this.bytes; }

  /** The frame, or the nearest one that is still held. */
  at(sequence: number): Frame | null {
    if (this.length === 0) return null;
    const index = Math.min(Math.max(sequence - this.first, 0), this.length - 1);
    return this.frames[this.begin + index];
  }

  stepNs(sequence: number): number | null {
    const [a, b] = [this.at(sequence), this.at(sequence + 1)];
    return a && b ? Math.max(0, Number(b.timeNs - a.timeNs)) : null; // after a reset time begins again
  }

  tickOf(sequence: number): number | null { return this.at(sequence)?.tick ?? null; }

  /** Frame of a tick in the newest run, whose ticks only grow. */
  sequenceOf(tick: number): number | null {
    let low = Math.max(this.first, this.runBegin), high = this.last;
    const at = (sequence: number): number => this.tickOf(sequence) ?? 0;
    if (this.length === 0 || at(low) > tick || at(high) < tick) return null;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (at(middle) <= tick) low = middle;
      else high = middle - 1;
    }
    // Frames whose poses were not sent have the tick of the frame before them, and no picture of their own.
    while (low > Math.max(this.first, this.runBegin) && at(low - 1) === at(low)) --low;
    return low;
  }

  clear(): void {
    this.frames = [];
    this.begin = this.bytes = 0;
    this.marks = [];
    this.worlds.clear();
  }

  /** Takes a message; true if it began a frame. */
  take(message: Message): boolean {
    let frame = this.newest;
    let isNew = !frame || message.timeNs > frame.timeNs;
    if (message.topic === "/world") {
      const world = message.read<World>();
      this.generation = world.generation;
      this.worlds.set(world.generation, world);
      if (this.worlds.size > 64) this.worlds.delete(this.worlds.keys().next().value as number);
      if (frame && message.timeNs < frame.timeNs) {
        this.mark("reset", "the world went back to its start");
        this.runBegin = this.next;
        isNew = true;
      }
    } else if (message.topic === "/log" || message.topic === "/barrier") {
      isNew = !frame; // they have no tick of their own
    } else if (frame && message.timeNs < frame.timeNs) {
      frame = this.withTime(message.timeNs) ?? frame; // sent again for a new subscription
    }
    if (!frame || isNew) {
      frame = { sequence: this.next++, timeNs: message.timeNs, tick: frame?.tick ?? 0, world: this.world(),
                messages: new Map() };
      this.frames.push(frame);
    }
    this.bytes += message.bytes - (frame.messages.get(message.topic)?.bytes ?? 0);
    frame.messages.set(message.topic, message);
    if (message.topic === "/world" && !frame.world) frame.world = this.world();
    if (message.topic === "/poses") this.takePoses(frame, message);
    this.forgetOld();
    return isNew;
  }

  /** One of the newest frames. */
  private withTime(timeNs: bigint): Frame | undefined {
    for (let s = this.last; s >= this.first && s > this.last - 100; --s) {
      const frame = this.at(s);
      if (frame?.timeNs === timeNs) return frame;
    }
    return undefined;
  }

  private takePoses(frame: Frame, message: Message): void {
    const poses = message.read<Poses>();
    frame.tick = poses.tick;
    const before = frame.world;
    frame.world = this.worlds.get(poses.generation) ?? before;
    if (before && frame.world !== before) this.dropOfOthers(frame, before);
  }

  /** Drops the messages of removed robots with whose ids others were spawned in the same tick. */
  private dropOfOthers({ world, messages }: Frame, before: World): void {
    world?.entities.forEach(({ id, robot }, i) => {
      if (robot === undefined || before.entities[i]?.id === id) return;
      for (const topic of [`/robots/${id}/observation`, `/robots/${id}/command`]) {
        this.bytes -= messages.get(topic)?.bytes ?? 0;
        messages.delete(topic);
      }
    });
  }

  private world(): World | null { return this.worlds.get(this.generation) ?? null; }

  mark(kind: MarkKind, text: string): void {
    this.marks.push({ sequence: Math.max(this.last, 0), kind, text: kept(text, mostShown) });
    if (this.marks.length > 5000) this.marks.splice(0, 1000);
  }

  /** Marks deadlines that were missed since the last call. */
  noteMissed(total: number): void {
    if (total > this.lastMissed) this.mark("missed", `${total - this.lastMissed} deadlines missed`);
    this.lastMissed = total;
  }

  message(topic: string, sequence: number, back = 400, entity?: number): Message | null {
    return newestMessage(topic, this.backwards(sequence, back), entity);
  }

  private *backwards(sequence: number, back: number): Generator<Frame | null> {
    for (let s = Math.min(sequence, this.last); s >= this.first && s > sequence - back; --s) yield this.at(s);
  }

  private forgetOld(): void {
    while (this.length > 2 && (this.bytes > this.byteLimit || this.length > this.frameLimit)) {
      const old = this.frames[this.begin++];
      for (const message of old.messages.values()) this.bytes -= message.bytes;
      old.messages.clear();
    }
    if (this.begin > 1024 && this.begin * 2 > this.frames.length) {
      this.frames = this.frames.slice(this.begin);
      this.begin = 0;
      const first = this.first;
      this.marks = this.marks.filter((mark) => mark.sequence >= first);
    }
  }
}
