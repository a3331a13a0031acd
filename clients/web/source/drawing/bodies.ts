// SPDX-License-Identifier: MIT
// All links: one draw call per shape and detail, with the copies that are in view.
import * as three from "three";
import type { Poses, World } from "../model/messages";
import { packed, place } from "../model/pose";
import { addEdges, Batch } from "./batch";
import { Detail, detailOf, isInside, ofGraphicsProcessor, ofPictureAtRest, ofProcessor, sizeOnScreen } from "./detail";
import { roundness } from "./quality";
import { boundsOf, isRound, makeGeometry, partsOf, type Part } from "./shapes";

const mostWhole = 1024; // copies of a shape with all sides: more don't fit on a screen in this size
const fewSides = 8; // of round shapes that are not whole
const shadowRoom = 3; // times its size: what is out of view so far may cast a shadow into it

/** Parts of a link: from `first` on, its own shape first. */
interface Body { link: number; first: number; end: number; radius: number }

/** What draws a part, by detail; null: nothing. */
interface Drawing { batches: (Batch | null)[]; color: Float32Array }

function bodiesOf(parts: Part[], world: World): Body[] {
  const bodies: Body[] = [];
  parts.forEach((part, index) => {
    let body = bodies[bodies.length - 1];
    if (body?.link !== part.link) {
      body = { link: part.link, first: index, end: index, radius: 0.5 * Math.hypot(...boundsOf(part, world.hulls).size) };
      bodies.push(body);
    }
    body.end = index + 1;
  });
  return bodies;
}

export class Bodies {
  readonly group = new three.Group();
  readonly decorations = new three.Group(); // what the world does not have
  private batches = new Map<string, Batch>(); // by shape, detail, and whether it is a decoration
  private parts: Part[] = [];
  private bodies: Body[] = [];
  private drawings: Drawing[] = []; // of parts
  private mounts = new Float64Array(0);
  private boxMounts = new Float64Array(0); // of the boxes instead of parts
  private boxSizes: number[][] = [];
  private readonly pose = new Float64Array(7);
  private readonly planes = new Float64Array(24);
  private around = 0; // pieces of round shapes
  details = new Uint8Array(0); // of entities, as they are drawn: that of the largest link; none: out of view
  private unseen = new Uint8Array(0); // details of entities whose links are out of view; what has no body is always there
  private entities: number[] = []; // of links

  /** @param isSlow  drawn by the processor: links are merged meshes, as far as they fit, and have less detail */
  constructor(private readonly isSlow: boolean) { this.group.add(this.decorations); }

  /** @param triangles  of all round shapes, about; @param colorOf  of a part, sRGB */
  setWorld(world: World, triangles: number, colorOf: (part: Part) => number): void {
    for (const batch of this.batches.values()) batch.dispose();
    this.batches.clear();
    this.parts = partsOf(world);
    this.bodies = bodiesOf(this.parts, world);
    this.entities = world.links.map(({ entity }) => entity);
    const withBody = new Set(this.bodies.map(({ link }) => this.entities[link]));
    this.unseen = Uint8Array.from(world.entities, ({ removed }, i) => (removed || withBody.has(i) ? Detail.none : Detail.whole));
    this.details = this.unseen.slice();
    this.around = this.aroundOf(triangles);
    this.mounts = packed(this.parts);
    const boxes = this.parts.map((part) => boundsOf(part, world.hulls));
    this.boxMounts = packed(boxes.map(({ foot }, i) => ({ position: foot, orientation: this.parts[i].orientation })));
    this.boxSizes = boxes.map(({ size }) => size);
    const counts = new Map<string, number>();
    for (const part of this.parts) for (const key of this.keysOf(part)) if (key) counts.set(key, (counts.get(key) ?? 0) + 1);
    for (const [key, count] of counts) this.addBatch(key, count, world);
    this.drawings = this.parts.map((part) => ({
      batches: this.keysOf(part).map((key) => (key ? this.batches.get(key)! : null)), color: new Float32Array(3) }));
    this.paint(colorOf);
  }

  /** Height above its origin at which a text hides no part of an entity that is seen from a slope [m]. */
  heightOf(entity: number): number {
    let height = 0.02, reach = 0;
    for (const { link, first, end } of this.bodies) {
      if (this.entities[link] !== entity) continue;
      for (let i = first; i < end; ++i) {
        height = Math.max(height, this.parts[i].position[2] + this.boxSizes[i][2]);
        reach = Math.max(reach, this.boxSizes[i][0], this.boxSizes[i][1]);
      }
    }
    return height + 0.5 * reach;
  }

  /** Colours all parts. */
  paint(colorOf: (part: Part) => number): void {
    const color = new three.Color();
    this.parts.forEach((part, i) => color.set(colorOf(part)).toArray(this.drawings[i].color));
  }

  /** Keys of batches by detail: round shapes have few sides in the middle, and the boxes of links stay at the end. */
  private keysOf(part: Part): (string | null)[] {
    const key = (shape: string, detail: Detail): string => `${shape}|${detail}|${part.isDecoration ? "decoration" : ""}`;
    const { shape } = part;
    const plain = part.isSmall ? null : key(shape, isRound(shape) ? Detail.plain : Detail.whole);
    return [part.isDecoration ? null : key("box", Detail.box), plain, key(shape, Detail.whole)];
  }

  private aroundOf(triangles: number): number {
    return roundness(Math.min(this.parts.filter(({ shape }) => isRound(shape)).length, mostWhole), triangles);
  }

  private addBatch(key: string, count: number, world: World): void {
    const [shape, detail, decoration] = key.split("|");
    const isWhole = Number(detail) === Detail.whole;
    const material = new three.MeshLambertMaterial();
    if (shape === "box" && isWhole) addEdges(material);
    const room = isWhole && isRound(shape) ? Math.min(count, mostWhole) : count;
    const batch = new Batch(makeGeometry(shape, world.hulls, isWhole ? this.around : fewSides), material, room, this.isSlow);
    this.batches.set(key, batch);
    (decoration ? this.decorations : this.group).add(batch.object);
  }

  /** Draws round shapes with about so many triangles from now on; true if that differs. */
  setDetail(world: World, triangles: number): boolean {
    const around = this.aroundOf(triangles);
    if (around === this.around) return false;
    this.around = around;
    for (const [key, batch] of this.batches) {
      const [shape, detail] = key.split("|");
      if (isRound(shape) && Number(detail) === Detail.whole) batch.setGeometry(makeGeometry(shape, world.hulls, around));
    }
    return true;
  }

  /**
   * Chooses what is drawn, and how much of it.
   * @param height  of the picture [px], @param isFine  for a picture that stays
   */
  setPoses(poses: Poses, camera: three.PerspectiveCamera, height: number, isFine: boolean): void {
    const { planes, pose } = this;
    const { positions, orientations } = poses;
    camera.updateMatrixWorld();
    const frustum = new three.Frustum().setFromProjectionMatrix(
      new three.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    frustum.planes.forEach(({ normal, constant }, i) => planes.set([normal.x, normal.y, normal.z, constant], 4 * i));
    const view = camera.matrixWorldInverse.elements;
    const scale = 0.5 * height * camera.projectionMatrix.elements[5];
    const thresholds = isFine ? ofPictureAtRest : this.isSlow ? ofProcessor : ofGraphicsProcessor;
    for (const batch of this.batches.values()) batch.begin();
    this.details.set(this.unseen);
    for (const body of this.bodies) {
      place(pose, positions, orientations, body.link, this.mounts, 7 * body.first);
      const [x, y, z] = pose;
      if (!isInside(planes, x, y, z, shadowRoom * body.radius)) continue;
      const depth = -(view[2] * x + view[6] * y + view[10] * z + view[14]);
      const detail = detailOf(sizeOnScreen(body.radius, depth, scale), thresholds);
      const entity = this.entities[body.link];
      if (this.details[entity] === Detail.none || detail > this.details[entity]) this.details[entity] = detail;
      for (let i = body.first; i < body.end; ++i) this.addPart(i, detail, poses);
    }
    for (const batch of this.batches.values()) batch.end();
  }

  private addPart(i: number, detail: Detail, { positions, orientations }: Poses): void {
    const { pose } = this;
    const { batches, color } = this.drawings[i];
    const { link, scale } = this.parts[i];
    let batch = batches[detail];
    if (!batch) return;
    if (batch.isFull) batch = batches[Detail.plain] ?? batch;
    if (detail === Detail.box) {
      place(pose, positions, orientations, link, this.boxMounts, 7 * i);
      const size = this.boxSizes[i];
      return batch.add(i, pose, size[0], size[1], size[2], color, 0);
    }
    place(pose, positions, orientations, link, this.mounts, 7 * i);
    batch.add(i, pose, scale[0], scale[1], scale[2], color, 0);
  }

  /** The nearest link under a ray, and where it is hit. */
  pick(ray: three.Raycaster): { link: number; point: three.Vector3 } | null {
    const batches = [...this.batches.values()].filter(({ mesh }) => mesh.visible);
    const hit = ray.intersectObjects(batches.map(({ mesh }) => mesh), false)[0];
    const batch = batches.find(({ mesh }) => mesh === hit?.object);
    if (!hit || hit.instanceId === undefined || !batch) return null;
    return { link: this.parts[batch.parts[hit.instanceId]].link, point: hit.point };
  }
}
