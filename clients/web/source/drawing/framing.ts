// SPDX-License-Identifier: MIT
// Framing: the box that is shown at first, and the place of the camera from which it is seen whole.
import type { Poses, World } from "../model/messages";
import { halfExtents, place, packed, rotate, type Quaternion, type Vector } from "../model/pose";
import { boundsOf, partsOf } from "./shapes";
import type { Look } from "./stage";

/** The way to the camera, of length one: in a tall picture from higher and along a side, which fills more of it. */
export function wayToCamera(aspect: number): Vector {
  const way: Vector = aspect < 0.9 ? [0.16, -0.75, 0.9] : [0.55, -0.75, 0.62];
  const length = Math.hypot(...way);
  return way.map((value) => value / length) as Vector;
}

export interface Box { low: Vector; high: Vector }

const margin = 0.95; // of half the picture
const wide = 3; // a floor that is larger than so many times what stands on it is not shown as a whole
const still = 0.02; // of its size; what changes less has settled
const stillFor = 0.5, longest = 20; // [s], simulated: what never rests does not settle

/** The box around entities; null: there are none. @param isWanted  by the number of an entity */
export function boxOf(world: World, poses: Poses, isWanted: (entity: number) => boolean): Box | null {
  const low: Vector = [Infinity, Infinity, Infinity], high: Vector = [-Infinity, -Infinity, -Infinity];
  const pose = new Float64Array(7);
  for (const part of partsOf(world)) {
    if (!isWanted(world.links[part.link].entity)) continue;
    const { size, foot } = boundsOf(part, world.hulls);
    place(pose, poses.positions, poses.orientations, part.link, packed([{ position: foot, orientation: part.orientation }]), 0);
    const orientation = Array.from(pose.subarray(3)) as Quaternion;
    const half = halfExtents(orientation, size.map((side) => side / 2));
    const up = rotate(orientation, [0, 0, size[2] / 2]);
    for (let i = 0; i < 3; ++i) {
      low[i] = Math.min(low[i], pose[i] + up[i] - half[i]);
      high[i] = Math.max(high[i], pose[i] + up[i] + half[i]);
    }
  }
  world.links.forEach(({ entity }, link) => { // things without body, too
    if (!isWanted(entity) || world.entities[entity].removed) return;
    for (let i = 0; i < 3; ++i) {
      low[i] = Math.min(low[i], poses.positions[3 * link + i]);
      high[i] = Math.max(high[i], poses.positions[3 * link + i]);
    }
  });
  return low.every(Number.isFinite) && high.every(Number.isFinite) ? { low, high } : null;
}

export function arenaOf({ arenaSize, arenaCenter }: World): Box {
  const [x, y] = [arenaSize[0] || 1, arenaSize[1] || 1], [cx, cy] = [arenaCenter[0] || 0, arenaCenter[1] || 0];
  return { low: [cx - x / 2, cy - y / 2, 0], high: [cx + x / 2, cy + y / 2, 0] };
}

/** Width of the strip of the scale that lies beside a floor [m]. */
export function scaleWidth(x: number, y: number): number { return 0.055 * Math.max(Math.min(x, y), 0.25 * Math.max(x, y)); }

/** A floor with the numbers beside it. */
function withScale({ low, high }: Box): Box {
  const width = scaleWidth(high[0] - low[0], high[1] - low[1]);
  return { low: [low[0] - 0.8 * width, low[1] - 1.2 * width, 0], high: [high[0] + 1.2 * width, high[1] + 1.3 * width, 0] };
}

/** The floor and what stands on it; of a floor that is far larger, the middle. */
export function firstBox(world: World, poses: Poses): Box {
  const arena = world.hasFloor ? withScale(arenaOf(world)) : arenaOf(world);
  const things = boxOf(world, poses, (entity) => !world.entities[entity].removed);
  if (!things) return arena;
  const reach = Math.max(things.high[0] - things.low[0], things.high[1] - things.low[1], things.high[2]);
  const isSmall = Math.max(arena.high[0] - arena.low[0], arena.high[1] - arena.low[1]) < wide * reach;
  const around = 0.4 * reach; // enough floor to see where things stand
  const low = [0, 1].map((i) => (world.hasFloor && isSmall ? Math.min(arena.low[i], things.low[i]) : things.low[i] - around));
  const high = [0, 1].map((i) => (world.hasFloor && isSmall ? Math.max(arena.high[i], things.high[i]) : things.high[i] + around));
  return { low: [low[0], low[1], world.hasFloor ? Math.min(0, things.low[2]) : things.low[2]], high: [high[0], high[1], things.high[2]] };
}

/**
 * The nearest camera that sees all of a box.
 * @param way  to the camera, of length one, not upright; @param fieldOfView  vertical [degrees], @param aspect  width by height
 */
export function lookAt({ low, high }: Box, way: Vector, fieldOfView: number, aspect: number): Look {
  const flat = Math.hypot(way[0], way[1]);
  const right: Vector = [-way[1] / flat, way[0] / flat, 0];
  const up: Vector = [-way[0] * way[2] / flat, -way[1] * way[2] / flat, flat];
  const tangents = [margin * aspect, margin].map((part) => part * Math.tan(fieldOfView * Math.PI / 360));
  const center = low.map((value, i) => (value + high[i]) / 2) as Vector;
  const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const corners = Array.from({ length: 8 }, (_, corner) =>
    center.map((middle, k) => ((corner >> k) & 1 ? high[k] : low[k]) - middle) as Vector);
  // A corner is seen where |along - shift| <= (distance - towards) * tangent.
  const seen = (axis: Vector, tangent: number): { shift: number; distance: number } => {
    const more = Math.max(...corners.map((to) => dot(to, axis) + dot(to, way) * tangent));
    const less = Math.max(...corners.map((to) => dot(to, way) * tangent - dot(to, axis)));
    return { shift: (more - less) / 2, distance: (more + less) / (2 * tangent) };
  };
  const axes = [right, up];
  const distance = Math.max(0.1, ...axes.map((axis, i) => seen(axis, tangents[i]).distance));
  // In the middle of the other side, too: as if the picture were no larger than the box there.
  const [x, y] = axes.map((axis, i) => {
    let [small, large] = [0, tangents[i]];
    for (let step = 0; step < 40; ++step) {
      const middle = (small + large) / 2;
      if (seen(axis, middle).distance > distance) small = middle;
      else large = middle;
    }
    return seen(axis, large).shift;
  });
  const eye = center.map((middle, k) => middle + right[k] * x + up[k] * y + way[k] * distance) as Vector;
  const away = way[2] > 0.1 ? (eye[2] - center[2]) / way[2] : distance; // it turns around what is in the middle
  return { eye, at: eye.map((value, k) => value - way[k] * away) as Vector, fieldOfView };
}

/** Tells once that what moves at first, as falling bodies do, has come to rest, or that the box around all of it has. */
export class Settling {
  private box: Box | null = null;
  private since = 0; // [s], simulated
  private began = NaN; // [s], simulated
  isOver = false;

  /** @param seconds  simulated; true: now it has settled, and did not at once */
  take(box: Box, seconds: number): boolean {
    if (this.isOver) return false;
    if (Number.isNaN(this.began)) this.began = seconds;
    if (seconds - this.began > longest) this.isOver = true;
    const { low, high } = this.box ?? box;
    const size = Math.hypot(...high.map((value, i) => value - low[i]));
    const change = Math.max(...low.map((value, i) => Math.max(Math.abs(value - box.low[i]), Math.abs(high[i] - box.high[i]))));
    if (!this.box || change > still * size || seconds < this.since) {
      this.box = box;
      this.since = seconds;
      return false;
    }
    this.isOver = seconds - this.since >= stillFor;
    return this.isOver;
  }
}
