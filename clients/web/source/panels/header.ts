// SPDX-License-Identifier: MIT
// The top line: what runs, how it goes, connection, theme and help.
import type { App } from "../page/app";
import { beginning } from "../model/texts";
import { make, setText } from "./element";
import type { Panel } from "./panel";

export class Header implements Panel {
  readonly element = make("div.header");
  private readonly scene = make("span.scene");
  private readonly state = make("span.badge");
  private readonly control = make("span.badge.quiet");
  private readonly rate = make("span.rate.number");
  private readonly connection = make("span.connection", { title: "connection" });
  private rates: { wall: number; seconds: number; tick: number }[] = [];

  constructor(private readonly app: App, openFile: () => void, toggleTheme: () => void, openHelp: () => void) {
    this.element.append(make("strong.name", {}, "Ziggurat"), this.scene, this.state, this.rate, make("span.space"),
      this.control, this.connection,
      make("button.wide", { id: "open", title: "Open a recording, a file .mcap (e), or drop it on the page", click: openFile }, "Open"),
      make("button", { title: "Light or dark (L)", click: toggleTheme }, "◐"),
      make("button", { title: "Keys and help (?)", click: openHelp }, "?"));
  }

  update(): void {
    const { app } = this;
    const world = app.world;
    setText(this.scene, world ? world.scene.split("/").pop() ?? "" : "");
    if (world) {
      this.scene.title = `${beginning(world.scene)}\nhash ${beginning(world.sceneHash)}\nseed ${world.seed}\n`
          + `${world.entities.filter(({ removed }) => !removed).length} entities, ${world.links.length} links`;
    }
    const phase = app.recorded ? "recording" : String(app.parameters.get("phase") ?? "");
    setText(this.state, phase);
    this.state.dataset.phase = phase;
    const { phase: connected, mayControl } = app.connection;
    setText(this.connection, connected === "open" ? app.source.name : connected);
    this.connection.dataset.phase = connected;
    setText(this.control, connected !== "open" || !app.source.isLive ? "" : mayControl ? "may control" : "may look");
    this.control.title = mayControl ? `The address has the token: pause, step and speed work${app.mayChange ? ", and move, spawn and remove" : ""}.`
                                     : "Open the address with the token, as the server printed it, to change the world.";
    setText(this.rate, this.rateText());
  }

  /** Speed of the world over the last two seconds of wall time. */
  private rateText(): string {
    const newest = this.app.timeline.newest;
    if (!newest || this.app.recorded || this.app.parameters.get("phase") !== "running") {
      this.rates = [];
      return "";
    }
    const now = performance.now() * 1e-3;
    this.rates.push({ wall: now, seconds: Number(newest.timeNs) * 1e-9, tick: newest.tick });
    while (this.rates.length > 2 && this.rates[0].wall < now - 2) this.rates.shift();
    const first = this.rates[0];
    const wall = now - first.wall, seconds = Number(newest.timeNs) * 1e-9 - first.seconds;
    if (wall < 0.3 || seconds < 0) return "";
    return `×${(seconds / wall).toFixed(2)} · ${((newest.tick - first.tick) / wall).toFixed(0)} ticks/s`;
  }
}
