// SPDX-License-Identifier: MIT
// A chart of one or several series over simulated time, with their values at the mouse.
import uPlot from "uplot";
import type { App } from "../page/app";
import type { Label } from "../model/labels";
import { nameOf, type Series } from "../model/series";
import { upperBound } from "../model/chunks";
import { make, setText } from "./element";

export interface Curve { series: Series; label: Label; stroke: string }

const height = 150; // [px], of axes and curves
const line = 17; // [px], of the legend in a picture
const font = "10px system-ui";
const letter = 6; // [px], of the axes' font, about

/** Beginning of the newest run: after a reset time begins again, and only what follows is drawn. */
function begin({ times }: Series): number {
  let at = Math.max(times.length - 1, 0);
  while (at > 0 && times[at - 1] < times[at]) --at;
  return at;
}

/** Marks of an axis, with the digits that tell them apart. @param step  between them */
function marks(values: number[], step: number): string[] {
  const most = Math.max(...values.map(Math.abs));
  if (most >= 1e6 || (most > 0 && most < 1e-4)) {
    const digits = Math.min(Math.max(Math.ceil(Math.log10(most / step)), 0), 6);
    return values.map((value) => (value === 0 ? "0" : value.toExponential(digits)));
  }
  let digits = 0; // as many as the step has: 2.5 has one
  while (digits < 9 && Math.abs(step - Number(step.toFixed(digits))) > 1e-6 * step) ++digits;
  return values.map((value) => value.toFixed(digits).replace(/^-(0\.?0*)$/, "$1"));
}

export class Chart {
  readonly element: HTMLElement;
  private readonly plot: uPlot;
  private readonly values: HTMLElement[];
  private readonly time = make("span.muted.number");
  private key = ""; // of its numbers
  private look = ""; // of what else is drawn
  private isZoomed = false;

  constructor(private readonly app: App, private readonly curves: Curve[], private readonly widthNow: () => number) {
    this.values = curves.map(() => make("span.number"));
    this.element = make("div.plot-box", {}, make("div.title.muted", {}, this.time),
      ...curves.map((curve, i) => this.legend(curve, this.values[i])));
    this.plot = new uPlot(this.options(), [[], ...curves.map(() => [])], this.element);
    this.plot.over.addEventListener("dblclick", () => { this.isZoomed = false; });
    this.plot.over.addEventListener("click", () => this.jump());
  }

  private legend({ series: { name }, label, stroke }: Curve, value: HTMLElement): HTMLElement {
    return make("div.title", { "data-plot": nameOf(name) }, make("span.swatch", { style: `background:${stroke}` }),
      make("span.label", { title: nameOf(name) }, make("span.muted", {}, `${label.of} `), `${label.text}${label.unit ? ` [${label.unit}]` : ""}`),
      value, make("button", { title: "Remove the series", click: () => this.app.togglePlot(name) }, "×"));
  }

  private options(): uPlot.Options {
    const color = (name: string) => () => getComputedStyle(document.body).getPropertyValue(name);
    const axis = { stroke: color("--muted"), grid: { stroke: color("--line"), width: 1 }, ticks: { show: false }, font };
    return {
      width: this.width, height, legend: { show: false }, padding: [8, 26, 0, 4],
      cursor: { y: false, sync: { key: "time" }, drag: { x: true, y: false } }, scales: { x: { time: false } },
      series: [{}, ...this.curves.map(({ stroke }) => ({ stroke, width: 1.5,
        points: { show: (plot: uPlot, series: number) => Array.from(plot.data[series]).filter((value) => value != null).length === 1 } }))],
      axes: [
        { ...axis, size: 24, values: (_, at, _axis, _space, step) => marks(at, step).map((text) => `${text} s`) },
        { ...axis, values: (_, at, _axis, _space, step) => marks(at, step),
          size: (_, texts) => 14 + letter * Math.max(3, ...(texts ?? []).map(({ length }) => length)) },
      ],
      hooks: { draw: [() => this.drawMoment()], setCursor: [() => this.showValues()],
               setSelect: [({ select }) => { this.isZoomed ||= select.width > 0; }] },
    };
  }

  get width(): number { return Math.max(200, this.widthNow()); }
  get pictureHeight(): number { return height + line * (this.curves.length + 1); }

  shows(curves: Curve[]): boolean {
    return curves.length === this.curves.length && curves.every(({ series, label, stroke }, i) => {
      const own = this.curves[i];
      return series === own.series && stroke === own.stroke && label.text === own.label.text && label.unit === own.label.unit;
    });
  }

  remove(): void {
    this.plot.destroy();
    this.element.remove();
  }

  update(): void {
    if (this.plot.width !== this.width) this.plot.setSize({ width: this.width, height });
    const key = this.curves.map(({ series: { sequences } }) => `${sequences.length} ${sequences.at(-1)}`).join();
    const { pinned } = this.app;
    const look = `${pinned === null ? "" : this.app.frame?.sequence} ${document.documentElement.dataset.theme}`;
    if (key !== this.key) {
      this.key = key;
      const tables = this.curves.map(({ series }) => {
        const from = begin(series);
        return [series.times.slice(from), series.values.slice(from)] as uPlot.AlignedData;
      });
      this.plot.setData(uPlot.join(tables), !this.isZoomed);
    } else if (look !== this.look) {
      this.plot.redraw(false, false); // the line at the moment that is shown
    }
    this.look = look;
    this.showValues();
  }

  /** At the mouse; otherwise at the frame that is shown. */
  private showValues(): void {
    const { cursor, data } = this.plot;
    const times = data[0] as number[];
    const frame = this.app.pinned === null ? null : this.app.frame;
    const shown = frame ? Number(frame.timeNs) * 1e-9 : times.at(-1) ?? 0;
    const at = cursor.idx ?? upperBound(times, shown + 1e-9, (time) => time) - 1;
    setText(this.time, times.length > 0 && at >= 0 ? `${times[at].toFixed(3)} s` : "");
    this.values.forEach((element, i) => {
      const list = data[i + 1] as (number | null | undefined)[];
      let place = at;
      while (place > 0 && list[place] === undefined) --place;
      setText(element, list[place]?.toPrecision(5) ?? "–");
    });
  }

  /** A click shows that moment. */
  private jump(): void {
    const { cursor, data } = this.plot;
    if (cursor.idx === null || cursor.idx === undefined || this.plot.select.width > 0) return;
    const { series } = this.curves[0];
    const from = begin(series);
    const at = from + upperBound(series.times.slice(from), data[0][cursor.idx] + 1e-9, (time) => time) - 1;
    this.app.playback.isPlaying = false;
    if (at >= from) this.app.pin(series.sequences[at]);
  }

  /** A line at the frame that is shown, while the page looks back. */
  private drawMoment(): void {
    const frame = this.app.pinned === null ? null : this.app.frame;
    if (!frame) return;
    const { ctx, bbox } = this.plot;
    const x = this.plot.valToPos(Number(frame.timeNs) * 1e-9, "x", true);
    if (x < bbox.left || x > bbox.left + bbox.width) return;
    ctx.fillStyle = "#e6a417";
    ctx.fillRect(x - 1, bbox.top, 2, bbox.height);
  }

  /** Draws it with its legend. @param top  [px], @return how high it is [px] */
  paint(draw: CanvasRenderingContext2D, top: number, ratio: number): number {
    const style = getComputedStyle(document.body);
    draw.setTransform(ratio, 0, 0, ratio, 0, 0);
    draw.font = "12px system-ui, sans-serif";
    this.curves.forEach(({ label, stroke }, i) => {
      const y = top + line * (i + 1);
      draw.fillStyle = stroke;
      draw.fillRect(10, y - 5, 12, 3);
      draw.fillStyle = style.getPropertyValue("--text");
      draw.fillText(`${label.of} ${label.text}${label.unit ? ` [${label.unit}]` : ""}`, 28, y);
    });
    draw.resetTransform();
    draw.drawImage(this.plot.ctx.canvas, 0, (top + line * (this.curves.length + 0.5)) * ratio);
    return this.pictureHeight;
  }
}
