// SPDX-License-Identifier: MIT
// Tags with their true pattern: 6 x 6 modules in a black border of one and a white margin of one.
import * as three from "three";
import type { Poses, World } from "../model/messages";
import { packed, place } from "../model/pose";
import { writeMatrix } from "./matrix";

const vertexShader = `
  attribute vec3 code;  // upper 18 bits, lower 18 bits, 1 if there is a pattern
  varying vec2 vAt;
  flat varying vec3 vCode;
  void main() {
    vAt = uv; vCode = code;
    gl_Position = projectionMatrix * modelViewMatrix * instanceMatrix * vec4(position, 1.0);
  }`;

// The tag's +x is up in the picture and -y is to the right.
const fragmentShader = `
  varying vec2 vAt;
  flat varying vec3 vCode;  // interpolated it would lose its last bits
  float bitOf(float number, float place) { return mod(floor(number / exp2(place)), 2.0); }
  void main() {
    vec2 module = floor(vec2((1.0 - vAt.y) * 10.0, (1.0 - vAt.x) * 10.0));
    vec2 inner = module - 2.0;
    float white;
    if (min(module.x, module.y) < 1.0 || max(module.x, module.y) > 8.0) white = 1.0;
    else if (min(inner.x, inner.y) < 0.0 || max(inner.x, inner.y) > 5.0) white = 0.0;
    else if (vCode.z < 0.5) white = mod(inner.x + inner.y, 2.0) * 0.2 + 0.4;
    else {
      float bit = 35.0 - (inner.y * 6.0 + inner.x);
      white = bit >= 18.0 ? bitOf(vCode.x, bit - 18.0) : bitOf(vCode.y, bit);
    }
    gl_FragColor = vec4(vec3(mix(0.03, 0.93, white)), 1.0);
  }`;

/** The pattern for a payload: an integer from 0 to the number of patterns; null if it is none. */
export function patternOf(payload: Uint8Array, patterns: number[]): number | null {
  if (payload.length > 3) return null;
  const text = new TextDecoder().decode(payload);
  if (!/^\d{1,3}$/.test(text)) return null;
  return patterns[Number(text)] ?? null;
}

export class Tags {
  readonly group = new three.Group();
  private mesh: three.InstancedMesh | null = null;
  private codes = new three.InstancedBufferAttribute(new Float32Array(0), 3);
  private world: World | null = null;
  private mounts = new Float64Array(0);
  private readonly pose = new Float64Array(7);
  private haveChanged = false; // payloads

  setWorld(world: World): void {
    this.world = world;
    if (this.mesh) {
      this.group.remove(this.mesh);
      this.mesh.geometry.dispose();
      this.mesh.dispose();
      this.mesh = null;
    }
    if (world.tags.length === 0) return;
    this.mounts = packed(world.tags.map(({ mount }) => mount));
    const geometry = new three.PlaneGeometry(1, 1);
    this.codes = new three.InstancedBufferAttribute(new Float32Array(3 * world.tags.length), 3);
    geometry.setAttribute("code", this.codes);
    const material = new three.ShaderMaterial({ vertexShader, fragmentShader, polygonOffset: true,
                                                polygonOffsetFactor: -2, polygonOffsetUnits: -2 });
    this.mesh = new three.InstancedMesh(geometry, material, world.tags.length);
    this.mesh.frustumCulled = false;
    this.group.add(this.mesh);
    this.setPayloads(world, []);
  }

  setPoses(poses: Poses): void {
    const { world, mesh, pose } = this;
    if (!mesh || !world) return;
    for (let i = 0; i < world.tags.length; ++i) {
      const { entity, mount, sideLength } = world.tags[i];
      place(pose, poses.positions, poses.orientations, mount.link, this.mounts, 7 * i);
      const side = world.entities[entity]?.removed ? 0 : sideLength * 1.25;
      writeMatrix(mesh.instanceMatrix.array, 16 * i, pose, side, side, side);
    }
    mesh.instanceMatrix.needsUpdate = true;
    if (poses.tagPayloads.length > 0 || this.haveChanged) this.setPayloads(world, poses.tagPayloads);
  }

  /** @param changed  those that differ from the world's */
  private setPayloads(world: World, changed: Poses["tagPayloads"]): void {
    const payloads = new Map(changed.map(({ tag, payload }) => [tag, payload]));
    world.tags.forEach((tag, i) => {
      const pattern = patternOf(payloads.get(i) ?? tag.payload, world.tagPatterns);
      this.codes.setXYZ(i, Math.floor((pattern ?? 0) / 2 ** 18), (pattern ?? 0) % 2 ** 18, pattern === null ? 0 : 1);
    });
    this.codes.needsUpdate = true;
    this.haveChanged = changed.length > 0;
  }
}
