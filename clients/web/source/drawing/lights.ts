// LEDs: spheres that glow in their colour; directional ones as cones of light.
import * as three from "three";
import type { Led, Poses, World } from "../model/messages";
import { compose, poseAt } from "../model/pose";

const radius = 0.004; // [m]
const longestCone = 0.02; // [m]
const widestCone = 0.9; // half-angle [rad]: wider ones would hide what they shine on

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

  setWorld(world: World): void {
    this.world = world;
    this.group.clear();
    const count = world.leds.length + world.directionalLeds.length;
    this.bulbs = this.cones = this.glow = null;
    if (count === 0) return;
    this.bulbs = new three.InstancedMesh(new three.SphereGeometry(radius, 12, 8), new three.MeshBasicMaterial(), count);
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
        { transparent: true, opacity: 0.2, side: three.DoubleSide, depthWrite: false }), world.directionalLeds.length);
      this.cones.frustumCulled = false;
      this.group.add(this.cones);
    }
  }

  setPoses(poses: Poses): void {
    if (!this.world || !this.bulbs || !this.glow) return;
    this.world.leds.forEach((led, i) => this.place(led, i, poses.ledColors[i] ?? 0, poses));
    this.world.directionalLeds.forEach((led, i) => {
      const color = poses.directionalLedColors[i] ?? 0;
      const matrix = this.place(led, this.world!.leds.length + i, color, poses);
      const wide = longestCone * Math.tan(Math.min(led.observableAngle, widestCone));
      const isOn = color !== 0 && !this.world!.entities[led.entity]?.removed;
      matrix.scale(isOn ? new three.Vector3(wide, wide, longestCone) : new three.Vector3(0, 0, 0));
      this.cones!.setMatrixAt(i, matrix);
      this.cones!.setColorAt(i, new three.Color(color));
    });
    const changed = [this.bulbs, this.cones].filter((mesh) => mesh !== null);
    for (const mesh of changed) {
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
    for (const name of ["position", "color"]) this.glow.geometry.getAttribute(name).needsUpdate = true;
  }

  /** Places a bulb and its glow; returns where it is. */
  private place(led: Led, index: number, rgb: number, poses: Poses): three.Matrix4 {
    const pose = compose(poseAt(poses.positions, poses.orientations, led.mount.link), led.mount);
    const [w, x, y, z] = pose.orientation;
    const size = this.world!.entities[led.entity]?.removed ? 0 : 1;
    const matrix = new three.Matrix4().compose(new three.Vector3(...pose.position),
      new three.Quaternion(x, y, z, w), new three.Vector3(size, size, size));
    const color = new three.Color(rgb === 0 ? 0x3a3d42 : rgb);
    this.bulbs!.setMatrixAt(index, matrix);
    this.bulbs!.setColorAt(index, color);
    const light = rgb === 0 || size === 0 ? 0 : 1;
    this.glow!.geometry.getAttribute("position").setXYZ(index, ...pose.position);
    this.glow!.geometry.getAttribute("color").setXYZ(index, color.r * light, color.g * light, color.b * light);
    return matrix;
  }
}
