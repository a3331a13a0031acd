// SPDX-License-Identifier: MIT
// State of the page and what it does; panels show it and call it. Nothing here touches the document.
import type { Listener, Message, Source, Status, Value } from "../data/source";
import type { View, Layer } from "../drawing/view";
import { layers } from "../drawing/view";
import { Collisions } from "../model/collisions";
import { Connections, lanes, type Lane } from "../model/marks";
import type { Barrier, Contacts, Entity, Log, Robot, World } from "../model/messages";
import { Playback } from "../model/playback";
import { Recorded } from "../model/recorded";
import { nameOf, Series, type SeriesName } from "../model/series";
import type { Settings, Tab } from "../model/settings";
import { LogLines } from "../model/log";
import { beginning } from "../model/texts";
import { Timeline, type Frame, type Frames, type Mark } from "../model/timeline";
import { Moments } from "./moments";
import { wantedTopics } from "./wanted";

export interface Notice { level: "info" | "warning" | "error"; text: string }

/** A frame that began less than this before may not be whole [ms]: its messages arrive one by one. */
const arrivalTime = 5;

export class App implements Listener {
  private seen = new Timeline(); // of a running world
  private collisions = new Collisions();
  private connections = new Connections();
  private readonly moments: Moments;
  readonly playback = new Playback();
  connection: Status = { phase: "connecting", text: "", mayControl: false, session: "" };
  topicNames: string[] = [];
  parameters = new Map<string, unknown>();
  log = new LogLines();
  barrier: Barrier | null = null;
  series: Series[] = [];
  pauseOnText = "";
  /** The frame that is shown; null: the newest. */
  pinned: number | null = null;
  /** The frame at which the page looks, the same during one redraw; it follows `pinned` at the next one. */
  frame: Frame | null = null;
  tool: "select" | "move" | "ruler" = "select";
  onNotice: (notice: Notice) => void = () => undefined;
  onStatus: () => void = () => undefined;
  onSettings: () => void = () => undefined;
  private session = "";
  private began = -Infinity; // when the newest frame's first message came [ms]
  private wantedFor: World | null = null; // the newest world at the last want()

  constructor(public source: Source, readonly settings: Settings, readonly view: View) {
    this.series = settings.plots.map((name) => new Series(name));
    this.moments = new Moments(settings);
    this.applySettings();
  }

  /** Shows another source from now on. */
  open(source: Source): void {
    this.source.close();
    this.source = source;
    this.seen = new Timeline();
    this.collisions = new Collisions();
    this.connections = new Connections();
    this.moments.forget();
    this.log = new LogLines();
    this.barrier = null;
    this.parameters.clear();
    this.session = "";
    this.frame = null;
    this.view.forget();
    this.series = this.settings.plots.map((name) => new Series(name));
    this.pinned = null;
    this.playback.isPlaying = false;
    if (source instanceof Recorded) {
      this.pinned = 0;
      for (const series of this.series) void source.fill(series);
      this.playback.speed = 1;
      if (!this.moments.isWaiting) this.playback.start();
    }
    source.start(this);
  }

  /** The recording that is shown. */
  get recorded(): Recorded | null { return this.source instanceof Recorded ? this.source : null; }

  get timeline(): Frames { return this.recorded ?? this.seen; }

  // --- what arrives ---------------------------------------------------------------------------------

  status(status: Status): void {
    if (status.phase === "open" && this.session !== "" && status.session !== this.session) {
      this.seen.clear();
      this.collisions = new Collisions();
      this.log = new LogLines();
      this.pinned = null;
      this.onNotice({ level: "info", text: "The server was started again." });
    }
    if (status.phase === "open") this.session = status.session;
    this.connection = status;
    this.onStatus();
    this.want();
  }

  topics(topics: string[]): void {
    this.topicNames = topics;
    this.want();
  }

  message(message: Message): void {
    if (this.seen.take(message)) this.began = performance.now();
    if (message.topic === "/contacts") this.takeContacts(message);
    if (message.topic === "/log") this.takeLog(message);
    if (message.topic === "/world" || (message.topic === "/poses" && this.seen.newest?.world !== this.wantedFor)) this.want();
    if (message.topic === "/barrier") {
      this.barrier = message.read<Barrier>();
      for (const text of this.connections.take(this.barrier.status?.sessions ?? [])) this.seen.mark("session", text);
      this.seen.noteMissed(this.barrier.histograms.reduce((sum, { missedTicks }) => sum + missedTicks, 0));
    }
  }

  parameter(name: string, value: unknown): void {
    this.parameters.set(name, value);
    this.onStatus();
  }

  notice(level: Notice["level"], text: string): void { this.onNotice({ level, text }); }

  private takeContacts(message: Message): void {
    const world = this.seen.newest?.world;
    const text = world ? this.collisions.take(message.read<Contacts>(), Number(message.timeNs), world) : "";
    if (text !== "") this.seen.mark("collision", text);
  }

  logged(line: Log, sequence: number, seconds: number): void { this.log.add(line, sequence, seconds); }

  private takeLog(message: Message): void {
    const line = message.read<Log>();
    const { level, message: text, name } = line;
    this.logged(line, this.seen.last, Number(message.timeNs) * 1e-9);
    this.seen.mark(level >= 4 ? "error" : level === 3 ? "warning" : "log", `${beginning(name)}: ${beginning(text)}`);
    if (this.pauseOnText !== "" && text.includes(this.pauseOnText)) {
      this.onNotice({ level: "info", text: `Paused: ${beginning(name)} logged “${text}”` });
      this.pauseOnText = "";
      void this.call("/pause");
    }
  }

  /** Subscribes what the page shows now. */
  want(): void {
    const newest = this.seen.newest?.world ?? null; // while the page looks back, too
    this.wantedFor = newest;
    this.source.want(wantedTopics(this, newest));
  }

  // --- what is shown --------------------------------------------------------------------------------

  get world(): World | null { return this.frame?.world ?? null; }

  /** Chooses the frame of this redraw. */
  chooseFrame(): void {
    const before = this.world;
    this.frame = this.recorded ? this.frameOf(this.recorded) : this.frameOfRun();
    if (this.world !== before) this.want();
    this.showMoment();
  }

  /** The moment of the address, as soon as it is there. */
  private showMoment(): void {
    const found = this.moments.find(this.timeline, this.recorded === null);
    if (found && "fault" in found) this.onNotice({ level: "warning", text: found.fault });
    else if (found) this.pin(found.sequence);
  }

  /** While the frame is being read, the nearest one that is there, so that a drag shows something at once. */
  private frameOf(recorded: Recorded): Frame | null {
    const wanted = this.pinned ?? recorded.last;
    return recorded.at(wanted) ?? (this.playback.isPlaying ? null : recorded.nearest(wanted)) ?? this.frame;
  }

  /** The newest frame that is whole, unless the user looks back. */
  private frameOfRun(): Frame | null {
    const { seen } = this;
    if (this.pinned !== null) return seen.at(this.pinned);
    const last = performance.now() - this.began < arrivalTime && seen.length > 1 ? seen.last - 1 : seen.last;
    for (let s = last; s >= seen.first && s > last - 3; --s) {
      const frame = seen.at(s);
      if (frame?.messages.has("/poses")) return frame;
    }
    return seen.newest;
  }

  get selected(): { entity: Entity; index: number } | null {
    const { selected } = this.settings;
    if (selected === null) return null;
    const entities = this.world?.entities ?? [];
    const index = entities.findIndex(({ id, removed }) => id === selected && !removed);
    return index < 0 ? null : { entity: entities[index], index };
  }

  get selectedRobot(): Robot | null {
    const robot = this.selected?.entity.robot;
    return robot === undefined ? null : this.world?.robots[robot] ?? null;
  }

  get selectedLinks(): number[] {
    const entity = this.selected?.entity;
    return entity ? Array.from({ length: entity.linkCount }, (_, i) => entity.firstLink + i) : [];
  }

  /** Whether the page looks at the newest frame of a running world. */
  get isLive(): boolean { return this.pinned === null && this.recorded === null; }

  /** Whether the run has ended: its world does not change any more. */
  get isOver(): boolean { return this.recorded === null && this.parameters.get("phase") === "over"; }

  /** Whether the page may move, spawn and remove, and begin anew: not in a recording, nor in a replay of one. */
  get mayChange(): boolean { return this.connection.mayControl && this.parameters.get("replay") !== true; }

  /** Whether time stands: that of the world, or that of the past or the recording that is shown. */
  get isPaused(): boolean { return this.isLive ? this.isOver || this.parameters.get("phase") === "paused" : !this.playback.isPlaying; }

  // --- what the user does ---------------------------------------------------------------------------

  pin(sequence: number | null): void {
    this.go(sequence);
    this.onSettings();
  }

  private go(sequence: number | null): void {
    const { first, last } = this.timeline;
    if (this.recorded) {
      this.pinned = Math.min(Math.max(sequence ?? last, first), last);
      this.recorded.at(this.pinned); // reading begins now
    } else {
      this.pinned = sequence === null || sequence >= last ? null : Math.max(sequence, first);
    }
    if (this.isLive) this.playback.isPlaying = false;
  }

  /** The tick of the address: where the page stands, in what it has; null: it goes on. */
  get addressTick(): number | null {
    if (this.moments.isWaiting) return this.settings.tick;
    return this.pinned === null || this.playback.isPlaying ? null : this.timeline.tickOf(this.pinned);
  }

  /** Marks of the user. */
  get bookmarks(): Mark[] { return this.moments.bookmarks; }

  /** Adds a bookmark at the frame that is shown, or removes its one. */
  toggleBookmark(): void {
    const tick = this.frame && this.timeline.tickOf(this.frame.sequence);
    if (!this.frame || tick === null) return;
    this.moments.toggle(tick, this.frame.sequence);
    this.onSettings();
  }

  /** Shows or hides a lane of the time line. */
  toggleLane(name: Lane): void {
    const { hiddenLanes } = this.settings;
    this.settings.hiddenLanes = lanes.map((lane) => lane.name).filter((lane) => hiddenLanes.includes(lane) !== (lane === name));
    this.onSettings();
  }

  /** Takes what another address says. */
  change(settings: Settings): void {
    Object.assign(this.settings, settings);
    this.series = settings.plots.map((name) => this.series.find((series) => nameOf(series.name) === nameOf(name)) ?? this.makeSeries(name));
    if (this.recorded) this.playback.isPlaying &&= settings.tick === null;
    this.moments.restart();
    this.applySettings();
    this.want();
  }

  private makeSeries(name: SeriesName): Series {
    const series = new Series(name);
    void this.recorded?.fill(series);
    return series;
  }

  /** One frame further, of what the page has; of a running world one tick. */
  step(): void {
    if (this.isLive) return void this.call("/step", { ticks: 1 });
    this.playback.isPlaying = false;
    this.pin((this.pinned ?? 0) + 1);
  }

  /** Back to the start: of the world, or of what the page has. */
  restart(): void {
    if (this.isLive) void this.call("/reset");
    else this.pin(this.timeline.first);
  }

  setSpeed(factor: number): void {
    if (this.isLive) void this.call("/speed", { factor });
    else this.playback.speed = factor;
  }

  /** Plays what the page has. @param now  wall time [s] */
  play(now: number): void {
    if (this.isLive || !this.playback.isPlaying) return;
    const { last } = this.timeline;
    const next = this.playback.advance(now, this.pinned ?? last, this.timeline);
    if (next !== this.pinned) this.go(next);
    if (next < last) return;
    this.playback.isPlaying = false;
    this.onSettings();
  }

  select(id: string | null): void {
    this.settings.selected = id;
    this.want();
    this.onSettings();
  }

  openTab(tab: Tab): void {
    this.settings.tab = tab;
    this.want();
    this.onSettings();
  }

  toggleLayer(name: Layer): void {
    const { shown } = this.view;
    if (!shown.delete(name)) shown.add(name);
    this.settings.layers = layers.map((layer) => layer.name).filter((layer) => shown.has(layer));
    this.view.applyLayers();
    this.want();
    this.onSettings();
  }

  /** The user has turned, moved or zoomed the picture. */
  looked(): void {
    this.settings.look = this.view.stage.look;
    this.onSettings();
  }

  look(id?: string): void {
    this.view.frameAll(id);
    this.looked();
  }

  toggleTrail(id: string): void {
    const { trailed } = this.settings;
    this.settings.trailed = trailed.includes(id) ? trailed.filter((other) => other !== id) : [...trailed, id];
    this.view.trailed = this.settings.trailed;
    this.onSettings();
  }

  togglePlot(name: SeriesName): void {
    const text = nameOf(name);
    const without = this.series.filter((series) => nameOf(series.name) !== text);
    if (without.length < this.series.length) {
      this.series = without;
    } else {
      this.series = [...this.series, this.makeSeries(name)];
    }
    this.settings.plots = this.series.map((series) => series.name);
    this.want();
    this.onSettings();
  }

  applySettings(): void {
    const { settings, view } = this;
    view.shown = new Set(settings.layers);
    view.followed = settings.followed;
    view.trailed = settings.trailed;
    view.motion.isOn = settings.isSmooth;
    view.setColoring(settings.coloring);
    if (settings.look) view.stage.set(settings.look);
    view.applyLayers();
  }

  /** Asks the server; what it refuses is shown. */
  async call(service: string, request: Value = {}): Promise<boolean> {
    try {
      await this.source.call(service, request);
      return true;
    } catch (error) {
      this.onNotice({ level: "error", text: `${service.slice(1)}: ${(error as Error).message}` });
      return false;
    }
  }

  playOrPause(): void {
    if (this.isLive) return void this.call(this.isPaused ? "/resume" : "/pause");
    if (this.playback.isPlaying) {
      this.playback.isPlaying = false;
    } else {
      if (this.recorded && this.pinned === this.recorded.last) this.pin(0); // once more
      this.playback.start();
    }
    this.onSettings();
  }

  /** Takes numbers that are new into series of a running world; those of a recording come by themselves. @param most  frames back */
  updateSeries(list = this.series, most?: number): void {
    if (!this.recorded) for (const series of list) series.update(this.seen, most);
  }
}
