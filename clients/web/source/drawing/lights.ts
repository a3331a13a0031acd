// LEDs: spheres that glow in their colour; directional ones as cones of light.
import * as three from "three";
import type { Led, Poses, World } from "../model/messages";
import { packed, place } from "../model/pose";
import { writeMatrix } from "./matrix";

const radius = 0.004; // [m]
const longestCone = 0.02; // [m]
const widestCone = 0.9; // half-angle [rad]: wider ones would hide what they shine on
const mostRound = 2000; // LEDs that are round, with 168 triangles each; of more, each has 20

function glowTexture(): three.DataTexture {
  const size = 64;
  const bytes = new Uint8Array(4 * size * size);
  for (let i = 0; i < size * size; ++i) {
    const r = Math.hypot((i % size) - 31.5, Math.floor(i / size) - 31.5) / 32;
    const light = Math.max(0, 1 - r);
    bytes.set([255, 255, 255, 255 * light * light * light], 4 * i);
  }
  const texture = new three.DataTexture(bytes, size, size);
  texture.needsUpdate = true;
  return texture;
}

export class Lights {
  readonly group = new three.Group();
  private bulbs: three.InstancedMesh | null = null;
  private cones: three.InstancedMesh | null = null;
  private glow: three.Points | null = null;
  private readonly texture = glowTexture();
  private world: World | null = null;
  private mounts = new Float64Array(0); // of LEDs, then of directional ones
  private readonly pose = new Float64Array(7);
  private readonly color = new three.Color();

  setWorld(world: World): void {
    this.world = world;
    this.group.clear();
    const count = world.leds.length + world.directionalLeds.length;
    this.bulbs = this.cones = this.glow = null;
    if (count === 0) return;
    this.mounts = packed([...world.leds, ...world.directionalLeds].map(({ mount }) => mount));
    const [around, up] = count <= mostRound ? [12, 8] : [5, 3];
    this.bulbs = new three.InstancedMesh(new three.SphereGeometry(radius, around, up), new three.MeshBasicMaterial(), count);
    this.glow = new three.Points(new three.BufferGeometry(), new three.PointsMaterial({
      size: 12 * radius, map: this.texture, vertexColors: true, transparent: true, depthWrite: false,
      blending: three.AdditiveBlending }));
    this.glow.geometry.setAttribute("position", new three.BufferAttribute(new Float32Array(3 * count), 3));
    this.glow.geometry.setAttribute("color", new three.BufferAttribute(new Float32Array(3 * count), 3));
    this.glow.frustumCulled = this.bulbs.frustumCulled = false;
    this.group.add(this.bulbs, this.glow);
    if (world.directionalLeds.length > 0) {
      const cone = new three.ConeGeometry(1, 1, 32, 1, true).rotateX(-Math.PI / 2).translate(0, 0, 0.5);
      this.cones = new three.InstancedMesh(cone, new three.MeshBasicMaterial(
        { transparent: true, opacity: 0.12, side: three.DoubleSide, depthWrite: false }), world.directionalLeds.length);
      this.cones.frustumCulled = false;
      this.group.add(this.cones);
    }
  }

  setPoses(poses: Poses): void {
    const { world, bulbs, cones, glow, pose, color } = this;
    if (!world || !bulbs || !glow) return;
    for (let i = 0; i < world.leds.length; ++i) this.place(world.leds[i], i, poses.ledColors[i] ?? 0, poses);
    for (let i = 0; i < world.directionalLeds.length; ++i) {
      const led = world.directionalLeds[i], rgb = poses.directionalLedColors[i] ?? 0;
      const isThere = this.place(led, world.leds.length + i, rgb, poses);
      const length = rgb !== 0 && isThere ? longestCone : 0;
      const wide = length * Math.tan(Math.min(led.observableAngle, widestCone));
      writeMatrix(cones!.instanceMatrix.array, 16 * i, pose, wide, wide, length);
      cones!.setColorAt(i, color.set(rgb));
    }
    for (const mesh of [bulbs, cones]) {
      if (!mesh) continue;
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
    for (const name of ["position", "color"]) glow.geometry.getAttribute(name).needsUpdate = true;
  }

  /** Places a bulb and its glow, and leaves its pose in `pose`; false if it was removed. */
  private place(led: Led, index: number, rgb: number, poses: Poses): boolean {
    const { bulbs, glow, pose, color } = this;
    place(pose, poses.positions, poses.orientations, led.mount.link, this.mounts, 7 * index);
    const isThere = !this.world!.entities[led.entity]?.removed;
    const size = isThere ? 1 : 0, light = isThere && rgb !== 0 ? 1 : 0;
    writeMatrix(bulbs!.instanceMatrix.array, 16 * index, pose, size, size, size);
    bulbs!.setColorAt(index, color.set(rgb === 0 ? 0x3a3d42 : rgb));
    glow!.geometry.getAttribute("position").setXYZ(index, pose[0], pose[1], pose[2]);
    glow!.geometry.getAttribute("color").setXYZ(index, color.r * light, color.g * light, color.b * light);
    return isThere;
  }
}
