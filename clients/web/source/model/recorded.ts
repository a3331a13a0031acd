// SPDX-License-Identifier: MIT
// A recording: all its frames, of which those in view are in memory. Frames are the ticks of the recording from its
// first, so that their places on the time line are known before they are read. A frame is decoded when it is looked at.
// In the background all of the file is read once, for log lines, collisions and plots; what has room stays in memory.
import type { IReadable } from "@mcap/core";
import { Container, type RawMessage } from "../data/container";
import type { Decoder } from "../data/decode";
import { Held } from "../data/held";
import type { Listener, Message, Source, Value } from "../data/source";
import { areWhole, checkWorld } from "./check";
import { Chunks, upperBound, type Part } from "./chunks";
import { Collisions } from "./collisions";
import { decoderIn, endOf, findWorld } from "./first_world";
import type { Contacts, Log, Poses, World } from "./messages";
import { metricsIn, metricsTopic, type Metrics } from "./metrics";
import { Pieces } from "./pieces";
import type { Series } from "./series";
import { kept, mostShown } from "./texts";
import { newestMessage, type Frame, type Frames, type Mark } from "./timeline";

const mostFrames = 1e8;
const mostPoints = 20_000; // of a plot
const untilDrawn = 400; // [ms], for the first frame, before all is read
const mostTold = 3; // messages that are left out; further ones are told together
const mostLeftOut = 100_000; // that are remembered
const longestPause = 40; // [ms] between chunks, when all of the file is read
const mostReads = 2; // at the same time: of a drag over many chunks only some are read, and its end soon

/** A series that is filled with every so many frames of the file. */
interface Filling { series: Series; stride: number; done: () => void }

/** Fields of /inputs, protocol/ziggurat/v1/run.proto: acts of supervisors and viewers, and metrics. */
interface Inputs extends Metrics { acts: Record<string, Record<string, unknown> | undefined>[] }

export class Recorded implements Source, Frames {
  readonly isLive = false;
  readonly first = 0;
  readonly last: number;
  readonly marks: Mark[] = [];
  /** Last values of the run's metrics, by ROBOT/NAME; those of the whole file, when it was read. */
  readonly metrics = new Map<string, number>();
  private readonly chunks: Chunks;
  private readonly frames = new Map<number, Frame>(); // that were looked at, of chunks in memory
  private readonly worlds = new Map<number, World>(); // by generation
  private readonly decoders = new Map<number, Decoder | null>(); // by channel; those of one schema are the same
  private readonly bySchema = new Map<number, Decoder | null>();
  private readonly startNs: bigint;
  private tickNs: number;
  private firstTick: number | null = null; // null: not read yet
  private readonly missing = new Set<number>(); // generations without a world that can be read
  private readonly searched = new Set<number>(); // generations whose world is looked for
  private readonly leftOut = new Set<string>();
  private reads = 0;
  private listener: Listener | null = null;
  private unread: Filling[] = [];
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
    this.chunks = new Chunks(container, (timeNs) => this.placeOf(timeNs));
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
    const topics = new Set([...this.container.channels.values()].map(({ topic }) => topic));
    if (this.metrics.size > 0) topics.add(metricsTopic);
    this.listener?.topics([...topics].sort());
  }

  // --- frames ---------------------------------------------------------------------------------------

  private placeOf(timeNs: bigint): number {
    return Math.min(Math.max(Math.round(Number(timeNs - this.startNs) / this.tickNs), 0), mostFrames);
  }

  stepNs(): number { return this.tickNs; }

  tickOf(sequence: number): number | null {
    return this.firstTick === null ? null : this.firstTick + sequence;
  }

  sequenceOf(tick: number): number | null {
    return this.firstTick === null ? null : Math.min(Math.max(tick - this.firstTick, 0), this.last);
  }

  at(sequence: number): Frame | null {
    const wanted = Math.min(Math.max(Math.round(sequence), 0), this.last);
    const parts = this.chunks.at(wanted);
    for (const part of parts) this.need(part);
    const last = parts[parts.length - 1];
    const next = this.chunks.after(last); // so that playing does not wait
    if (next && wanted > (last.first + last.last) / 2) this.need(next);
    if (parts.some(({ state }) => state === "away" || state === "coming")) return null;
    for (const part of parts.reverse()) {
      const found = part.sequences[upperBound(part.sequences, wanted, (one) => one) - 1];
      if (found !== undefined) return this.make(found);
    }
    return null;
  }

  /** The frame in memory that is nearest to a place, while that is being read. */
  nearest(sequence: number): Frame | null {
    const found = this.chunks.nearest(sequence);
    return found === null ? null : this.make(found);
  }

  message(topic: string, sequence: number, back = 400, entity?: number): Message | null {
    const found = this.chunks.newestWith(topic, sequence, back);
    if (found === null) return null;
    const begin = entity === undefined ? found : Math.min(sequence, this.last); // whose it is, its way here tells
    const frames = Array.from({ length: begin - found + 1 }, (_, i) => this.make(begin - i));
    return newestMessage(topic, frames, entity);
  }

  private need(part: Part): void {
    this.chunks.use(part);
    if (part.state === "away" && this.reads < mostReads) void this.load(part);
  }

  private async load(part: Part): Promise<void> {
    part.state = "coming";
    ++this.reads;
    try {
      this.keep(part, await this.container.read(part.chunk));
    } catch (error) {
      part.state = "damaged";
      this.listener?.notice("error", `${this.name} is damaged at ${(part.first * this.tickNs * 1e-9).toFixed(2)} s: ${(error as Error).message}. `
        + "The rest can be shown.");
    }
    --this.reads;
  }

  private keep(part: Part, messages: RawMessage[]): void {
    for (const message of messages) {
      if (this.topicOf(message) === "/world") this.takeWorld(message);
    }
    this.chunks.keep(part, messages);
    this.chunks.trim(({ sequences }) => { for (const sequence of sequences) this.frames.delete(sequence); });
  }

  private topicOf(message: RawMessage): string { return this.container.channels.get(message.channel)?.topic ?? ""; }

  private takeWorld(message: RawMessage): void {
    const world = this.decode<World>(message);
    if (!world || this.worlds.has(world.generation)) return;
    checkWorld(world);
    this.worlds.set(world.generation, world);
  }

  /** Finds the world that poses of a part belong to, before it. */
  private async search(generation: number, part: Part): Promise<void> {
    if (this.searched.has(generation)) return;
    this.searched.add(generation);
    for (const { chunk } of this.chunks.before(part)) {
      if (chunk.channels && ![...chunk.channels].some((id) => this.container.channels.get(id)?.topic === "/world")) continue;
      try {
        for (const message of await this.container.read(chunk)) {
          if (this.topicOf(message) === "/world") this.takeWorld(message);
        }
      } catch { /* load() says it when the place is looked at */ }
      if (this.worlds.has(generation)) return;
    }
    this.missing.add(generation);
  }

  /** A frame of the parts in memory, of its messages; null: it has none, or its world is still looked for. */
  private make(sequence: number): Frame | null {
    const known = this.frames.get(sequence);
    if (known) return known;
    const parts = this.chunks.at(sequence).filter((part) => part.byFrame.has(sequence));
    let frame: Frame | null = null;
    for (const part of parts) {
      for (const message of part.byFrame.get(sequence) ?? []) {
        const held = this.hold(message);
        if (!held) continue;
        frame ??= { sequence, timeNs: message.timeNs, tick: sequence, world: null, messages: new Map() };
        if (held.topic === "/poses") {
          const poses = held.read<Poses>();
          const world = this.worlds.get(poses.generation);
          if (!world && !this.missing.has(poses.generation)) {
            void this.search(poses.generation, part);
            return null;
          }
          if (!world || !areWhole(poses, world)) continue;
          frame.world = world;
          frame.tick = poses.tick;
          if (sequence === 0) this.firstTick ??= poses.tick;
        }
        frame.messages.set(held.topic, held);
      }
    }
    if (frame) this.frames.set(sequence, frame);
    return frame;
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

  /** null: it can't be read. */
  private hold(message: RawMessage): Held | null {
    const decoder = this.decoderOf(message.channel);
    if (!decoder || this.leftOut.has(keyOf(message))) return null;
    try {
      return new Held(this.topicOf(message), message.timeNs, message.data, decoder);
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

  /** Fills a series with its numbers of the whole recording, in the background. @param most  points, about */
  fill(series: Series, most = mostPoints): Promise<void> {
    return new Promise((done) => {
      this.unread.push({ series, stride: Math.max(1, Math.ceil(this.length / most)), done });
      void this.readAll();
    });
  }

  private async readAll(): Promise<void> {
    if (this.isReading) return;
    this.isReading = true;
    await Promise.resolve(); // what is asked for at the same time is read together
    while (!this.isClosed && (!this.hasRead || this.unread.length > 0)) {
      const fillings = this.unread;
      this.unread = [];
      const isFirst = !this.hasRead;
      this.hasRead = true;
      await this.visit(isFirst, fillings);
      for (const { done } of fillings) done();
      this.tellTopics(); // those of a file without summary are known now
    }
    this.isReading = false;
  }

  private async visit(isFirst: boolean, fillings: Filling[]): Promise<void> {
    const collisions = new Collisions();
    const topics = new Set(fillings.map(({ series }) => recordedTopic(series.name.topic)));
    if (isFirst) for (const topic of ["/log", "/contacts", "/inputs"]) topics.add(topic);
    for (const part of this.chunks.parts) {
      while (this.reads > 0 && !this.isClosed) await new Promise((resolve) => setTimeout(resolve, 5)); // the user waits
      if (this.isClosed) return;
      const begin = performance.now();
      const pieces = new Pieces();
      for (const message of await this.messagesOf(part)) {
        const topic = this.topicOf(message);
        if (!topics.has(topic)) continue;
        await pieces.next();
        const sequence = this.placeOf(message.timeNs);
        if (isFirst) this.note(topic, sequence, message, collisions);
        for (const { series, stride } of fillings) {
          if (recordedTopic(series.name.topic) !== topic || sequence % stride !== 0) continue;
          series.add(sequence, Number(message.timeNs) * 1e-9, this.decode(message));
        }
      }
      const pause = Math.min(performance.now() - begin, longestPause); // time for drawing
      await new Promise((resolve) => setTimeout(resolve, pause));
    }
  }

  /** Messages of a chunk, which stays in memory if there is room: load() tells what is damaged when the place is looked at. */
  private async messagesOf(part: Part): Promise<RawMessage[]> {
    if (part.state !== "away") return part.messages.length > 0 ? part.messages : this.container.read(part.chunk).catch(() => []);
    try {
      const messages = await this.container.read(part.chunk);
      if (this.chunks.hasRoomFor(part)) this.keep(part, messages);
      return messages;
    } catch {
      return [];
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
      const inputs = this.decode<Inputs>(message);
      for (const act of inputs?.acts ?? []) {
        const name = ["spawn", "remove", "move", "reset", "restore", "snapshot"].find((key) => act[key] !== undefined);
        if (name) this.mark(sequence, "reset", `${name} ${String(act[name]?.["entity"] ?? act[name]?.["name"] ?? "")}`);
      }
      for (const { path, value } of inputs ? metricsIn(inputs) : []) this.metrics.set(path, value);
    }
  }

  private mark(sequence: number, kind: Mark["kind"], text: string): void {
    if (this.marks.length < 20_000) this.marks.push({ sequence, kind, text: kept(text, mostShown) });
  }
}

/** The topic of the file that has what is shown under a topic. */
function recordedTopic(topic: string): string { return topic === metricsTopic ? "/inputs" : topic; }

/** Key of a message in the file. */
function keyOf({ channel, timeNs, data }: RawMessage): string { return `${channel} ${timeNs} ${data.byteOffset}`; }
