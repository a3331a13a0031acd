// SPDX-License-Identifier: MIT
// The line of all frames, with marks in lanes above it: drag to look back, click a mark to show its moment.
import type { App } from "../page/app";
import { colors, lanes, lanesOf, type LaneMarks } from "../model/marks";
import { beginning } from "../model/texts";
import type { Mark } from "../model/timeline";
import { make } from "./element";

const laneHeight = 7; // [px]
const trackHeight = 16;
const reach = 4; // of a mark around it [px]

export class Lanes {
  readonly element = make("canvas.line", { id: "timeline", title: "All that this page has seen: drag to look back" }) as HTMLCanvasElement;
  private shown: LaneMarks[] = [];
  private key = "";
  private drawn = "";
  /** On the processor: where that draws the world, too, hundreds of marks would keep the world's next frame waiting for seconds. */
  private readonly context = this.element.getContext("2d", { willReadFrequently: true })!;

  constructor(private readonly app: App) {
    const { element } = this;
    element.addEventListener("pointerdown", (event) => {
      element.setPointerCapture(event.pointerId);
      const mark = this.marksAt(event).at(-1);
      this.scrub(mark && this.laneAt(event) ? mark.sequence : this.sequenceAt(event));
    });
    element.addEventListener("pointermove", (event) => {
      if (element.hasPointerCapture(event.pointerId)) this.scrub(this.sequenceAt(event));
      else this.hint(event);
    });
  }

  /** Frames per pixel. */
  private get scale(): number { return Math.max(this.app.timeline.length - 1, 1) / Math.max(this.element.clientWidth, 1); }

  private sequenceAt(event: PointerEvent): number {
    return this.app.timeline.first + Math.round((event.clientX - this.element.getBoundingClientRect().left) * this.scale);
  }

  private laneAt(event: PointerEvent): LaneMarks | undefined {
    return this.shown[Math.floor((event.clientY - this.element.getBoundingClientRect().top) / laneHeight)];
  }

  /** Marks near the mouse: of its lane, or of all. The nearest is the last. */
  private marksAt(event: PointerEvent): Mark[] {
    const sequence = this.sequenceAt(event);
    const far = ({ sequence: at }: Mark): number => Math.abs(at - sequence);
    const lane = this.laneAt(event);
    return (lane ? [lane] : this.shown).flatMap(({ marks }) => marks.filter((mark) => far(mark) <= reach * this.scale))
      .sort((a, b) => far(b) - far(a));
  }

  private scrub(sequence: number): void {
    if (!this.app.recorded) this.app.playback.isPlaying = false;
    this.app.pin(sequence);
  }

  private hint(event: PointerEvent): void {
    const { timeline, recorded } = this.app;
    const tick = recorded ? "" : `tick ${timeline.at(this.sequenceAt(event))?.tick ?? ""}`;
    const lane = lanes.find(({ name }) => name === this.laneAt(event)?.name);
    this.element.title = [lane?.label ?? "", tick, ...this.marksAt(event).slice(-6).map(({ text }) => beginning(text))].filter((text) => text !== "").join("\n");
  }

  update(): void {
    const { timeline, settings } = this.app;
    const marks = [...timeline.marks, ...this.app.bookmarks];
    const key = `${marks.length} ${timeline.first} ${settings.hiddenLanes.join()} ${marks.at(-1)?.sequence} ${this.app.bookmarks.length}`;
    if (key !== this.key) {
      this.key = key;
      this.shown = lanesOf(marks.filter(({ sequence }) => sequence >= timeline.first), settings.hiddenLanes);
      this.element.style.height = `${Math.max(30, trackHeight + laneHeight * this.shown.length)}px`;
    }
    this.draw();
  }

  private draw(): void {
    const { timeline, pinned } = this.app;
    const ratio = window.devicePixelRatio;
    const [width, height] = [Math.round(this.element.clientWidth * ratio), Math.round(this.element.clientHeight * ratio)];
    if (this.element.width !== width) this.element.width = width;
    if (this.element.height !== height) this.element.height = height;
    const draw = this.context;
    const x = (sequence: number): number =>
      Math.round((sequence - timeline.first) / Math.max(timeline.length - 1, 1) * (width - 2 * ratio));
    const shown = x(pinned ?? timeline.last);
    const drawn = [width, height, shown, timeline.first, timeline.length, this.key, document.documentElement.dataset.theme].join();
    if (drawn === this.drawn) return;
    this.drawn = drawn;
    const style = getComputedStyle(this.element);
    const lanesEnd = laneHeight * this.shown.length * ratio;
    const middle = (lanesEnd + height) / 2;
    draw.clearRect(0, 0, width, height);
    draw.fillStyle = style.getPropertyValue("--line");
    draw.fillRect(0, middle - 2 * ratio, width, 4 * ratio);
    draw.fillStyle = style.getPropertyValue("--accent");
    draw.fillRect(0, middle - 2 * ratio, shown, 4 * ratio);
    this.shown.forEach(({ color, marks }, i) => {
      const top = laneHeight * i * ratio;
      draw.globalAlpha = 0.14;
      draw.fillStyle = color;
      draw.fillRect(0, top, width, (laneHeight - 1) * ratio);
      draw.globalAlpha = 1;
      let before = -1;
      for (const { sequence, kind } of marks) {
        const at = x(sequence);
        if (at === before && !(kind in colors)) continue; // a busy lane has thousands of marks
        before = at;
        draw.fillStyle = colors[kind] ?? color;
        draw.fillRect(at, top, 2 * ratio, (laneHeight - 1) * ratio);
      }
    });
    draw.fillStyle = style.getPropertyValue("--text");
    draw.fillRect(shown, 0, 2 * ratio, height);
    draw.beginPath();
    draw.arc(shown + ratio, middle, 5 * ratio, 0, 7);
    draw.fill();
  }
}
