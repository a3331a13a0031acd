// All links as instanced or merged meshes: one draw call per shape.
import * as three from "three";
import type { Poses, World } from "../model/messages";
import { packed, place } from "../model/pose";
import { writeMatrix } from "./matrix";
import { canMerge, Merged, roomFor } from "./merged";
import { roundness } from "./quality";
import { isRound, makeGeometry, partsOf, type Part } from "./shapes";

interface Batch {
  mesh: three.InstancedMesh; // what is drawn, unless it is merged
  merged: Merged | null;
  parts: Part[];
  mounts: Float64Array;
}

/** Darker edges of boxes, in units of their sides: they tell touching blocks apart. */
function addEdges(material: three.MeshLambertMaterial): void {
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

export class Bodies {
  readonly group = new three.Group();
  readonly decorations = new three.Group(); // what the world does not have
  private batches: Batch[] = [];
  private readonly pose = new Float64Array(7);
  private around = 0; // pieces of round shapes

  /** @param merges  whether links are drawn as merged meshes, as far as they fit */
  constructor(private readonly merges: boolean) { this.group.add(this.decorations); }

  /** @param triangles  of all round shapes, about */
  setWorld(world: World, triangles: number): void {
    for (const { mesh, merged } of this.batches) {
      merged?.dispose();
      mesh.removeFromParent();
      mesh.geometry.dispose();
      (mesh.material as three.Material).dispose();
      mesh.dispose();
    }
    const alike = new Map<string, Part[]>();
    const all = partsOf(world);
    this.around = roundness(all.filter(({ shape }) => isRound(shape)).length, triangles);
    for (const part of all) {
      const key = `${part.shape} ${part.isDecoration}`;
      const list = alike.get(key);
      if (list) list.push(part);
      else alike.set(key, [part]);
    }
    this.batches = [];
    for (const parts of alike.values()) this.addBatch(parts, world);
  }

  /** Draws round shapes with about so many triangles from now on; true if that differs. */
  setDetail(world: World, triangles: number): boolean {
    const round = this.batches.filter(({ parts }) => isRound(parts[0].shape));
    const around = roundness(round.reduce((sum, { parts }) => sum + parts.length, 0), triangles);
    if (around === this.around) return false;
    this.around = around;
    for (const { mesh, merged, parts } of round) {
      mesh.geometry.dispose();
      mesh.geometry = makeGeometry(parts[0].shape, world.hulls, around);
      merged?.shapeChanges();
    }
    return true;
  }

  private addBatch(parts: Part[], world: World): void {
    const { shape, isDecoration } = parts[0];
    const material = new three.MeshLambertMaterial();
    if (shape === "box") addEdges(material);
    const mesh = new three.InstancedMesh(makeGeometry(shape, world.hulls, this.around), material, roomFor(parts.length));
    mesh.count = parts.length;
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.frustumCulled = false;
    mesh.instanceMatrix.setUsage(three.DynamicDrawUsage);
    const color = new three.Color();
    parts.forEach((part, index) => mesh.setColorAt(index, color.set(part.color)));
    const merged = this.merges && canMerge(mesh.geometry, parts.length) ? new Merged(mesh, material) : null;
    this.batches.push({ mesh, merged, parts, mounts: packed(parts) });
    (isDecoration ? this.decorations : this.group).add(merged?.mesh ?? mesh);
  }

  setPoses({ positions, orientations }: Poses): void {
    for (const { mesh, merged, parts, mounts } of this.batches) {
      const matrices = mesh.instanceMatrix.array;
      for (let i = 0; i < parts.length; ++i) {
        const { link, scale } = parts[i];
        place(this.pose, positions, orientations, link, mounts, 7 * i);
        writeMatrix(matrices, 16 * i, this.pose, scale[0], scale[1], scale[2]);
      }
      mesh.instanceMatrix.needsUpdate = true;
      merged?.matricesChange();
    }
  }

  /** The nearest link under a ray, and where it is hit. */
  pick(ray: three.Raycaster): { link: number; point: three.Vector3 } | null {
    const meshes = this.batches.map((batch) => batch.mesh);
    for (const mesh of meshes) mesh.boundingSphere = null; // of another frame
    const hit = ray.intersectObjects(meshes, false)[0];
    if (!hit || hit.instanceId === undefined) return null;
    const batch = this.batches.find(({ mesh }) => mesh === hit.object);
    return batch ? { link: batch.parts[hit.instanceId].link, point: hit.point } : null;
  }
}
