// SPDX-License-Identifier: MIT
// The keyboard.
import * as three from "three";
import { colorings } from "../drawing/colors";
import { layers } from "../drawing/view";
import type { Tab } from "../model/settings";
import type { App } from "./app";
import { follow, setColoring, toggleMotion } from "./looks";

export interface Actions { open(): void; help(): void; theme(): void; search(): void; speed(by: 1 | -1): void;
                          picture(): void; film(): void; link(): void }

const tabKeys: Record<string, Tab> = { d: "devices", p: "plots", c: "camera", b: "controllers", k: "log" };
const turns: Record<string, [number, number]> = {
  ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1],
};

export function listenToKeys(app: App, actions: Actions): void {
  window.addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (document.querySelector("dialog[open]") && !"?h".includes(event.key)) return; // escape closes it
    if (/^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName)
        && (target as HTMLInputElement).type !== "checkbox") {
      if (event.key === "Escape") target.blur();
      return;
    }
    if (target.tagName === "BUTTON" && (event.key === " " || event.key === "Enter")) return;
    if (act(app, actions, event)) event.preventDefault();
  });
}

function act(app: App, actions: Actions, event: KeyboardEvent): boolean {
  const { key } = event;
  const layer = layers.find((one) => one.key === key);
  if (layer) return done(app.toggleLayer(layer.name));
  if (key in tabKeys) return done(app.openTab(tabKeys[key]));
  if (key in turns) return done(turn(app, turns[key], event.shiftKey));
  const selected = app.settings.selected;
  switch (key) {
    case " ": return done(app.playOrPause());
    case "n": return done(app.step());
    case "r": return done(app.restart());
    case "[": return done(actions.speed(-1));
    case "]": return done(actions.speed(1));
    case ",": return done(move(app, -1));
    case ".": return done(move(app, 1));
    case "<": return done(move(app, -50));
    case ">": return done(move(app, 50));
    case "End": return done(app.pin(null));
    case "Home": return done(app.pin(app.timeline.first));
    case "+": case "=": return done(zoom(app, 0.85));
    case "-": return done(zoom(app, 1 / 0.85));
    case "a": return done(app.look());
    case "o": return done(top(app));
    case "e": return done(actions.open());
    case "v": return done(app.tool = "select");
    case "m": return app.mayChange && done(app.tool = "move");
    case "u": return done(app.tool = app.tool === "ruler" ? "select" : "ruler");
    case "i": return done(toggleMotion(app));
    case "y": return done(setColoring(app, colorings[(colorings.indexOf(app.settings.coloring) + 1) % colorings.length]));
    case "s": return done(app.toggleBookmark());
    case "j": return done(actions.picture());
    case "w": return done(actions.film());
    case "q": return done(actions.link());
    case "l": return done(actions.theme());
    case "?": case "h": return done(actions.help());
    case "/": return done(actions.search());
    case "Escape": return done(app.view.ruler = [], app.select(null));
  }
  if (selected === null) return false;
  switch (key) {
    case "f": return done(app.look(selected));
    case "g": return done(follow(app, app.settings.followed === selected ? null : selected));
    case "t": return done(app.toggleTrail(selected));
    case "Delete": case "Backspace": return app.mayChange && done(void app.call("/remove", { entity: selected }));
  }
  return false;
}

function done(..._: unknown[]): boolean { return true; }

function move(app: App, frames: number): void {
  app.playback.isPlaying = false;
  app.pin((app.pinned ?? app.timeline.last) + frames);
}

function top(app: App): void {
  app.view.stage.top();
  app.looked();
}

function zoom(app: App, factor: number): void {
  const { look } = app.view.stage;
  app.view.stage.set({ ...look, eye: look.eye.map((value, i) => look.at[i] + (value - look.at[i]) * factor) as typeof look.eye });
  app.looked();
}

function turn(app: App, [x, y]: [number, number], isPan: boolean): void {
  const { stage } = app.view;
  const away = new three.Vector3(...stage.look.eye).sub(new three.Vector3(...stage.look.at));
  if (isPan) {
    const ahead = new three.Vector3(-away.x, -away.y, 0).setLength(0.05 * away.length());
    const right = new three.Vector3(ahead.y, -ahead.x, 0);
    stage.shift(right.multiplyScalar(x).addScaledVector(ahead, -y).toArray());
    return app.looked();
  }
  const ball = new three.Spherical().setFromVector3(new three.Vector3(away.x, away.z, -away.y));
  ball.theta -= 0.08 * x;
  ball.phi = Math.min(Math.max(ball.phi + 0.08 * y, 0.02), 3.1);
  const turned = new three.Vector3().setFromSpherical(ball);
  const { at, fieldOfView } = stage.look;
  stage.set({ eye: [at[0] + turned.x, at[1] - turned.z, at[2] + turned.y], at, fieldOfView });
  app.looked();
}
