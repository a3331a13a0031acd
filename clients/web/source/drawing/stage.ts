// SPDX-License-Identifier: MIT
// The empty stage: renderer, sun, sky, ground, and the camera with its controls. z is up.
import * as three from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { World } from "../model/messages";
import { lookAt, wayToCamera, type Box } from "./framing";
import { Ground, plainRadius } from "./ground";
import { isSoftware, levels, Quality } from "./quality";
import { Sky } from "./sky";
import type { Vector } from "../model/pose";

const fineShadows = 4096; // [px], of the shadow map of a picture that stays
const mostLinksWithShadows = 200; // while they move, without graphics processor

export interface Look { eye: Vector; at: Vector; fieldOfView: number }

const sunDirection = new three.Vector3(-0.42, -0.62, 1.15).normalize(); // as in `ziggurat render`; shadows fall beside things at first
const themes = {
  light: { horizon: 0xe3e8ec, zenith: 0xa4b2bc, ground: 0xb9bcc0, light: 0xd4d6d9, dark: 0xc3c6ca, outside: 0xb8bbc0, text: "#4c535c",
           sun: 2.3, ambient: 1.5 },
  dark: { horizon: 0x2b313a, zenith: 0x0c0f14, ground: 0x24272d, light: 0x3a3e46, dark: 0x31353c, outside: 0x23262b, text: "#aab2bd",
          sun: 2.0, ambient: 1.0 },
};
export type Theme = keyof typeof themes;

export class Stage {
  readonly scene = new three.Scene();
  readonly camera = new three.PerspectiveCamera(45, 1, 0.001, 200);
  readonly renderer: three.WebGLRenderer;
  readonly controls: OrbitControls;
  private readonly sun = new three.DirectionalLight(0xffffff, 2);
  private readonly skyLight = new three.HemisphereLight(0xffffff, 0x888888, 1);
  private readonly sky = new Sky();
  readonly ground: Ground;
  private world: World | null = null;
  private theme: Theme = "light";
  private readonly quality: Quality;
  readonly isSlow: boolean; // no graphics processor
  private wantsShadows = true;
  private readonly sunAt = new three.Vector3(NaN, NaN, NaN); // where it was aimed
  private fence: WebGLSync | null = null; // of the last frame
  isFine = false; // the last frame was drawn with all pixels
  isDirty = true;

  constructor(readonly canvas: HTMLCanvasElement) {
    const probe = document.createElement("canvas").getContext("webgl2");
    if (!probe) throw new Error("This browser has no WebGL 2. Switch on its graphics acceleration, or use another one.");
    const isSlow = this.isSlow = isSoftware(probe);
    this.ground = new Ground(isSlow);
    this.renderer = new three.WebGLRenderer({ canvas, antialias: !isSlow });
    this.quality = isSlow ? new Quality(2, 1) : new Quality(window.devicePixelRatio > 1 ? 0 : 1, window.devicePixelRatio > 1 ? 0 : 1);
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.autoUpdate = false;
    this.applyQuality();
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(1.2, -1.6, 1.2);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.screenSpacePanning = false;
    this.controls.zoomToCursor = true;
    this.controls.minDistance = 0.02;
    this.controls.addEventListener("change", () => { this.isDirty = true; });
    this.sun.castShadow = true;
    this.sun.shadow.radius = 3;
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.001;
    this.scene.add(this.sun, this.sun.target, this.skyLight, this.sky.mesh, this.ground.group);
  }

  private applyQuality(): void {
    const { pixels, shadowSize, shadows } = levels[this.quality.level];
    this.setPixels(pixels);
    this.setShadowSize(shadowSize);
    this.castShadows();
    if (shadows !== null && this.renderer.shadowMap.type !== shadows) {
      this.renderer.shadowMap.type = shadows;
      this.scene.traverse((object) => {
        if (object instanceof three.Mesh) for (const one of [object.material].flat()) one.needsUpdate = true;
      });
    }
    this.isDirty = true;
  }

  /** About how many triangles round shapes may have. */
  triangles(isFine: boolean): number { return levels[isFine ? 1 : this.quality.level].triangles; }

  private setPixels(perPixel: number): void { this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, perPixel)); }

  /** Drawn pixels per pixel of the screen of a picture that stays; without graphics processor they smooth its edges. */
  private get finePixels(): number { return this.isSlow ? 2 : Math.min(window.devicePixelRatio, 2); }

  /** @param size  of the shadow map, along each side [px] */
  private setShadowSize(size: number): void {
    const { shadow } = this.sun;
    if (shadow.mapSize.x === size && shadow.map) return;
    shadow.mapSize.set(size, size);
    shadow.map?.dispose();
    shadow.map = null;
    this.shadowsChange();
  }

  /** What casts shadows has moved. */
  shadowsChange(): void { this.renderer.shadowMap.needsUpdate = true; }

  /** Whether a moving picture has shadows. */
  private get shadowsMove(): boolean {
    const isMuch = this.isSlow && (this.world?.links.length ?? 0) > mostLinksWithShadows;
    return levels[this.quality.level].shadows !== null && !isMuch;
  }

  /** A picture that stays has shadows also where moving ones are too slow with them. */
  private castShadows(): void {
    this.sun.castShadow = this.wantsShadows && (this.isFine || this.shadowsMove);
    this.ground.showShadows(this.sun.castShadow);
    this.shadowsChange();
  }

  showShadows(isShown: boolean): void {
    this.wantsShadows = isShown;
    this.castShadows();
    this.isDirty = true;
  }

  /** Adapts to how long a frame took [s]. */
  noteFrame(seconds: number): void { if (this.quality.note(seconds)) this.applyQuality(); }

  setTheme(theme: Theme): void {
    this.theme = theme;
    const colors = themes[theme];
    this.sky.setColors(colors.horizon, colors.zenith);
    this.scene.fog = new three.Fog(colors.horizon, 20, 110);
    this.sun.intensity = colors.sun;
    this.skyLight.intensity = colors.ambient;
    this.skyLight.groundColor.set(colors.ground);
    if (this.world) this.setWorld(this.world);
    this.isDirty = true;
  }

  setWorld(world: World): void {
    this.world = world;
    // Colour of a matt surface that faces up, in the light of sun and sky.
    const litFromAbove = (this.sun.intensity * sunDirection.z + this.skyLight.intensity) / Math.PI;
    this.ground.setWorld(world, themes[this.theme], litFromAbove);
    this.castShadows();
    this.isDirty = true;
  }

  /** Shows the whole of a box. */
  frame(box: Box): void {
    this.set(lookAt(box, wayToCamera(this.camera.aspect), this.camera.fov, this.camera.aspect));
  }

  /** Looks straight down; +y is up on the screen. */
  top(): void {
    const at = this.controls.target;
    const distance = this.camera.position.distanceTo(at);
    this.camera.position.set(at.x, at.y - 1e-3 * distance, at.z + distance);
    this.controls.update();
    this.isDirty = true;
  }

  get look(): Look {
    return { eye: this.camera.position.toArray(), at: this.controls.target.toArray(), fieldOfView: this.camera.fov };
  }

  set(look: Look): void {
    this.camera.position.set(...look.eye);
    this.controls.target.set(...look.at);
    this.camera.fov = look.fieldOfView;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.isDirty = true;
  }

  /** Moves eye and target alike. */
  shift(by: Vector): void {
    const way = new three.Vector3(...by);
    this.camera.position.add(way);
    this.controls.target.add(way);
    this.controls.update();
    this.isDirty = true;
  }

  /** Height of the picture [px]. */
  get height(): number { return this.canvas.clientHeight; }

  resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const size = this.renderer.getSize(new three.Vector2());
    if (width === 0 || height === 0 || (size.x === width && size.y === height)) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.isDirty = true;
  }

  /** Whether the last frame is still being drawn: another one would wait behind it. */
  get isBusy(): boolean {
    if (!this.fence) return false;
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    if (gl.getSyncParameter(this.fence, gl.SYNC_STATUS) !== gl.SIGNALED && !gl.isContextLost()) return true;
    gl.deleteSync(this.fence);
    this.fence = null;
    return false;
  }

  /** Prepares a frame. @param isFine  as good as it can be, whatever it takes: for a picture that stays */
  aim(isFine: boolean): void {
    if (isFine !== this.isFine) {
      this.isFine = isFine;
      if (isFine) this.renderer.setPixelRatio(this.finePixels);
      else this.setPixels(levels[this.quality.level].pixels);
      this.setShadowSize(isFine ? Math.max(levels[this.quality.level].shadowSize, fineShadows) : levels[this.quality.level].shadowSize);
      if (!this.shadowsMove) this.castShadows();
    }
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(0.0005, distance / 200);
    this.camera.far = Math.max(20, distance * 60);
    this.camera.updateProjectionMatrix();
    this.aimSun(distance);
  }

  render(): void {
    const fog = this.scene.fog as three.Fog;
    [fog.near, fog.far] = [0.2 * Math.min(this.camera.far, plainRadius), 0.9 * Math.min(this.camera.far, plainRadius)];
    this.renderer.render(this.scene, this.camera);
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    this.fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    this.isDirty = false;
  }

  /** Whether a picture that stays would be better than the last one. */
  get canBeFiner(): boolean { return !this.isFine && this.renderer.getPixelRatio() < this.finePixels; }

  /** Shadows are as sharp as the view needs. */
  private aimSun(distance: number): void {
    const { camera } = this.sun.shadow;
    const wanted = Math.min(Math.max(0.9 * distance, 0.1), 30);
    if (Math.abs(camera.right - wanted) > 0.1 * camera.right || camera.right === 5) {
      camera.left = camera.bottom = -wanted;
      camera.right = camera.top = wanted;
      camera.near = 0.1 * wanted;
      camera.far = 8 * wanted;
      camera.updateProjectionMatrix();
      this.sunAt.set(NaN, NaN, NaN);
    }
    const at = this.controls.target;
    if (at.equals(this.sunAt)) return;
    this.sunAt.copy(at);
    this.sun.target.position.copy(at);
    this.sun.position.copy(at).addScaledVector(sunDirection, 4 * camera.right);
    this.shadowsChange();
  }
}
