// A recording: all its frames, of which those in view are in memory. Frames are the ticks of the recording from its
// first, so that their places on the time line are known before they are read. In the background all of the file is
// read once, for log lines, collisions and plots.
import type { IReadable } from "@mcap/core";
import { Container, type Chunk, type RawMessage } from "../data/container";
import type { Decoder } from "../data/decode";
import { Held } from "../data/held";
import type { Listener, Message, Source, Value } from "../data/source";
import { areWhole, checkWorld } from "./check";
import { Collisions } from "./collisions";
import { decoderIn, endOf, findWorld } from "./first_world";
import type { Contacts, Log, Poses, World } from "./messages";
import { Pieces } from "./pieces";
import type { Series } from "./series";
import { kept, mostShown } from "./texts";
import { newestMessage, type Frame, type Frames, type Mark } from "./timeline";

const mostBytes = 192 * 1024 * 1024; // of frames in memory
const mostFrames = 1e8;
const mostPoints = 6000; // of a plot
const untilDrawn = 400; // [ms], for the first frame, before all is read
const mostTold = 3; // messages that are left out; further ones are told together
const mostLeftOut = 100_000; // that are remembered
const ofMessage = 300; // memory beside its bytes

interface Part {
  readonly chunk: Chunk;
  readonly first: number; // frame
  readonly last: number;
  state: "away" | "coming" | "here" | "damaged";
  frames: number[];
  bytes: number;
  used: number; // when, in calls
}

/** An act of a supervisor or viewer, in /inputs: protocol/ziggurat/v1/run.proto. */
interface Acts { acts: Record<string, Record<string, unknown> | undefined>[] }

export class Recorded implements Source, Frames {
  readonly isLive = false;
  readonly first = 0;
  readonly last: number;
  readonly marks: Mark[] = [];
  private readonly parts: Part[] = [];
  private readonly frames = new Map<number, Frame>();
  private readonly worlds = new Map<number, World>(); // by generation
  private readonly decoders = new Map<number, Decoder | null>(); // by channel; those of one schema are the same
  private readonly bySchema = new Map<number, Decoder | null>();
  private readonly startNs: bigint;
  private tickNs: number;
  private readonly missing = new Set<number>(); // generations without a world that can be read
  private readonly leftOut = new Set<string>();
  private bytes = 0;
  private calls = 0;
  private listener: Listener | null = null;
  private unread: Series[] = [];
  private isReading = false;
  private hasRead = false; // log and collisions
  private isClosed = false;

  private constructor(readonly name: string, readonly container: Container, first: World) {
    this.startNs = container.chunks[0].startNs;
    const endNs = container.chunks.reduce((end, chunk) => (chunk.endNs > end ? chunk.endNs : end), this.startNs);
    const length = Number(endNs - this.startNs);
    this.tickNs = Math.max(first.tickNs, length / mostFrames);
    this.last = Math.round(length / this.tickNs);
    this.worlds.set(first.generation, first);
    for (const chunk of container.chunks) {
      this.parts.push({ chunk, first: this.sequenceOf(chunk.startNs), last: this.sequenceOf(chunk.endNs),
                        state: "away", frames: [], bytes: 0, used: 0 });
    }
  }

  /** @throws Error with a sentence for the user */
  static async open(file: IReadable, name: string): Promise<Recorded> {
    try {
      const container = await Container.open(file);
      return new Recorded(name, container, await findWorld(container));
    } catch (error) {
      const text = (error as Error).message;
      throw new Error(/^(is|has) /.test(text) ? `${name} ${text}.` : `${name} can't be read: ${text}.`);
    }
  }

  get length(): number { return this.last + 1; }
  get newest(): Frame | null { return this.frames.get(this.last) ?? null; }
  get isCut(): boolean { return this.container.isCut; }
  get seconds(): number { return this.last * this.tickNs * 1e-9; }

  /** When a frame is, from the beginning of the recording [s]. */
  secondsOf(frame: Frame): number { return this.secondsAt(frame.timeNs); }
  private secondsAt(timeNs: bigint): number { return Number(timeNs - this.startNs) * 1e-9; }

  // --- a source that answers nothing ----------------------------------------------------------------

  start(listener: Listener): void {
    this.listener = listener;
    listener.status({ phase: "open", text: "", mayControl: false, session: this.name });
    this.tellTopics();
    if (this.isCut) {
      listener.notice("warning", `${this.name} is cut off after ${this.seconds.toFixed(2)} s, as by a run that was killed. What is whole `
        + "is shown. `ziggurat info FILE --repair OUT` writes a whole file of it.");
    }
    this.at(0);
    setTimeout(() => void this.readAll(), untilDrawn);
  }

  want(): void { /* all of it is there */ }
  call(): Promise<Value> { return Promise.reject(new Error("a recording can't be changed")); }
  setParameter(): void { /* it has none */ }
  close(): void { this.isClosed = true; }

  private tellTopics(): void {
    this.listener?.topics([...new Set([...this.container.channels.values()].map(({ topic }) => topic))].sort());
  }

  // --- frames ---------------------------------------------------------------------------------------

  private sequenceOf(timeNs: bigint): number {
    return Math.min(Math.max(Math.round(Number(timeNs - this.startNs) / this.tickNs), 0), mostFrames);
  }

  stepNs(): number { return this.tickNs; }

  at(sequence: number): Frame | null {
    const wanted = Math.min(Math.max(Math.round(sequence), 0), this.last);
    const parts = this.partsAt(wanted);
    ++this.calls;
    for (const part of parts) {
      part.used = this.calls;
      if (part.state === "away") void this.load(part);
    }
    const next = this.parts[this.parts.indexOf(parts[0]) + 1]; // so that playing does not wait
    if (next?.state === "away" && wanted > (parts[0].first + parts[0].last) / 2) void this.load(next);
    if (parts.some(({ state }) => state === "coming")) return null;
    for (const part of parts) {
      let low = 0, high = part.frames.length;
      while (low < high) { // the first one behind
        const middle = (low + high) >> 1;
        if (part.frames[middle] <= wanted) low = middle + 1;
        else high = middle;
      }
      const found = this.frames.get(part.frames[low - 1]);
      if (found) return found;
    }
    return null;
  }

  /** The parts that have a frame, the last first: one, or two where one ends within the frame. If none has it, the one before. */
  private partsAt(sequence: number): Part[] {
    let low = 0, high = this.parts.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.parts[middle].first <= sequence) low = middle + 1;
      else high = middle;
    }
    const last = Math.max(low - 1, 0);
    const found = [this.parts[last]];
    for (let i = last - 1; i >= 0 && i > last - 4 && this.parts[i].last >= sequence; --i) found.push(this.parts[i]);
    return found;
  }

  message(topic: string, sequence: number, back = 400, entity?: number): Message | null {
    return newestMessage(topic, this.backwards(sequence, back), entity);
  }

  private *backwards(sequence: number, back: number): Generator<Frame | undefined> {
    for (let s = Math.min(sequence, this.last); s >= 0 && s > sequence - back; --s) yield this.frames.get(s);
  }

  private async load(part: Part): Promise<void> {
    part.state = "coming";
    try {
      const messages = await this.container.read(part.chunk);
      await this.knowWorlds(part, messages);
      await this.makeFrames(part, messages);
      part.state = "here";
    } catch (error) {
      part.state = "damaged";
      this.listener?.notice("error", `${this.name} is damaged at ${(part.first * this.tickNs * 1e-9).toFixed(2)} s: ${(error as Error).message}. `
        + "The rest can be shown.");
    }
    this.forgetOld();
  }

  /** Finds the worlds that the part's poses belong to. */
  private async knowWorlds(part: Part, messages: RawMessage[]): Promise<void> {
    const generations = new Set<number>();
    for (const message of messages) {
      const topic = this.container.channels.get(message.channel)?.topic;
      if (topic === "/world") this.takeWorld(message);
      if (topic === "/poses") generations.add(this.decode<Poses>(message)?.generation ?? 0);
    }
    const isUnknown = (): boolean => [...generations].some((generation) => !this.worlds.has(generation) && !this.missing.has(generation));
    for (let i = this.parts.indexOf(part) - 1; i >= 0 && isUnknown(); --i) {
      const { channels } = this.parts[i].chunk;
      if (channels && ![...channels].some((id) => this.container.channels.get(id)?.topic === "/world")) continue;
      for (const message of await this.container.read(this.parts[i].chunk)) {
        if (this.container.channels.get(message.channel)?.topic === "/world") this.takeWorld(message);
      }
    }
    for (const generation of generations) if (!this.worlds.has(generation)) this.missing.add(generation);
  }

  private takeWorld(message: RawMessage): void {
    const world = this.decode<World>(message);
    if (!world || this.worlds.has(world.generation)) return;
    checkWorld(world);
    this.worlds.set(world.generation, world);
  }

  private async makeFrames(part: Part, messages: RawMessage[]): Promise<void> {
    let frame: Frame | undefined;
    const pieces = new Pieces();
    for (const message of messages) {
      await pieces.next();
      const channel = this.container.channels.get(message.channel);
      const decoder = this.decoderOf(message.channel);
      if (!channel || !decoder) continue;
      const held = this.hold(channel.topic, message, decoder);
      if (!held) continue;
      const sequence = this.sequenceOf(message.timeNs);
      if (frame?.sequence !== sequence) frame = this.frames.get(sequence);
      if (!frame) {
        frame = { sequence, timeNs: message.timeNs, tick: sequence, world: null, messages: new Map() };
        this.frames.set(sequence, frame);
        part.frames.push(sequence);
      }
      if (channel.topic === "/poses") {
        const poses = held.read<Poses>();
        const world = this.worlds.get(poses.generation);
        if (!world || !areWhole(poses, world)) continue;
        frame.world = world;
        frame.tick = poses.tick;
      }
      frame.messages.set(channel.topic, held);
      part.bytes += message.data.byteLength + ofMessage;
    }
    part.bytes = Math.max(part.bytes, messages[0]?.data.buffer.byteLength ?? 0); // all of the chunk, if any of it is kept
    part.frames.sort((a, b) => a - b);
    this.bytes += part.bytes;
  }

  private forgetOld(): void {
    while (this.bytes > mostBytes) {
      const here = this.parts.filter(({ state, used }) => state === "here" && used < this.calls);
      if (here.length < 2) return;
      const old = here.reduce((a, b) => (a.used < b.used ? a : b));
      for (const sequence of old.frames) this.frames.delete(sequence);
      this.bytes -= old.bytes;
      Object.assign(old, { state: "away", frames: [], bytes: 0 });
    }
  }

  private decoderOf(id: number): Decoder | null {
    const known = this.decoders.get(id);
    if (known !== undefined) return known;
    const schema = this.container.channels.get(id)?.schema ?? -1;
    const decoder = this.bySchema.get(schema) ?? decoderIn(this.container, id);
    this.bySchema.set(schema, decoder);
    this.decoders.set(id, decoder);
    if (!decoder) {
      this.listener?.notice("warning", `${this.container.channels.get(id)?.topic ?? `channel ${id}`} can't be read: its schema is unknown or damaged.`);
    }
    return decoder;
  }

  /** null: it can't be read. */
  private decode<T>(message: RawMessage): T | null {
    if (this.leftOut.has(keyOf(message))) return null;
    try {
      return (this.decoderOf(message.channel)?.(message.data) as T | undefined) ?? null;
    } catch (error) {
      this.leaveOut(message, endOf(error));
      return null;
    }
  }

  private hold(topic: string, message: RawMessage, decoder: Decoder): Held | null {
    if (this.leftOut.has(keyOf(message))) return null;
    try {
      return new Held(topic, message.timeNs, message.data, decoder);
    } catch (error) {
      this.leaveOut(message, endOf(error));
      return null;
    }
  }

  /** @param why  the end of a sentence that begins with the message */
  private leaveOut(message: RawMessage, why: string): void {
    if (this.leftOut.size > mostLeftOut) return;
    const count = this.leftOut.add(keyOf(message)).size;
    const topic = this.container.channels.get(message.channel)?.topic ?? "";
    if (count <= mostTold) {
      this.listener?.notice("error", `${this.name}: ${topic} at ${this.secondsAt(message.timeNs).toFixed(2)} s ${why}. It is left out.`);
    } else if (count === mostTold + 1) {
      this.listener?.notice("error", `${this.name}: further messages can't be read, and are left out.`);
    }
  }

  // --- all of the file, once ------------------------------------------------------------------------

  /** Fills series with their numbers of the whole recording, in the background. */
  fill(series: Series): void {
    this.unread.push(series);
    void this.readAll();
  }

  private async readAll(): Promise<void> {
    if (this.isReading) return;
    this.isReading = true;
    while (!this.isClosed && (!this.hasRead || this.unread.length > 0)) {
      const series = this.unread;
      this.unread = [];
      const isFirst = !this.hasRead;
      this.hasRead = true;
      await this.visit(isFirst, series);
      this.tellTopics(); // those of a file without summary are known now
    }
    this.isReading = false;
  }

  private async visit(isFirst: boolean, series: Series[]): Promise<void> {
    const collisions = new Collisions();
    const stride = Math.max(1, Math.ceil(this.length / mostPoints));
    const topics = new Set(series.map(({ name }) => name.topic));
    if (isFirst) for (const topic of ["/log", "/contacts", "/inputs"]) topics.add(topic);
    for (const part of this.parts) {
      if (this.isClosed) return;
      const begin = performance.now();
      const pieces = new Pieces();
      let messages: RawMessage[] = [];
      try {
        messages = await this.container.read(part.chunk);
        for (const message of messages) {
          const topic = this.container.channels.get(message.channel)?.topic ?? "";
          if (!topics.has(topic)) continue;
          await pieces.next();
          const sequence = this.sequenceOf(message.timeNs);
          if (isFirst) this.note(topic, sequence, message, collisions);
          for (const one of series) {
            if (one.name.topic === topic && sequence % stride === 0) {
              one.add(sequence, Number(message.timeNs) * 1e-9, this.decode(message));
            }
          }
        }
      } catch { /* load() says it when the place is looked at */ }
      await new Promise((resolve) => setTimeout(resolve, performance.now() - begin)); // half of the time is for drawing
    }
  }

  private note(topic: string, sequence: number, message: RawMessage, collisions: Collisions): void {
    if (topic === "/log") {
      const log = this.decode<Log>(message);
      if (log) this.listener?.logged?.(log, sequence, Number(message.timeNs) * 1e-9);
      if (log) this.mark(sequence, log.level >= 4 ? "error" : log.level === 3 ? "warning" : "log", `${log.name}: ${log.message}`);
    } else if (topic === "/contacts") {
      const contacts = this.decode<Contacts>(message);
      const world = this.frames.get(sequence)?.world ?? [...this.worlds.values()].at(-1);
      const text = contacts && world ? collisions.take(contacts, Number(message.timeNs), world) : "";
      if (text) this.mark(sequence, "collision", text);
    } else if (topic === "/inputs") {
      for (const act of this.decode<Acts>(message)?.acts ?? []) {
        const name = ["spawn", "remove", "move", "reset", "restore", "snapshot"].find((key) => act[key] !== undefined);
        if (name) this.mark(sequence, "reset", `${name} ${String(act[name]?.["entity"] ?? act[name]?.["name"] ?? "")}`);
      }
    }
  }

  private mark(sequence: number, kind: Mark["kind"], text: string): void {
    if (this.marks.length < 20_000) this.marks.push({ sequence, kind, text: kept(text, mostShown) });
  }
}

/** Of a message in the file. */
function keyOf({ channel, timeNs, data }: RawMessage): string { return `${channel} ${timeNs} ${data.byteOffset}`; }
