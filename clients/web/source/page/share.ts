// SPDX-License-Identifier: MIT
// Sharing of what one sees: a picture, a film, a link to the moment.
import { toAddress } from "../model/settings";
import type { App } from "./app";
import { titleOf } from "./plotted";
import { save } from "./save";

const filmRate = 30; // frames per second of wall time, at most
const filmBits = 8_000_000; // per second
const filmTypes = ["video/webm;codecs=vp8", "video/webm;codecs=vp9", "video/webm"]; // the first is the cheapest

/** The frame that is shown, as text. */
function moment(app: App): string {
  const { frame, recorded } = app;
  return frame ? `${(recorded ? recorded.secondsOf(frame) : Number(frame.timeNs) * 1e-9).toFixed(2)} s · tick ${frame.tick}` : "";
}

/** Draws what lies over the world. @param ratio  pixels of the picture by those of the page */
export type Paint = (draw: CanvasRenderingContext2D, ratio: number) => void;

/** Saves what is seen of the world as PNG, drawn as well as the page can. */
export function savePicture(app: App, paint: Paint): void {
  const { stage } = app.view;
  stage.aim(true);
  stage.render();
  const picture = document.createElement("canvas");
  [picture.width, picture.height] = [stage.canvas.width, stage.canvas.height];
  const draw = picture.getContext("2d")!;
  draw.drawImage(stage.canvas, 0, 0);
  paint(draw, picture.width / stage.canvas.clientWidth);
  picture.toBlob((blob) => {
    if (blob) save(blob, `${titleOf(app)} tick ${app.frame?.tick ?? 0}.png`);
    else app.notice("error", "The browser made no picture.");
  });
}

/** Copies a link to what is seen, and says so. It has no token: who opens it may look. */
export async function copyLink(app: App): Promise<void> {
  const url = new URL(location.href);
  const hadToken = url.searchParams.has("token");
  url.searchParams.delete("token");
  const goesOn = app.isLive && !app.isPaused; // nobody can come to that moment
  const tick = app.frame && !goesOn ? app.timeline.tickOf(app.frame.sequence) : null;
  url.hash = toAddress({ ...app.settings, look: app.view.stage.look, tick });
  const note = hadToken ? " It has no token: who opens it may look, not control." : "";
  try {
    await navigator.clipboard.writeText(url.href);
    app.notice("info", `The link to this moment is in the clipboard.${note}`);
  } catch {
    app.notice("info", `The browser gives no clipboard; the link to this moment is ${url.href}${note}`);
  }
}

/** A film of what is seen, by the browser's own recorder. It is saved when it ends. */
export class Film {
  private recorder: MediaRecorder | null = null;
  private readonly canvas = document.createElement("canvas");
  private parts: Blob[] = [];
  private began = 0; // [ms]
  private drawn = 0;
  private firstTick = 0;

  constructor(private readonly app: App, private readonly paint: Paint) {
    window.addEventListener("beforeunload", (event) => { if (this.isRunning) event.preventDefault(); });
  }

  get isRunning(): boolean { return this.recorder !== null; }
  /** Since its begin [s]. */
  get seconds(): number { return this.isRunning ? (performance.now() - this.began) / 1000 : 0; }

  /** Begins, or ends and saves it. */
  toggle(): void {
    if (this.recorder) this.recorder.stop();
    else this.start();
  }

  private start(): void {
    const type = filmTypes.find((name) => typeof MediaRecorder !== "undefined" && MediaRecorder.isTypeSupported(name));
    if (type === undefined) return this.app.notice("error", "This browser records no films (MediaRecorder with WebM). Use `ziggurat render --video`.");
    const { clientWidth, clientHeight } = this.app.view.stage.canvas;
    this.canvas.width = 2 * Math.ceil(clientWidth / 2); // encoders take even sizes
    this.canvas.height = 2 * Math.ceil(clientHeight / 2);
    this.parts = [];
    this.began = performance.now();
    this.firstTick = this.app.frame?.tick ?? 0;
    this.app.view.stage.isDirty = true;
    const recorder = new MediaRecorder(this.canvas.captureStream(filmRate), { mimeType: type, videoBitsPerSecond: filmBits });
    recorder.addEventListener("dataavailable", ({ data }) => this.parts.push(data));
    recorder.addEventListener("error", () => this.app.notice("error", "The browser's recorder failed; what it has is saved."));
    recorder.addEventListener("stop", () => this.end());
    recorder.start(1000);
    this.recorder = recorder;
  }

  private end(): void {
    this.recorder = null;
    save(new Blob(this.parts, { type: "video/webm" }), `${titleOf(this.app)} tick ${this.firstTick} to ${this.app.frame?.tick ?? 0}.webm`);
    this.parts = [];
  }

  /** Takes the picture; called at each frame of the screen. @param hasDrawn  the world was drawn just now */
  frame(hasDrawn: boolean): void {
    if (!this.recorder) return;
    const now = performance.now();
    const draw = this.canvas.getContext("2d")!;
    const { width, height } = this.canvas;
    if (hasDrawn) {
      draw.drawImage(this.app.view.stage.canvas, 0, 0, width, height);
      this.paint(draw, width / this.app.view.stage.canvas.clientWidth);
    } else if (now - this.drawn < 1000 / filmRate) return;
    this.drawn = now;
    // The time is written anew also while nothing moves: the recorder takes pictures that change only.
    draw.font = "14px system-ui, sans-serif";
    draw.fillStyle = "#16181c";
    draw.fillRect(8, height - 30, 190, 22);
    draw.fillStyle = "#e4e7eb";
    draw.fillText(moment(this.app), 16, height - 14);
  }
}
