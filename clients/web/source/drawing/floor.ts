// SPDX-License-Identifier: MIT
// The coloured floor: the scene's picture over the arena, and what directors painted over it.
import * as three from "three";
import type { Floats, Poses, World } from "../model/messages";

const mostPixels = 1024; // a side
const numbersPerRegion = 6; // see Poses.floor_paints

function isSame(a: ArrayLike<number>, b: ArrayLike<number>): boolean {
  if (a.length !== b.length) return false;
  for (let i = 0; i < a.length; ++i) if (a[i] !== b[i]) return false;
  return true;
}

/** A region as a canvas draws it: y grows downwards from the arena's top. */
export interface Region { x: number; y: number; halfX: number; halfY: number; isDisc: boolean; color: string }

/** @param scale  pixels per metre, along x and y */
export function regionsOf(paints: Floats, low: [number, number], high: [number, number], scale: [number, number]): Region[] {
  const regions: Region[] = [];
  for (let i = 0; i + numbersPerRegion <= paints.length; i += numbersPerRegion) {
    regions.push({
      x: (paints[i]! - low[0]) * scale[0], y: (high[1] - paints[i + 1]!) * scale[1],
      halfX: paints[i + 2]! * scale[0], halfY: paints[i + 3]! * scale[1],
      isDisc: paints[i + 4] === 1, color: `#${(paints[i + 5]! & 0xffffff).toString(16).padStart(6, "0")}`,
    });
  }
  return regions;
}

export class Floor {
  readonly group = new three.Group();
  private readonly canvas = document.createElement("canvas");
  private texture: three.CanvasTexture | null = null;
  private mesh: three.Mesh<three.PlaneGeometry, three.MeshLambertMaterial> | null = null;
  private picture: ImageBitmap | null = null;
  private paints: Floats = [];
  private world: World | null = null;

  /** @param changes  is called when the picture has been read */
  constructor(private readonly changes: () => void) {}

  setWorld(world: World): void {
    const file = world.floorPicture ?? new Uint8Array(0); // older recordings have none
    const before = this.world;
    this.world = world;
    const isKnown = before && isSame(before.floorPicture ?? [], file)
        && isSame(before.arenaSize, world.arenaSize) && isSame(before.arenaCenter, world.arenaCenter);
    if (isKnown) return; // only its population changed
    this.picture = null;
    this.paints = [];
    this.remove();
    if (file.length === 0) return;
    createImageBitmap(new Blob([file as BlobPart], { type: "image/png" })).then((picture) => {
      if (!isSame(this.world?.floorPicture ?? [], file)) return;
      this.picture = picture;
      this.draw();
      this.changes();
    }, () => undefined); // a picture that can't be read is none
  }

  setPoses(poses: Poses): void {
    const paints = poses.floorPaints ?? []; // older recordings have none
    if (isSame(paints, this.paints)) return;
    this.paints = Array.from(paints);
    this.draw();
  }

  private remove(): void {
    if (!this.mesh) return;
    this.group.remove(this.mesh);
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.texture?.dispose();
    this.mesh = this.texture = null;
  }

  private draw(): void {
    if (!this.world || (!this.picture && this.paints.length === 0)) return this.remove();
    const size: [number, number] = [this.world.arenaSize[0] || 1, this.world.arenaSize[1] || 1];
    const center: [number, number] = [this.world.arenaCenter[0] || 0, this.world.arenaCenter[1] || 0];
    if (!this.mesh) this.add(size, center);
    const { width, height } = this.canvas;
    const context = this.canvas.getContext("2d")!;
    context.clearRect(0, 0, width, height);
    context.imageSmoothingEnabled = false;
    if (this.picture) context.drawImage(this.picture, 0, 0, width, height);
    const low: [number, number] = [center[0] - size[0] / 2, center[1] - size[1] / 2];
    const high: [number, number] = [center[0] + size[0] / 2, center[1] + size[1] / 2];
    for (const region of regionsOf(this.paints, low, high, [width / size[0], height / size[1]])) {
      context.fillStyle = region.color;
      context.beginPath();
      if (region.isDisc) context.ellipse(region.x, region.y, region.halfX, region.halfY, 0, 0, 2 * Math.PI);
      else context.rect(region.x - region.halfX, region.y - region.halfY, 2 * region.halfX, 2 * region.halfY);
      context.fill();
    }
    this.texture!.needsUpdate = true;
  }

  /** In front of the squares of the stage, where it is not transparent. */
  private add([x, y]: [number, number], [cx, cy]: [number, number]): void {
    const longest = Math.max(x, y);
    this.canvas.width = Math.max(1, Math.round(mostPixels * x / longest));
    this.canvas.height = Math.max(1, Math.round(mostPixels * y / longest));
    this.texture = new three.CanvasTexture(this.canvas);
    this.texture.colorSpace = three.SRGBColorSpace;
    this.texture.magFilter = three.NearestFilter;
    const material = new three.MeshLambertMaterial({
      map: this.texture, transparent: true, polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -4, depthWrite: false,
    });
    this.mesh = new three.Mesh(new three.PlaneGeometry(x, y), material);
    this.mesh.position.set(cx, cy, 0);
    this.mesh.receiveShadow = true;
    this.group.add(this.mesh);
  }
}
