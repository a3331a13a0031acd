// SPDX-License-Identifier: MIT
// The copies of a shape that are drawn in one call, chosen anew for each frame.
import * as three from "three";
import { writeMatrix } from "./matrix";
import { canMerge, Merged, roomFor } from "./merged";

/** Darker edges of boxes, in units of their sides: they tell touching blocks apart. */
export function addEdges(material: three.MeshLambertMaterial): void {
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nvarying vec3 vUnit; varying vec3 vSide;")
      .replace("#include <begin_vertex>", `#include <begin_vertex>
        vUnit = position - vec3(0.0, 0.0, 0.5);
        vSide = vec3(length(instanceMatrix[0].xyz), length(instanceMatrix[1].xyz), length(instanceMatrix[2].xyz));`);
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", "#include <common>\nvarying vec3 vUnit; varying vec3 vSide;")
      .replace("#include <color_fragment>", `#include <color_fragment>
        vec3 room = (0.5 - abs(vUnit)) * vSide;
        float middle = max(min(room.x, room.y), min(max(room.x, room.y), room.z));
        float width = max(fwidth(middle) * 1.2, 0.00035);
        diffuseColor.rgb *= mix(0.62, 1.0, smoothstep(0.3 * width, width, middle));`);
  };
}

export class Batch {
  readonly mesh: three.InstancedMesh; // what is drawn, unless it is merged
  private readonly merged: Merged | null;
  private readonly colors: Float32Array;
  private count = 0;
  readonly parts: Int32Array; // that are drawn: indices of parts

  /**
   * @param room  copies at most, @param merges  whether they are drawn as a merged mesh if that fits
   */
  constructor(geometry: three.BufferGeometry, material: three.MeshLambertMaterial, room: number, merges: boolean) {
    const copies = roomFor(room);
    this.mesh = new three.InstancedMesh(geometry, material, copies);
    this.mesh.castShadow = this.mesh.receiveShadow = true;
    this.mesh.frustumCulled = false;
    this.mesh.instanceMatrix.setUsage(three.DynamicDrawUsage);
    this.colors = new Float32Array(4 * copies).fill(1);
    this.mesh.instanceColor = new three.InstancedBufferAttribute(this.colors, 4).setUsage(three.DynamicDrawUsage);
    this.parts = new Int32Array(copies);
    this.merged = merges && canMerge(geometry, copies) ? new Merged(this.mesh, this.colors, material) : null;
  }

  get object(): three.Mesh { return this.merged?.mesh ?? this.mesh; }
  get isFull(): boolean { return this.count >= this.parts.length; }

  begin(): void { this.count = 0; }

  /** @param color  linear red, green and blue, from `colorAt` on; other parameters as of writeMatrix() */
  add(part: number, pose: Float64Array, sx: number, sy: number, sz: number, color: Float32Array, colorAt: number): void {
    if (this.isFull) return;
    const at = this.count++;
    this.parts[at] = part;
    writeMatrix(this.mesh.instanceMatrix.array, 16 * at, pose, sx, sy, sz);
    for (let k = 0; k < 3; ++k) this.colors[4 * at + k] = color[colorAt + k];
  }

  end(): void {
    const { mesh, merged, count } = this;
    mesh.count = count;
    mesh.visible = count > 0;
    mesh.boundingSphere = null; // of another frame
    if (merged) merged.show(count);
    else if (count > 0) mesh.instanceMatrix.needsUpdate = mesh.instanceColor!.needsUpdate = true;
  }

  setGeometry(geometry: three.BufferGeometry): void {
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometry;
    this.merged?.shapeChanges();
  }

  dispose(): void {
    this.merged?.dispose();
    this.mesh.removeFromParent();
    this.mesh.geometry.dispose();
    (this.mesh.material as three.Material).dispose();
    this.mesh.dispose();
  }
}
