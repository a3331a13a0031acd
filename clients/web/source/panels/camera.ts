// SPDX-License-Identifier: MIT
// The view of the selected robot's cameras, with what they detect drawn over: over the picture that
// the camera took, or over one that the page draws from the camera's place.
import * as three from "three";
import type { App } from "../page/app";
import type { Camera, Detections, SeenByCamera } from "../model/messages";
import { compose, poseAt } from "../model/pose";
import { isPictureOf } from "../model/pictures";
import { bytesText } from "../model/readings";
import { visible } from "../model/texts";
import { make, restOf, setLines, setText } from "./element";
import type { Panel } from "./panel";

const toScreen = Uint8ClampedArray.from({ length: 256 }, (_, i) => {
  const light = i / 255; // linear light to sRGB
  return 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055);
});
const mostCameras = 12; // of a robot
const mostPixels = 2 ** 19; // that are drawn of a camera; a larger one is drawn smaller
const mostLines = 30; // of detections
const mostMarks = 2000; // of each kind, in the picture
const mostOfTag = 60; // bytes of its payload, in the picture
const hex = (color: number): string => `#${color.toString(16).padStart(6, "0")}`;

interface Shown { index: number; camera: Camera; scale: number; canvas: HTMLCanvasElement; caption: HTMLElement; list: HTMLElement;
                 image: ImageBitmap | null; of: unknown; drawn: unknown }

function makeShown(camera: Camera, index: number): Shown {
  const scale = Math.min(1, Math.sqrt(mostPixels / (camera.width * camera.height)));
  const size = (length: number): number => Math.max(1, Math.floor(length * scale));
  const canvas = make("canvas", { width: size(camera.width), height: size(camera.height) }) as HTMLCanvasElement;
  return { camera, index, scale, canvas, image: null, of: null, drawn: null, caption: make("div.muted"), list: make("div.detections.number") };
}

export class CameraPanel implements Panel {
  readonly element = make("section.camera");
  private key = "";
  private shown: Shown[] = [];
  private readonly eye = new three.PerspectiveCamera();
  private target: three.WebGLRenderTarget | null = null;

  constructor(private readonly app: App) {}

  update(): void {
    const { app } = this;
    const robot = app.selectedRobot;
    const world = app.world;
    const key = robot && world ? `${world.generation}|${robot.description.id}` : "";
    if (key !== this.key) {
      this.key = key;
      const place = robot && world ? world.robots.indexOf(robot) : -1;
      const all = (world?.cameras ?? []).map((camera, index) => ({ camera, index })).filter(({ camera }) => camera.robot === place);
      this.shown = all.slice(0, mostCameras).map(({ camera, index }) => makeShown(camera, index));
      this.element.replaceChildren(...this.shown.flatMap(({ camera, canvas, caption, list }) => [
        make("h3", {}, camera.id, make("span.muted", {}, ` ${camera.width} × ${camera.height}`)), canvas, caption, list]));
      this.element.append(restOf(all.length, mostCameras) ?? "");
    }
    if (this.shown.length === 0) {
      this.element.replaceChildren(make("p.empty", {}, robot ? "This robot has no camera." : "Select a robot with a camera."));
    }
    for (const shown of this.shown) this.draw(shown);
  }

  private draw(shown: Shown): void {
    const { app } = this;
    const robot = app.selectedRobot!.description.id;
    const frame = app.frame;
    const picture = frame?.messages.get(`/robots/${robot}/cameras/${shown.camera.id}/image`);
    const draw = shown.canvas.getContext("2d")!;
    const key = [frame, frame?.messages.size, shown.image, app.view.poses];
    if (Array.isArray(shown.drawn) && key.every((value, i) => value === (shown.drawn as unknown[])[i])) return;
    shown.drawn = key;
    if (picture && picture !== shown.of) {
      shown.of = picture;
      const { data } = picture.read<{ data: Uint8Array }>();
      if (isPictureOf(data, shown.camera)) void this.decode(shown, data);
    }
    if (shown.image && shown.camera.image) draw.drawImage(shown.image, 0, 0);
    else this.render(shown, draw);
    const seen = frame?.messages.get("/detections")?.read<Detections>().cameras.find(({ camera }) => camera === shown.index);
    draw.setTransform(shown.scale, 0, 0, shown.scale, 0, 0);
    this.drawDetections(draw, shown.camera, seen);
    draw.resetTransform();
    const count = seen ? seen.leds.length + seen.directionalLeds.length + seen.tags.length : 0;
    this.listDetections(shown.list, seen);
    setText(shown.caption, `${shown.image && shown.camera.image ? "as the camera took it" : "drawn by the page"} · ${count} detected`);
  }

  private async decode(shown: Shown, data: Uint8Array): Promise<void> {
    const { width, height } = shown.canvas;
    try {
      shown.image = await createImageBitmap(new Blob([data.slice()], { type: "image/png" }), { resizeWidth: width, resizeHeight: height });
    } catch { /* it is damaged: the one before stays */ }
  }

  /** The scene from the camera's place. */
  private render({ camera, canvas, scale }: Shown, draw: CanvasRenderingContext2D): void {
    const { view } = this.app;
    if (!view.poses) return;
    const { width, height } = canvas;
    const pose = compose(poseAt(view.poses.positions, view.poses.orientations, camera.mount.link), camera.mount);
    const [w, x, y, z] = pose.orientation;
    this.eye.position.set(...pose.position);
    // From +z forward, +y down to three's -z forward, +y up.
    this.eye.quaternion.set(x, y, z, w).multiply(new three.Quaternion(1, 0, 0, 0));
    this.eye.updateMatrixWorld();
    const near = 0.003, [fx, fy] = [camera.focalLength[0] * scale, camera.focalLength[1] * scale];
    const [cx, cy] = [camera.principalPoint[0] * scale, camera.principalPoint[1] * scale];
    this.eye.projectionMatrix.makePerspective(-cx / fx * near, (width - cx) / fx * near, cy / fy * near,
                                              -(height - cy) / fy * near, near, 50);
    this.eye.projectionMatrixInverse.copy(this.eye.projectionMatrix).invert();
    if (this.target?.width !== width || this.target.height !== height) {
      this.target?.dispose();
      this.target = new three.WebGLRenderTarget(width, height);
    }
    const pixels = new Uint8Array(4 * width * height);
    view.renderFrom(this.eye, this.target, pixels);
    const image = draw.createImageData(width, height);
    for (let row = 0; row < height; ++row) { // from the bottom, to the top
      const from = 4 * width * (height - 1 - row), to = 4 * width * row;
      for (let i = 0; i < 4 * width; ++i) image.data[to + i] = i % 4 === 3 ? 255 : toScreen[pixels[from + i]];
    }
    draw.putImageData(image, 0, 0);
  }

  private listDetections(list: HTMLElement, seen: SeenByCamera | undefined): void {
    const at = ({ u, v }: { u: number; v: number }): string => `at ${u.toFixed(1)}, ${v.toFixed(1)} px`;
    const light = (kind: string) => (one: { color: number; u: number; v: number }) => `${kind} ${hex(one.color)} ${at(one)}`;
    const lines = seen ? [...seen.leds.slice(0, mostLines).map(light("LED")),
      ...seen.directionalLeds.slice(0, mostLines).map(light("directional LED")),
      ...seen.tags.slice(0, mostLines).map((tag) => `tag ${bytesText(tag.payload)} ${at(tag)}`)].slice(0, mostLines) : [];
    const count = seen ? seen.leds.length + seen.directionalLeds.length + seen.tags.length : 0;
    const more = count > lines.length ? [`… and ${count - lines.length} more`] : [];
    setLines(list, [...lines, ...more]);
  }

  private drawDetections(draw: CanvasRenderingContext2D, camera: Camera, seen: SeenByCamera | undefined): void {
    if (!seen) return;
    const size = camera.width / 320;
    draw.lineWidth = 1.5 * size;
    draw.font = `${11 * size}px system-ui`;
    for (const light of [...seen.leds.slice(0, mostMarks), ...seen.directionalLeds.slice(0, mostMarks)]) {
      draw.strokeStyle = "#fff";
      draw.fillStyle = hex(light.color);
      draw.beginPath();
      draw.arc(light.u, light.v, 4 * size, 0, 7);
      draw.fill();
      draw.stroke();
    }
    draw.strokeStyle = draw.fillStyle = "#ff9d2e";
    for (const tag of seen.tags.slice(0, mostMarks)) {
      draw.beginPath();
      for (let i = 0; i < 4; ++i) draw.lineTo(tag.corners[2 * i], tag.corners[2 * i + 1]);
      draw.closePath();
      draw.stroke();
      draw.fillText(visible(new TextDecoder().decode(tag.payload.subarray(0, mostOfTag))), tag.u + 4 * size, tag.v - 4 * size);
    }
  }
}
