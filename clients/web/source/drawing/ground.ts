// SPDX-License-Identifier: MIT
// The ground: the arena's squares, a soft edge around them, a scale in metres along two sides, axes at the origin, and the
// plain around all of it.
import * as three from "three";
import type { World } from "../model/messages";
import { arenaOf, scaleWidth } from "./framing";

export interface GroundColors { light: number; dark: number; outside: number; text: string }

/** Of x, y and z: vermilion, bluish green and blue of Okabe and Ito. */
export const axisColors = [0xd55e00, 0x009e73, 0x0072b2];

export const plainRadius = 120; // of what is outside [m]

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

/** Lengths between the numbers of a scale, so that there are at most so many: 1, 2 or 5 times a power of ten [m]. */
export function stepOf(length: number, most: number): number {
  const power = 10 ** Math.floor(Math.log10(length / most));
  return power * ([1, 2, 5].find((factor) => length / (factor * power) <= most) ?? 10);
}

/** Marks of a scale from one coordinate to another, with their texts [m]. */
export function marksOf(low: number, high: number): { at: number; text: string }[] {
  const step = stepOf(high - low, 8);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const marks = [];
  for (let k = Math.ceil(low / step - 1e-6); k * step <= high + 1e-6 * step; ++k) {
    marks.push({ at: k * step, text: (k * step).toFixed(digits).replace(/^-(?=[0.]*$)/, "").replace("-", "\u2212") });
  }
  return marks;
}

/** A strip of ticks and numbers below them. @param from  numbers that are less are left out: another strip has one at that corner */
function scalePicture(low: number, high: number, depth: number, axis: string, color: string, from = low): HTMLCanvasElement {
  const length = high - low + 2 * depth;
  const perMetre = Math.min(64 / depth, 4096 / length);
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [length, depth].map((side) => Math.max(1, Math.round(side * perMetre)));
  const context = canvas.getContext("2d")!;
  const height = canvas.height;
  context.fillStyle = context.strokeStyle = color;
  context.lineWidth = Math.max(1, height / 28);
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.font = `${0.46 * height}px system-ui, sans-serif`;
  const marks = marksOf(low, high);
  marks.forEach(({ at, text }, i) => {
    const x = (at - low + depth) * perMetre;
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x, 0.2 * height);
    context.stroke();
    if (at >= from - 1e-9) context.fillText(i === marks.length - 1 ? `${axis} ${text} m` : text, x, 0.56 * height);
  });
  return canvas;
}

function disposeOf(object: three.Object3D): void {
  if (!(object instanceof three.Mesh || object instanceof three.LineSegments)) return;
  object.geometry.dispose();
  object.material.map?.dispose();
  object.material.dispose();
}

export class Ground {
  readonly group = new three.Group();
  readonly marks = new three.Group(); // what the world does not have

  private arena: three.Mesh | null = null;
  private lit = new three.MeshLambertMaterial();
  private flat = new three.MeshBasicMaterial(); // the same without shadows, which takes less

  constructor(private readonly isSlow: boolean) {}

  showShadows(areShown: boolean): void { if (this.arena) this.arena.material = areShown ? this.lit : this.flat; }

  /** @param litFromAbove  how bright a matt surface is that faces up */
  setWorld(world: World, colors: GroundColors, litFromAbove: number): void {
    this.group.traverse(disposeOf);
    this.flat.dispose();
    this.lit.dispose();
    this.group.clear();
    this.marks.clear();
    this.arena = null;
    this.group.add(this.marks);
    if (!world.hasFloor) return;
    const { low, high } = arenaOf(world);
    const [x, y] = [high[0] - low[0], high[1] - low[1]];
    const center: [number, number] = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    const tile = world.floorTile > 0 ? world.floorTile : 0.1;
    const map = checkers(colors.light, colors.dark);
    map.repeat.set(x / (2 * tile), y / (2 * tile));
    map.anisotropy = this.isSlow ? 1 : 4;
    map.magFilter = three.NearestFilter;
    this.lit = new three.MeshLambertMaterial({ map });
    this.flat = new three.MeshBasicMaterial({ map, color: new three.Color(litFromAbove, litFromAbove, litFromAbove) });
    this.arena = this.addPlane(x, y, center, 0, this.lit, 1);
    // After it: what is hidden costs nothing. Without graphics processor light is not computed for each pixel. The offset
    // and the many pieces keep it behind: depths within one huge triangle are not exact.
    const behind = { color: colors.outside, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 8 };
    const lit = new three.Color(colors.outside).multiplyScalar(litFromAbove);
    this.addPlane(2 * plainRadius, 2 * plainRadius, center, -0.0006, this.isSlow
      ? new three.MeshBasicMaterial({ ...behind, color: lit }) : new three.MeshLambertMaterial(behind), 2, 16);
    const depth = scaleWidth(x, y);
    this.addEdge(low, high, 0.7 * depth, colors, litFromAbove);
    this.addScale(low, high, depth, colors.text);
    this.addAxes(2 * tile);
  }

  private addPlane(x: number, y: number, [cx, cy]: [number, number], z: number, material: three.Material, order: number, pieces = 1): three.Mesh {
    const mesh = new three.Mesh(new three.PlaneGeometry(x, y, pieces, pieces), material);
    mesh.position.set(cx, cy, z);
    mesh.receiveShadow = material instanceof three.MeshLambertMaterial;
    mesh.renderOrder = order;
    this.group.add(mesh);
    return mesh;
  }

  /** A rim around the arena whose light fades. */
  private addEdge([x0, y0]: number[], [x1, y1]: number[], width: number, colors: GroundColors, litFromAbove: number): void {
    const positions: number[] = [], shades: number[] = [], index: number[] = [];
    const color = new three.Color(colors.light).lerp(new three.Color(colors.dark), 0.5).multiplyScalar(litFromAbove);
    const corners = 8; // of each quarter
    const ring = [[x1, y1], [x0, y1], [x0, y0], [x1, y0]];
    for (const [quarter, [x, y]] of ring.entries()) {
      for (let i = 0; i <= corners; ++i) {
        const angle = (quarter + i / corners) * Math.PI / 2;
        positions.push(x, y, 0, x + width * Math.cos(angle), y + width * Math.sin(angle), 0);
        shades.push(color.r, color.g, color.b, 0.75, color.r, color.g, color.b, 0);
      }
    }
    const pairs = positions.length / 6;
    for (let i = 0; i < pairs; ++i) {
      const a = 2 * i, b = 2 * ((i + 1) % pairs);
      index.push(a, a + 1, b + 1, a, b + 1, b);
    }
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.Float32BufferAttribute(positions, 3));
    geometry.setAttribute("color", new three.Float32BufferAttribute(shades, 4));
    geometry.setIndex(index);
    const mesh = new three.Mesh(geometry, new three.MeshBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false }));
    mesh.renderOrder = 2;
    this.marks.add(mesh);
  }

  /** Along the sides of the lowest y and the highest x, which the camera sees first. */
  private addScale([x0, y0]: number[], [x1, y1]: number[], depth: number, color: string): void {
    const strip = (canvas: HTMLCanvasElement, length: number, at: [number, number]): three.Mesh => {
      const map = new three.CanvasTexture(canvas);
      map.colorSpace = three.SRGBColorSpace;
      map.anisotropy = this.isSlow ? 1 : 8;
      const material = new three.MeshBasicMaterial({ map, transparent: true, depthWrite: false, polygonOffset: true,
                                                     polygonOffsetFactor: -1, polygonOffsetUnits: -4 });
      const mesh = this.addPlane(length, depth, at, 0, material, 3);
      this.marks.add(mesh);
      return mesh;
    };
    strip(scalePicture(x0, x1, depth, "x", color), x1 - x0 + 2 * depth, [(x0 + x1) / 2, y0 - 0.7 * depth]);
    strip(scalePicture(y0, y1, depth, "y", color, y0 + 1.2 * depth), y1 - y0 + 2 * depth, [x1 + 0.7 * depth, (y0 + y1) / 2])
      .rotation.z = Math.PI / 2;
  }

  /** x, y and z of the world at its origin, in colours that everybody tells apart. */
  private addAxes(length: number): void {
    const positions: number[] = [], colors: number[] = [];
    for (const [axis, color] of axisColors.entries()) {
      const rgb = new three.Color(color).toArray();
      positions.push(0, 0, 0.001, ...[0, 1, 2].map((k) => (k === axis ? length : k === 2 ? 0.001 : 0)));
      colors.push(...rgb, ...rgb);
    }
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.Float32BufferAttribute(positions, 3));
    geometry.setAttribute("color", new three.Float32BufferAttribute(colors, 3));
    this.marks.add(new three.LineSegments(geometry, new three.LineBasicMaterial({ vertexColors: true })));
  }
}
