// What the page knows and does; panels show it and call it. Nothing here touches the document.
import type { Listener, Message, Source, Status, Value } from "../data/source";
import type { View, Layer } from "../drawing/view";
import { layers } from "../drawing/view";
import type { Barrier, Entity, Log, Robot, World } from "../model/messages";
import { nameOf, Series, type SeriesName } from "../model/series";
import type { Settings, Tab } from "../model/settings";
import { Timeline, type Frame } from "../model/timeline";

export interface LogEntry { sequence: number; seconds: number; name: string; level: number; text: string }
export interface Notice { level: "info" | "warning" | "error"; text: string }

/** With more robots than this, only what is selected or plotted is subscribed. */
const mostRobotsAtOnce = 12;

export class App implements Listener {
  readonly timeline = new Timeline();
  connection: Status = { phase: "connecting", text: "", mayControl: false, session: "" };
  topicNames: string[] = [];
  parameters = new Map<string, unknown>();
  log: LogEntry[] = [];
  barrier: Barrier | null = null;
  series: Series[] = [];
  pauseOnText = "";
  /** The frame that is shown; null: the newest. */
  pinned: number | null = null;
  tool: "select" | "move" = "select";
  onNotice: (notice: Notice) => void = () => undefined;
  onStatus: () => void = () => undefined;
  onSettings: () => void = () => undefined;
  private session = "";

  constructor(readonly source: Source, readonly settings: Settings, readonly view: View) {
    this.series = settings.plots.map((name) => new Series(name));
    this.applySettings();
  }

  // --- what arrives ---------------------------------------------------------------------------------

  status(status: Status): void {
    if (status.phase === "open" && this.session !== "" && status.session !== this.session) {
      this.timeline.clear();
      this.log = [];
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
    this.timeline.take(message);
    if (message.topic === "/log") this.takeLog(message);
    if (message.topic === "/world") this.want();
    if (message.topic === "/barrier") {
      this.barrier = message.read<Barrier>();
      this.timeline.noteMissed(this.barrier.histograms.reduce((sum, { missedTicks }) => sum + missedTicks, 0));
    }
  }

  parameter(name: string, value: unknown): void {
    this.parameters.set(name, value);
    this.onStatus();
  }

  notice(level: Notice["level"], text: string): void { this.onNotice({ level, text }); }

  private takeLog(message: Message): void {
    const { level, message: text, name } = message.read<Log>();
    this.log.push({ sequence: this.timeline.last, seconds: Number(message.timeNs) * 1e-9, name, level, text });
    if (this.log.length > 5000) this.log.splice(0, 1000);
    this.timeline.mark(level >= 4 ? "error" : level === 3 ? "warning" : "log", `${name}: ${text}`);
    if (this.pauseOnText !== "" && text.includes(this.pauseOnText)) {
      this.onNotice({ level: "info", text: `Paused: ${name} logged “${text}”` });
      this.pauseOnText = "";
      void this.call("/pause");
    }
  }

  /** Subscribes what the page shows now. */
  want(): void {
    const wanted = new Set(["/world", "/poses", "/log", "/barrier", "/phases"]);
    for (const layer of layers) {
      if ("topic" in layer && this.view.shown.has(layer.name)) wanted.add(layer.topic);
    }
    for (const { name } of this.series) wanted.add(name.topic);
    const robots = this.world?.robots ?? [];
    const selected = this.selectedRobot;
    for (const robot of robots.length <= mostRobotsAtOnce ? robots : selected ? [selected] : []) {
      wanted.add(`/robots/${robot.description.id}/observation`);
      wanted.add(`/robots/${robot.description.id}/command`);
    }
    if (selected && this.settings.tab === "camera") {
      wanted.add("/detections");
      for (const { id } of selected.description.cameras) wanted.add(`/robots/${selected.description.id}/cameras/${id}/image`);
    }
    this.source.want(wanted);
  }

  // --- what is shown --------------------------------------------------------------------------------

  get world(): World | null { return this.frame?.world ?? null; }

  /** The frame at which the page looks: never one of which the poses have not arrived. */
  get frame(): Frame | null {
    if (this.pinned !== null) return this.timeline.at(this.pinned);
    for (let s = this.timeline.last; s >= this.timeline.first && s > this.timeline.last - 3; --s) {
      const frame = this.timeline.at(s);
      if (frame?.messages.has("/poses")) return frame;
    }
    return this.timeline.newest;
  }

  get selected(): { entity: Entity; index: number } | null {
    const entities = this.world?.entities ?? [];
    const index = entities.findIndex(({ id, removed }) => id === this.settings.selected && !removed);
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

  get isPaused(): boolean { return this.parameters.get("phase") === "paused"; }

  // --- what the user does ---------------------------------------------------------------------------

  pin(sequence: number | null): void {
    this.pinned = sequence === null || sequence >= this.timeline.last ? null : Math.max(sequence, this.timeline.first);
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

  follow(id: string | null): void {
    this.settings.followed = this.view.followed = id;
    this.onSettings();
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
    this.series = without.length < this.series.length ? without : [...this.series, new Series(name)];
    this.settings.plots = this.series.map((series) => series.name);
    this.want();
    this.onSettings();
  }

  applySettings(): void {
    const { settings, view } = this;
    view.shown = new Set(settings.layers);
    view.followed = settings.followed;
    view.trailed = settings.trailed;
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

  playOrPause(): void { void this.call(this.isPaused ? "/resume" : "/pause"); }
}
