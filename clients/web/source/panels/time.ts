// Time: play, pause, step, speed, reset, and the line of all frames that the page has seen.
import type { App } from "../page/app";
import type { MarkKind } from "../model/timeline";
import { beginning } from "../model/texts";
import { icon, make, setText } from "./element";
import type { Panel } from "./panel";

const speeds = [0.1, 0.25, 0.5, 1, 2, 4, 10, 0];
const markColors: Record<MarkKind, string> = {
  log: "#8a919b", warning: "#e6a417", error: "#e0402c", missed: "#d6336c", collision: "#8e5bd0", reset: "#3d8bfd",
};

export class TimeBar implements Panel {
  readonly element = make("div.time");
  private readonly play = make("button.play", { id: "play", title: "Play or pause (space)", click: () => this.app.playOrPause() });
  private readonly step = make("button", { id: "step", title: "One tick (n)", click: () => this.app.step() }, icon("step"));
  private readonly reset = make("button", { id: "reset", title: "Back to the start (r)", click: () => this.app.restart() }, icon("reset"));
  private readonly speed = make("select", { id: "speed", title: "Simulated seconds per second ([ and ])" }) as HTMLSelectElement;
  private readonly line = make("canvas.line", { id: "timeline", title: "All that this page has seen: drag to look back" }) as HTMLCanvasElement;
  private readonly clock = make("span.clock.number", { id: "clock" });
  private readonly live = make("button.live", { id: "live", title: "Jump to the newest (End)", click: () => this.app.pin(null) }, "LIVE");
  private wasPaused: boolean | null = null;

  constructor(private readonly app: App) {
    this.speed.append(...speeds.map((speed) => make("option", { value: speed }, speed === 0 ? "max" : `×${speed}`)));
    this.speed.addEventListener("change", () => app.setSpeed(Number(this.speed.value)));
    this.line.addEventListener("pointerdown", (event) => {
      this.line.setPointerCapture(event.pointerId);
      this.scrub(event);
    });
    this.line.addEventListener("pointermove", (event) => {
      if (this.line.hasPointerCapture(event.pointerId)) this.scrub(event);
      else this.hint(event);
    });
    this.element.append(make("div.buttons", {}, this.play, this.step, this.reset, this.speed), this.line, this.clock, this.live);
  }

  /** Frames per pixel. */
  private get scale(): number { return Math.max(this.app.timeline.length - 1, 1) / Math.max(this.line.clientWidth, 1); }

  private sequenceAt(event: PointerEvent): number {
    return this.app.timeline.first + Math.round((event.clientX - this.line.getBoundingClientRect().left) * this.scale);
  }

  private scrub(event: PointerEvent): void {
    if (!this.app.recorded) this.app.playback.isPlaying = false;
    this.app.pin(this.sequenceAt(event));
  }

  private hint(event: PointerEvent): void {
    const { timeline } = this.app;
    const sequence = this.sequenceAt(event);
    const near = timeline.marks.filter((mark) => Math.abs(mark.sequence - sequence) <= 3 * this.scale).slice(-6);
    const tick = this.app.recorded ? "" : `tick ${timeline.at(sequence)?.tick ?? ""}`;
    this.line.title = [tick, ...near.map((mark) => beginning(mark.text))].join("\n");
  }

  changeSpeed(by: 1 | -1): void {
    const index = Math.min(Math.max(this.speed.selectedIndex + by, 0), speeds.length - 1);
    this.speed.selectedIndex = index;
    this.app.setSpeed(speeds[index]);
  }

  update(): void {
    const { app } = this;
    const mayPlay = !app.isLive || (app.connection.mayControl && !app.isOver);
    for (const control of [this.play, this.step, this.reset, this.speed]) (control as HTMLButtonElement).disabled = !mayPlay;
    if (app.isPaused !== this.wasPaused) {
      this.wasPaused = app.isPaused;
      this.play.replaceChildren(icon(app.isPaused ? "play" : "pause"));
    }
    const factor = app.isLive ? app.parameters.get("real_time_factor") : app.playback.speed;
    if (typeof factor === "number" && document.activeElement !== this.speed) this.showSpeed(factor);
    const { frame, recorded } = app;
    this.live.hidden = recorded !== null;
    this.live.classList.toggle("on", app.isLive);
    this.element.classList.toggle("past", !app.isLive && !recorded);
    this.play.title = app.isLive && app.isOver ? "The run is over: look back with the line at the right" : app.isLive ? "Play or pause the world (space)"
      : recorded ? "Play or pause (space)" : "Play the past from here (space); the world goes on by itself";
    if (frame) {
      const newest = app.timeline.newest;
      const behind = recorded ? ` / ${recorded.seconds.toFixed(2)} s`
        : app.isLive || !newest ? "" : `  (${(Number(frame.timeNs - newest.timeNs) * 1e-9).toFixed(2)} s)`;
      setText(this.clock, recorded ? `${recorded.secondsOf(frame).toFixed(3)}${behind} · tick ${frame.tick}`
        : `${(Number(frame.timeNs) * 1e-9).toFixed(3)} s · tick ${frame.tick}${behind}`);
      this.clock.dataset.tick = String(frame.tick);
      this.clock.dataset.live = String(newest?.tick ?? "");
    }
    this.draw();
  }

  private showSpeed(factor: number): void {
    const index = speeds.indexOf(factor);
    if (index >= 0) {
      this.speed.selectedIndex = index;
      return;
    }
    this.speed.querySelector("[data-other]")?.remove();
    this.speed.append(make("option", { value: factor, "data-other": "1", selected: true }, `×${factor}`));
  }

  private draw(): void {
    const { timeline } = this.app;
    const ratio = window.devicePixelRatio;
    const [width, height] = [Math.round(this.line.clientWidth * ratio), Math.round(this.line.clientHeight * ratio)];
    if (this.line.width !== width) this.line.width = width;
    if (this.line.height !== height) this.line.height = height;
    const draw = this.line.getContext("2d")!;
    const style = getComputedStyle(this.element);
    const middle = height / 2;
    draw.clearRect(0, 0, width, height);
    draw.fillStyle = style.getPropertyValue("--line");
    draw.fillRect(0, middle - 2 * ratio, width, 4 * ratio);
    const x = (sequence: number): number => (sequence - timeline.first) / Math.max(timeline.length - 1, 1) * (width - 2 * ratio);
    const shown = this.app.pinned ?? timeline.last;
    draw.fillStyle = style.getPropertyValue("--accent");
    draw.fillRect(0, middle - 2 * ratio, x(shown), 4 * ratio);
    for (const mark of timeline.marks) {
      if (mark.sequence < timeline.first) continue;
      const tall = mark.kind === "log" ? 0.22 : 0.42;
      draw.fillStyle = markColors[mark.kind];
      draw.fillRect(x(mark.sequence) - ratio, middle - tall * height, 2 * ratio, 2 * tall * height);
    }
    draw.fillStyle = style.getPropertyValue("--text");
    draw.fillRect(x(shown) - ratio, 0, 2 * ratio, height);
  }
}
