// SPDX-License-Identifier: MIT
// Overlay of the picture: names of what is selected or searched, the ruler's length, the place under the pointer, and
// a compass that shows how the world's axes lie.
import { axisColors } from "../drawing/ground";
import type { Vector } from "../model/pose";
import type { App } from "../page/app";
import { make, setText } from "./element";

const mostNames = 40;
const lookEvery = 60; // [ms], for what is under the pointer
const compassRadius = 24; // [px]

function svg(name: string, attributes: Record<string, string>): SVGElement {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
}

const colorText = (color: number): string => `#${color.toString(16).padStart(6, "0")}`;

/** The world's axes as the camera sees them. */
class Compass {
  readonly element = svg("svg", { class: "compass", viewBox: "-36 -36 72 72", role: "img", "aria-label": "The world's axes" });
  private readonly ground = svg("polygon", { class: "ground" });
  private readonly axes = axisColors.map((color, i) => ({
    line: svg("line", { stroke: colorText(color) }), text: svg("text", { fill: colorText(color) }), name: "xyz"[i] }));
  private drawn = "";

  constructor() {
    this.element.append(this.ground);
    for (const { line, text, name } of this.axes) {
      text.textContent = name;
      this.element.append(line, text);
    }
  }

  /** @param view  matrix of the camera, from the world to its frame, column by column */
  update(view: ArrayLike<number>): void {
    const key = Array.from({ length: 11 }, (_, i) => view[i].toFixed(3)).join();
    if (key === this.drawn) return;
    this.drawn = key;
    const at = (x: number, y: number): string => [0, 1].map((k) =>
      (k ? -1 : 1) * compassRadius * (view[k] * x + view[4 + k] * y)).map((value) => value.toFixed(1)).join();
    this.ground.setAttribute("points", Array.from({ length: 24 }, (_, i) => at(Math.cos(i * Math.PI / 12), Math.sin(i * Math.PI / 12))).join(" "));
    this.axes.forEach(({ line, text }, i) => {
      const [x, y] = [compassRadius * view[4 * i], -compassRadius * view[4 * i + 1]];
      const far = view[4 * i + 2] < -0.3 ? "0.55" : "1"; // it points away from the camera
      for (const [name, value] of [["x2", x], ["y2", y]] as const) line.setAttribute(name, value.toFixed(1));
      text.setAttribute("x", (1.32 * x).toFixed(1));
      text.setAttribute("y", (1.32 * y + 3.5).toFixed(1));
      for (const element of [line, text]) element.setAttribute("opacity", far);
    });
  }
}

export class SceneOverlay {
  readonly element = make("div.scene-overlay");
  private readonly names: HTMLElement[] = [];
  private readonly places = new WeakMap<HTMLElement, [number, number]>(); // of texts [px]
  private readonly length = make("span.name.ruler");
  private readonly place = make("span.place.number", { title: "The place under the pointer [m]" });
  private readonly compass = new Compass();
  private pointer: { x: number; y: number } | null = null; // in the picture, -1 to 1 each, y up
  private seenPointer: unknown = null;
  private lookedAt = 0;
  private under: Vector | null = null;

  /** @param searched  ids of entities that are searched */
  constructor(private readonly app: App, canvas: HTMLCanvasElement, private readonly searched: () => string[]) {
    this.element.append(this.length, this.place, this.compass.element);
    canvas.addEventListener("pointermove", ({ clientX, clientY }) => {
      const box = canvas.getBoundingClientRect();
      this.pointer = { x: 2 * (clientX - box.left) / box.width - 1, y: 1 - 2 * (clientY - box.top) / box.height };
    });
    canvas.addEventListener("pointerleave", () => { this.pointer = null; });
  }

  /** At each frame of the screen. @param now  [ms] */
  update(now: number): void {
    const { view } = this.app;
    this.compass.element.toggleAttribute("hidden", !view.shown.has("marks"));
    this.compass.update(view.stage.camera.matrixWorldInverse.elements);
    if (this.pointer !== this.seenPointer && now - this.lookedAt > lookEvery) this.lookUnder(now);
    this.showNames();
    this.showRuler();
  }

  /** Draws the names and the ruler's length into a picture of the world. @param ratio  its pixels by those of the page */
  paint(draw: CanvasRenderingContext2D, ratio: number): void {
    draw.save();
    draw.scale(ratio, ratio);
    draw.font = "12px system-ui, sans-serif";
    draw.textBaseline = "middle";
    draw.textAlign = "center";
    for (const element of [...this.names, this.length]) {
      const at = element.hidden ? undefined : this.places.get(element);
      if (!at) continue;
      const text = element.textContent ?? "";
      const isRuler = element === this.length;
      const width = draw.measureText(text).width + 10, height = 17;
      draw.fillStyle = isRuler ? "#cc3311" : getComputedStyle(document.body).getPropertyValue("--panel");
      draw.fillRect(at[0] - width / 2, at[1] - height, width, height);
      draw.fillStyle = isRuler ? "#fff" : getComputedStyle(document.body).getPropertyValue("--text");
      draw.fillText(text, at[0], at[1] - height / 2);
    }
    draw.restore();
  }

  private lookUnder(now: number): void {
    const { view } = this.app;
    this.lookedAt = now;
    this.seenPointer = this.pointer;
    const { x, y } = this.pointer ?? { x: 0, y: 0 };
    const point = this.pointer && (view.pick(x, y)?.point ?? view.onPlane(x, y, 0));
    this.under = point ? point.toArray() : null;
    setText(this.place, this.under ? this.under.map((value, i) => `${"xyz"[i]} ${value.toFixed(3).replace("-", "\u2212")}`).join("  ") + " m" : "");
  }

  private showNames(): void {
    const { app } = this;
    const { selected } = app.settings;
    const ids = [...new Set([...(app.selected && selected !== null ? [selected] : []), ...this.searched()])].slice(0, mostNames);
    while (this.names.length < ids.length) {
      const name = make("span.name");
      this.names.push(name);
      this.element.prepend(name);
    }
    this.names.forEach((name, i) => {
      const point = i < ids.length ? app.view.above(ids[i]) : null;
      if (point) setText(name, ids[i]);
      this.move(name, point);
    });
  }

  private showRuler(): void {
    const { view } = this.app;
    const [a, b] = [view.ruler[0], view.ruler[1] ?? this.under];
    view.showRuler(a && b && this.app.tool === "ruler" ? [a, b] : []);
    if (!a || !b || this.app.tool !== "ruler") return this.move(this.length, null);
    const way = b.map((value, i) => value - a[i]);
    setText(this.length, `${Math.hypot(...way).toFixed(3)} m`);
    this.length.title = way.map((value, i) => `${"xyz"[i]} ${value.toFixed(3)} m`).join(", ");
    this.move(this.length, a.map((value, i) => (value + b[i]) / 2) as Vector);
  }

  /** Puts a text above a point of the world; null: nowhere. */
  private move(text: HTMLElement, point: Vector | null): void {
    const at = point && this.app.view.onScreen(point);
    text.hidden = !at;
    if (at) this.places.set(text, at);
    if (at) text.style.transform = `translate(${at[0].toFixed(1)}px, ${at[1].toFixed(1)}px) translate(-50%, -100%)`;
  }
}
