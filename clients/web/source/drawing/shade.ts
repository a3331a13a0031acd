// SPDX-License-Identifier: MIT
// Soft darkness on the floor below and around what stands on it or close above: contact shadows, in one draw call.
import * as three from "three";
import type { Poses, World } from "../model/messages";
import { halfExtents, packed, place } from "../model/pose";
import { boundsOf, isRound, partsOf } from "./shapes";

const darkest = 0.5; // opacity
const above = 0.0004; // the floor [m]

const vertexShader = `
  attribute vec4 footprint;  // half sides of what shades, relative to the whole; the opacity; 1 if it is round
  varying vec2 vAt;
  varying vec4 vFootprint;
  void main() {
    vAt = uv; vFootprint = footprint;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;
const fragmentShader = `
  varying vec2 vAt;
  varying vec4 vFootprint;
  void main() {
    vec2 outside = max(abs(vAt) - vFootprint.xy, 0.0) / (1.0 - vFootprint.xy);
    float away = vFootprint.w > 0.5 ? (length(vAt) - vFootprint.x) / (1.0 - vFootprint.x) : length(outside);
    float light = clamp(away, 0.0, 1.0);
    gl_FragColor = vec4(0.0, 0.0, 0.0, vFootprint.z * (1.0 - light) * (1.0 - light));
  }`;

export class Shade {
  readonly mesh: three.Mesh<three.BufferGeometry, three.ShaderMaterial>;
  private world: World | null = null;
  private links: number[] = [];
  private areRound: boolean[] = [];
  private mounts = new Float64Array(0); // of the middles of boxes around links
  private halves: number[][] = [];
  private readonly pose = new Float64Array(7);

  constructor() {
    const material = new three.ShaderMaterial({ vertexShader, fragmentShader, transparent: true, depthWrite: false,
                                                polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -8 });
    this.mesh = new three.Mesh(new three.BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 3; // after the floor and what is painted on it
  }

  setWorld(world: World): void {
    this.world = world;
    const parts = world.hasFloor ? partsOf(world).filter(({ isDecoration }) => !isDecoration) : [];
    const boxes = parts.map((part) => boundsOf(part, world.hulls));
    this.links = parts.map(({ link }) => link);
    this.areRound = parts.map(({ shape, orientation }) => isRound(shape) && Math.abs(orientation[0]) > 0.99);
    this.mounts = packed(parts.map(({ orientation }, i) => ({ position: boxes[i].center, orientation })));
    this.halves = boxes.map(({ size }) => size.map((side) => side / 2));
    const count = parts.length;
    const geometry = new three.BufferGeometry();
    for (const [name, size] of [["position", 3], ["uv", 2], ["footprint", 4]] as const) {
      geometry.setAttribute(name, new three.BufferAttribute(new Float32Array(4 * size * count), size).setUsage(three.DynamicDrawUsage));
    }
    const uv = geometry.getAttribute("uv").array;
    const index = new Uint32Array(6 * count);
    for (let i = 0; i < count; ++i) {
      (uv as Float32Array).set([-1, -1, 1, -1, 1, 1, -1, 1], 8 * i);
      index.set([0, 1, 2, 0, 2, 3].map((corner) => 4 * i + corner), 6 * i);
    }
    geometry.setIndex(new three.BufferAttribute(index, 1));
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometry;
  }

  setPoses(poses: Poses): void {
    if (!this.world) return;
    const { geometry } = this.mesh;
    let count = 0;
    for (let i = 0; i < this.links.length; ++i) count += this.add(i, count, poses) ? 1 : 0;
    geometry.setDrawRange(0, 6 * count);
    this.mesh.visible = count > 0;
    geometry.getAttribute("position").needsUpdate = geometry.getAttribute("footprint").needsUpdate = true;
  }

  /** The shade of link i; false if it is too high above the floor. */
  private add(i: number, at: number, poses: Poses): boolean {
    const { pose } = this;
    place(pose, poses.positions, poses.orientations, this.links[i], this.mounts, 7 * i);
    const [w, x, y, z] = [pose[3], pose[4], pose[5], pose[6]];
    const half = this.halves[i];
    // Around z as the link is turned, or not at all where it lies on its side.
    const length = Math.hypot(1 - 2 * (y * y + z * z), 2 * (x * y + w * z));
    const [c, s] = length < 0.3 ? [1, 0] : [(1 - 2 * (y * y + z * z)) / length, 2 * (x * y + w * z) / length];
    const yaw = Math.atan2(s, c) / 2;
    const [a, b] = [Math.cos(yaw), -Math.sin(yaw)]; // turned back
    const [hx, hy, hz] = halfExtents([a * w - b * z, a * x - b * y, a * y + b * x, a * z + b * w], half);
    const height = pose[2] - hz, least = Math.min(hx, hy, hz);
    const most = 1.2 * Math.min(hx, hy) + least;
    if (height > most || height < -hz || !(least > 0)) return false;
    const spread = Math.min(0.35 * Math.min(Math.sqrt(hx * hy), 2 * hz) + Math.max(height, 0), 2 * most);
    const { geometry } = this.mesh;
    const positions = geometry.getAttribute("position").array as Float32Array;
    const footprints = geometry.getAttribute("footprint").array as Float32Array;
    const [wx, wy] = [hx + spread, hy + spread];
    const opacity = darkest * Math.min(1, 1 - Math.max(height, 0) / most) ** 2;
    for (let corner = 0; corner < 4; ++corner) {
      const [u, v] = [corner === 0 || corner === 3 ? -wx : wx, corner < 2 ? -wy : wy];
      positions[12 * at + 3 * corner] = pose[0] + c * u - s * v;
      positions[12 * at + 3 * corner + 1] = pose[1] + s * u + c * v;
      positions[12 * at + 3 * corner + 2] = above;
      footprints[16 * at + 4 * corner] = Math.max(hx - 0.5 * spread, 0) / wx;
      footprints[16 * at + 4 * corner + 1] = Math.max(hy - 0.5 * spread, 0) / wy;
      footprints[16 * at + 4 * corner + 2] = opacity;
      footprints[16 * at + 4 * corner + 3] = this.areRound[i] && Math.abs(hx - hy) < 0.1 * hx ? 1 : 0;
    }
    return true;
  }
}
