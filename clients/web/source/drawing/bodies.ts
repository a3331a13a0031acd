// All links as instanced meshes: one draw call per shape.
import * as three from "three";
import type { Poses, World } from "../model/messages";
import { multiply, rotate } from "../model/pose";
import { roundness } from "./quality";
import { isRound, makeGeometry, partsOf, type Part } from "./shapes";

interface Batch { mesh: three.InstancedMesh; parts: Part[] }

/** Columns of a matrix from a rotation, scale and position. */
function writeMatrix(to: ArrayLike<number> & { [i: number]: number }, at: number, q: ArrayLike<number>,
                     s: ArrayLike<number>, p: ArrayLike<number>): void {
  const w = q[0], x = q[1], y = q[2], z = q[3];
  to[at] = (1 - 2 * (y * y + z * z)) * s[0];
  to[at + 1] = 2 * (x * y + w * z) * s[0];
  to[at + 2] = 2 * (x * z - w * y) * s[0];
  to[at + 4] = 2 * (x * y - w * z) * s[1];
  to[at + 5] = (1 - 2 * (x * x + z * z)) * s[1];
  to[at + 6] = 2 * (y * z + w * x) * s[1];
  to[at + 8] = 2 * (x * z + w * y) * s[2];
  to[at + 9] = 2 * (y * z - w * x) * s[2];
  to[at + 10] = (1 - 2 * (x * x + y * y)) * s[2];
  to[at + 12] = p[0];
  to[at + 13] = p[1];
  to[at + 14] = p[2];
  to[at + 15] = 1;
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
  private batches: Batch[] = [];
  private batchOfLink = new Map<number, { batch: number; index: number }[]>();
  private highlighted: number[] = [];
  private around = 0; // pieces of round shapes

  /** @param triangles  of all round shapes, about */
  setWorld(world: World, triangles: number): void {
    for (const { mesh } of this.batches) {
      this.group.remove(mesh);
      mesh.geometry.dispose();
      (mesh.material as three.Material).dispose();
      mesh.dispose();
    }
    const byShape = new Map<string, Part[]>();
    const all = partsOf(world);
    this.around = roundness(all.filter(({ shape }) => isRound(shape)).length, triangles);
    for (const part of all) {
      const list = byShape.get(part.shape);
      if (list) list.push(part);
      else byShape.set(part.shape, [part]);
    }
    this.batches = [];
    this.batchOfLink.clear();
    for (const [shape, parts] of byShape) this.addBatch(shape, parts, world);
    this.highlight(this.highlighted);
  }

  /** Draws round shapes with about so many triangles from now on; true if that differs. */
  setDetail(world: World, triangles: number): boolean {
    const round = this.batches.filter(({ parts }) => isRound(parts[0].shape));
    const around = roundness(round.reduce((sum, { parts }) => sum + parts.length, 0), triangles);
    if (around === this.around) return false;
    this.around = around;
    for (const { mesh, parts } of round) {
      mesh.geometry.dispose();
      mesh.geometry = makeGeometry(parts[0].shape, world.hulls, around);
    }
    return true;
  }

  private addBatch(shape: string, parts: Part[], world: World): void {
    const material = new three.MeshLambertMaterial();
    if (shape === "box") addEdges(material);
    const mesh = new three.InstancedMesh(makeGeometry(shape, world.hulls, this.around), material, parts.length);
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.frustumCulled = false;
    mesh.instanceMatrix.setUsage(three.DynamicDrawUsage);
    const color = new three.Color();
    parts.forEach((part, index) => {
      mesh.setColorAt(index, color.set(part.color));
      const list = this.batchOfLink.get(part.link) ?? [];
      list.push({ batch: this.batches.length, index });
      this.batchOfLink.set(part.link, list);
    });
    this.batches.push({ mesh, parts });
    this.group.add(mesh);
  }

  setPoses(poses: Poses): void {
    const { positions, orientations } = poses;
    const q = [1, 0, 0, 0], p = [0, 0, 0];
    for (const { mesh, parts } of this.batches) {
      const matrix = mesh.instanceMatrix.array as Float32Array;
      parts.forEach((part, index) => {
        for (let i = 0; i < 4; ++i) q[i] = orientations[4 * part.link + i];
        for (let i = 0; i < 3; ++i) p[i] = positions[3 * part.link + i];
        const [x, y, z] = part.position;
        if (x === 0 && y === 0 && z === 0) {
          writeMatrix(matrix, 16 * index, q, part.scale, p);
          return;
        }
        const offset = rotate(q, part.position);
        writeMatrix(matrix, 16 * index, multiply(q, part.orientation), part.scale,
                    [p[0] + offset[0], p[1] + offset[1], p[2] + offset[2]]);
      });
      mesh.instanceMatrix.needsUpdate = true;
      mesh.boundingSphere = null; // of what is picked
    }
  }

  /** Tints links. */
  highlight(links: number[]): void {
    const color = new three.Color(), tint = new three.Color(0xff9d2e);
    for (const link of new Set([...this.highlighted, ...links])) {
      for (const { batch, index } of this.batchOfLink.get(link) ?? []) {
        const { mesh, parts } = this.batches[batch];
        color.set(parts[index].color);
        if (links.includes(link)) color.lerp(tint, 0.3);
        mesh.setColorAt(index, color);
        if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
      }
    }
    this.highlighted = links;
  }

  /** The nearest link under a ray, and where it is hit. */
  pick(ray: three.Raycaster): { link: number; point: three.Vector3 } | null {
    const meshes = this.batches.map((batch) => batch.mesh);
    const hit = ray.intersectObjects(meshes, false)[0];
    if (!hit || hit.instanceId === undefined) return null;
    const batch = this.batches.find(({ mesh }) => mesh === hit.object);
    return batch ? { link: batch.parts[hit.instanceId].link, point: hit.point } : null;
  }
}
