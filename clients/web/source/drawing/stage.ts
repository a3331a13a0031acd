// The empty stage: renderer, sun, sky, floor, and the camera with its controls. z is up.
import * as three from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { World } from "../model/messages";
import { isSoftware, levels, Quality } from "./quality";
import type { Vector } from "../model/pose";

export interface Look { eye: Vector; at: Vector; fieldOfView: number }

const sunDirection = new three.Vector3(-0.42, -0.62, 1.15).normalize(); // as in `ziggurat render`; shadows fall beside things at first
const themes = {
  light: { sky: 0xe9ebee, ground: 0xb9bcc0, light: 0xd4d6d9, dark: 0xc3c6ca, outside: 0xaeb1b6, sun: 2.3, ambient: 1.5 },
  dark: { sky: 0x16181c, ground: 0x24272d, light: 0x3a3e46, dark: 0x31353c, outside: 0x23262b, sun: 2.0, ambient: 1.0 },
};
export type Theme = keyof typeof themes;

/** Squares of two greys; each is a tile. */
function checkers(a: number, b: number): three.DataTexture {
  const bytes = new Uint8Array(16);
  [a, b, b, a].forEach((color, i) => bytes.set([color >> 16, (color >> 8) & 255, color & 255, 255], 4 * i));
  const texture = new three.DataTexture(bytes, 2, 2);
  texture.colorSpace = three.SRGBColorSpace;
  texture.wrapS = texture.wrapT = three.RepeatWrapping;
  texture.generateMipmaps = true;
  texture.minFilter = three.LinearMipmapLinearFilter;
  texture.needsUpdate = true;
  return texture;
}

export class Stage {
  readonly scene = new three.Scene();
  readonly camera = new three.PerspectiveCamera(45, 1, 0.001, 200);
  readonly renderer: three.WebGLRenderer;
  readonly controls: OrbitControls;
  private readonly sun = new three.DirectionalLight(0xffffff, 2);
  private readonly sky = new three.HemisphereLight(0xffffff, 0x888888, 1);
  private floor: three.Mesh[] = [];
  private world: World | null = null;
  private theme: Theme = "light";
  private readonly quality: Quality;
  readonly isSlow: boolean; // no graphics processor
  private wantsShadows = true;
  private readonly sunAt = new three.Vector3(NaN, NaN, NaN); // where it was aimed
  private isFine = false; // the last frame was drawn with all pixels
  isDirty = true;

  constructor(readonly canvas: HTMLCanvasElement) {
    const probe = document.createElement("canvas").getContext("webgl2");
    if (!probe) throw new Error("This browser has no WebGL 2. Switch on its graphics acceleration, or use another one.");
    const isSlow = this.isSlow = isSoftware(probe);
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
    this.scene.add(this.sun, this.sun.target, this.sky);
  }

  private applyQuality(): void {
    const { pixels, shadowSize, shadows } = levels[this.quality.level];
    this.setPixels(pixels);
    this.sun.shadow.mapSize.set(shadowSize, shadowSize);
    this.sun.shadow.map?.dispose();
    this.sun.shadow.map = null;
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

  /** What casts shadows has moved. */
  shadowsChange(): void { this.renderer.shadowMap.needsUpdate = true; }

  /** A picture that stays has shadows also where moving ones are too slow with them. */
  private castShadows(): void {
    this.sun.castShadow = this.wantsShadows && (this.isFine || levels[this.quality.level].shadows !== null);
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
    this.scene.background = new three.Color(colors.sky);
    this.scene.fog = new three.Fog(colors.sky, 30, 120);
    this.sun.intensity = colors.sun;
    this.sky.intensity = colors.ambient;
    this.sky.groundColor.set(colors.ground);
    if (this.world) this.setWorld(this.world);
    this.isDirty = true;
  }

  /** Floor and arena. */
  setWorld(world: World): void {
    this.world = world;
    for (const mesh of this.floor) {
      this.scene.remove(mesh);
      mesh.geometry.dispose();
      const material = mesh.material as three.MeshLambertMaterial;
      material.map?.dispose();
      material.dispose();
    }
    this.floor = [];
    if (!world.hasFloor) return;
    const colors = themes[this.theme];
    const tile = world.floorTile > 0 ? world.floorTile : 0.1;
    const [x, y] = [world.arenaSize[0] || 1, world.arenaSize[1] || 1];
    const center: [number, number] = [world.arenaCenter[0] || 0, world.arenaCenter[1] || 0];
    const map = checkers(colors.light, colors.dark);
    map.repeat.set(x / (2 * tile), y / (2 * tile));
    map.anisotropy = this.isSlow ? 1 : 4;
    map.magFilter = three.NearestFilter;
    this.addPlane(x, y, center, 0, new three.MeshLambertMaterial({ map }));
    // After it: what is hidden costs nothing. Without graphics processor light is not computed for each pixel. The offset
    // and the many pieces keep it behind: depths within one huge triangle are not exact.
    const behind = { color: colors.outside, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 8 };
    this.addPlane(240, 240, center, -0.0006, this.isSlow
      ? new three.MeshBasicMaterial({ ...behind, color: this.litFromAbove(colors.outside) })
      : new three.MeshLambertMaterial(behind), 16);
    this.isDirty = true;
  }

  /** What a matt surface that faces up looks like in the light of sun and sky. */
  private litFromAbove(color: number): three.Color {
    return new three.Color(color).multiplyScalar((this.sun.intensity * sunDirection.z + this.sky.intensity) / Math.PI);
  }

  private addPlane(x: number, y: number, [cx, cy]: [number, number], z: number, material: three.Material, pieces = 1): void {
    const mesh = new three.Mesh(new three.PlaneGeometry(x, y, pieces, pieces), material);
    mesh.position.set(cx, cy, z);
    mesh.receiveShadow = material instanceof three.MeshLambertMaterial;
    mesh.renderOrder = this.floor.length + 1;
    this.scene.add(mesh);
    this.floor.push(mesh);
  }

  /** Shows the whole of a box. */
  frame(low: Vector, high: Vector): void {
    const center = low.map((value, i) => (value + high[i]) / 2) as Vector;
    const radius = Math.max(0.05, Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) / 2);
    const narrow = Math.min(1, this.camera.aspect);
    const distance = 0.95 * radius / Math.sin((this.camera.fov * Math.PI) / 360) / narrow;
    const way = new three.Vector3(0.55, -0.75, 0.55).normalize();
    this.set({ eye: [center[0] + way.x * distance, center[1] + way.y * distance, center[2] + way.z * distance],
               at: center, fieldOfView: this.camera.fov });
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

  resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const size = this.renderer.getSize(new three.Vector2());
    if (width === 0 || height === 0 || (size.x === width && size.y === height)) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.isDirty = true;
  }

  /** Draws. @param isFine  as well as it can, whatever it takes: for a picture that stays */
  render(isFine = false): void {
    if (isFine !== this.isFine) {
      this.isFine = isFine;
      if (isFine) this.renderer.setPixelRatio(this.finePixels);
      else this.setPixels(levels[this.quality.level].pixels);
      if (levels[this.quality.level].shadows === null) this.castShadows();
    }
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(0.0005, distance / 200);
    this.camera.far = Math.max(20, distance * 60);
    this.camera.updateProjectionMatrix();
    this.aimSun(distance);
    this.renderer.render(this.scene, this.camera);
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
