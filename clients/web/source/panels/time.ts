// SPDX-License-Identifier: MIT
// Time: play, pause, step, speed, reset, and the line of all frames that the page has seen.
import type { App } from "../page/app";
import { lanes } from "../model/marks";
import { icon, make, setText } from "./element";
import { Lanes } from "./lanes";
import type { Panel } from "./panel";

const speeds = [0.1, 0.25, 0.5, 1, 2, 4, 10, 0];

export class TimeBar implements Panel {
  readonly element = make("div.time");
  private readonly play = make("button.play", { id: "play", title: "Play or pause (space)", click: () => this.app.playOrPause() });
  private readonly step = make("button", { id: "step", title: "One tick (n)", click: () => this.app.step() }, icon("step"));
  private readonly reset = make("button", { id: "reset", title: "Back to the start (r)", click: () => this.app.restart() }, icon("reset")) as HTMLButtonElement;
  private readonly speed = make("select", { id: "speed", title: "Simulated seconds per second ([ and ])" }) as HTMLSelectElement;
  private readonly line: Lanes;
  private readonly clock = make("span.clock.number", { id: "clock" });
  private readonly live = make("button.live", { id: "live", title: "Jump to the newest (End)", click: () => this.app.pin(null) }, "LIVE");
  private readonly bookmark = make("button", { id: "bookmark", title: "Bookmark this moment, or remove its bookmark (s)", click: () => this.app.toggleBookmark() }, icon("bookmark"));
  private readonly choices = make("div.choices");
  private readonly lanes = make("details.lanes", {}, make("summary", { title: "Which marks are shown" }, icon("lanes")), this.choices);
  private wasPaused: boolean | null = null;

  constructor(private readonly app: App) {
    this.speed.append(...speeds.map((speed) => make("option", { value: speed }, speed === 0 ? "max" : `×${speed}`)));
    this.speed.addEventListener("change", () => app.setSpeed(Number(this.speed.value)));
    this.line = new Lanes(app);
    for (const { name, label, color } of lanes) {
      const box = make("input", { type: "checkbox", "data-lane": name }) as HTMLInputElement;
      box.addEventListener("change", () => app.toggleLane(name));
      this.choices.append(make("label", {}, box, make("i", { style: `background:${color}` }), label, make("span.muted.number", { "data-count": name })));
    }
    document.addEventListener("pointerdown", (event) => {
      if (!this.lanes.contains(event.target as Node)) (this.lanes as HTMLDetailsElement).open = false;
    });
    this.element.append(make("div.buttons", {}, this.play, this.step, this.reset, this.speed, this.bookmark, this.lanes), this.line.element, this.clock, this.live);
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
    this.reset.disabled ||= app.isLive && !app.mayChange;
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
    this.line.update();
    if ((this.lanes as HTMLDetailsElement).open) this.countMarks();
    this.bookmark.classList.toggle("on", app.bookmarks.some(({ sequence }) => sequence === frame?.sequence));
  }

  private countMarks(): void {
    const marks = [...this.app.timeline.marks, ...this.app.bookmarks];
    for (const { name, kinds } of lanes) {
      const of = kinds as readonly string[];
      setText(this.choices.querySelector(`[data-count="${name}"]`)!, String(marks.filter(({ kind }) => of.includes(kind)).length));
      this.choices.querySelector<HTMLInputElement>(`[data-lane="${name}"]`)!.checked = !this.app.settings.hiddenLanes.includes(name);
    }
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
}
