// SPDX-License-Identifier: MIT
// What devices do, as lines: magnets' moments, frusta, rays, radio messages, contact forces, trails.
import * as three from "three";
import type { Camera, Contacts, Link, Marker, Mount, Poses, RadioTraffic, Rays, World } from "../model/messages";
import { compose, poseAt, transform, type Pose, type Vector } from "../model/pose";
import type { Lines } from "./lines";

function at(poses: Poses, mount: Mount, offset: Vector = [0, 0, 0]): Vector {
  return transform(compose(poseAt(poses.positions, poses.orientations, mount.link), mount), offset);
}

/** The largest extent [m]; NaN: not known. */
function extent(link: Link): number {
  return link.box ? Math.max(...Array.from(link.box.size)) : link.cylinder ? Math.max(2 * link.cylinder.radius, link.cylinder.height)
    : link.sphere ? 2 * link.sphere.radius : link.capsule ? link.capsule.height : NaN;
}

/** The median extent of links that can move [m]: arrows should be about as long. */
export function typicalSize(world: World): number {
  const sizes = world.links.filter(({ entity }) => world.entities[entity]?.movable).map(extent);
  const known = sizes.filter((size) => size > 0).sort((a, b) => a - b);
  return known[Math.floor(known.length / 2)] ?? 0.1;
}

/** A ring around what is selected, at its foot. @param links  that are selected */
export function drawSelection(world: World, poses: Poses, links: number[], lines: Lines): void {
  const { positions } = poses;
  const center: Vector = [0, 0, Infinity];
  for (const link of links) {
    for (const axis of [0, 1]) center[axis] += positions[3 * link + axis] / links.length;
    center[2] = Math.min(center[2], positions[3 * link + 2] + 0.002);
  }
  let radius = 0.02;
  for (const link of links) {
    const away = Math.hypot(positions[3 * link] - center[0], positions[3 * link + 1] - center[1]);
    radius = Math.max(radius, away + 0.6 * (extent(world.links[link]) || 0));
  }
  const pieces = 48;
  const at = (i: number, r: number): Vector => {
    const angle = 2 * Math.PI * i / pieces;
    return [center[0] + r * Math.cos(angle), center[1] + r * Math.sin(angle), center[2]];
  };
  for (const r of [radius, 1.03 * radius]) for (let i = 0; i < pieces; ++i) lines.add(at(i, r), at(i + 1, r), 0xff9d2e);
}

/** Arrows along the moments; red with a current that adds, blue with one that opposes. */
export function drawMagnets(world: World, poses: Poses, longest: number, lines: Lines): void {
  let most = 1e-12;
  for (let i = 0; i < poses.magnetMoments.length; i += 3) {
    most = Math.max(most, Math.hypot(poses.magnetMoments[i], poses.magnetMoments[i + 1], poses.magnetMoments[i + 2]));
  }
  world.magnets.forEach((magnet, i) => {
    if (world.entities[magnet.entity]?.removed || poses.magnetMoments.length < 3 * i + 3) return;
    const link = poseAt(poses.positions, poses.orientations, magnet.mount.link);
    const moment = [0, 1, 2].map((k) => poses.magnetMoments[3 * i + k] / most * longest) as Vector;
    const [x, y, z] = transform({ position: [0, 0, 0], orientation: link.orientation }, moment);
    const way = new three.Vector3(x, y, z);
    const current = poses.magnetCurrents[i] ?? 0;
    const color = current > 0 ? 0xe0402c : current < 0 ? 0x2f74e0 : 0xa050c8;
    const start = new three.Vector3(...at(poses, magnet.mount)).addScaledVector(way, -0.5);
    if (way.length() > 1e-6) lines.arrow(start, way, color);
  });
}

/** Corners of the image at a depth [m], in the camera's frame, from top left clockwise. */
export function cornersAt(camera: Camera, depth: number): Vector[] {
  const [fx, fy] = [camera.focalLength[0], camera.focalLength[1]];
  const [cx, cy] = [camera.principalPoint[0], camera.principalPoint[1]];
  const corner = (u: number, v: number): Vector => [(u - cx) / fx * depth, (v - cy) / fy * depth, depth];
  return [corner(0, 0), corner(camera.width, 0), corner(camera.width, camera.height), corner(0, camera.height)];
}

export function drawFrusta(world: World, poses: Poses, lines: Lines): void {
  for (const camera of world.cameras) {
    if (world.entities[world.robots[camera.robot]?.entity]?.removed) continue;
    const near = cornersAt(camera, camera.near).map((corner) => at(poses, camera.mount, corner));
    const far = cornersAt(camera, camera.far).map((corner) => at(poses, camera.mount, corner));
    for (let i = 0; i < 4; ++i) {
      const next = (i + 1) % 4;
      lines.add(near[i], near[next], 0x2a9d8f, 0.9);
      lines.add(far[i], far[next], 0x2a9d8f, 0.35);
      lines.add(near[i], far[i], 0x2a9d8f, 0.9, 0.35);
    }
  }
}

export const rayColors = [0xe6a417, 0x8e5bd0, 0x3d8bfd, 0x2a9d8f]; // by kind

/** @param isWanted  by the number of a robot */
export function drawRays(rays: Rays, isWanted: (robot: number) => boolean, lines: Lines): void {
  for (let i = 0; i < rays.kinds.length; ++i) {
    if (!isWanted(rays.robots[i])) continue;
    const color = rays.hits[i] ? 0xe0402c : rayColors[rays.kinds[i]] ?? 0x888888;
    lines.add(rays.segments, rays.segments, color, 0.85, rays.hits[i] ? 0.85 : 0.25, 6 * i, 6 * i + 3);
  }
}

/** Arrows and rings that robots drew. @param originOf  X_WE of a robot's origin */
export function drawMarkers(markers: Marker[], originOf: (robot: number) => Pose | null, lines: Lines): void {
  const pieces = 32;
  for (const { robot, at, to, radius, color } of markers) {
    const origin = originOf(robot);
    if (!origin) continue;
    const place = (x: number, y: number, z: number): Vector => transform(origin, [x, y, z]);
    if (to.length === 3) {
      const start = new three.Vector3(...place(at[0], at[1], at[2]));
      const end = new three.Vector3(...place(to[0], to[1], to[2]));
      if (start.distanceTo(end) > 1e-6) lines.arrow(start, end.sub(start), color);
    }
    const onRing = (i: number): Vector => {
      const angle = 2 * Math.PI * i / pieces;
      return place(at[0] + radius * Math.cos(angle), at[1] + radius * Math.sin(angle), at[2]);
    };
    if (radius > 0) for (let i = 0; i < pieces; ++i) lines.add(onRing(i), onRing(i + 1), color);
  }
}

/** Arrows of force: of this length [m] for `reference` [N], and at most twice as long. */
export function drawContacts(contacts: Contacts, reference: number, arrow: number, lines: Lines): void {
  for (let i = 0; i < contacts.links.length / 2; ++i) {
    const k = 3 * i;
    const force = new three.Vector3(contacts.forces[k], contacts.forces[k + 1], contacts.forces[k + 2]);
    const start = new three.Vector3(contacts.points[k], contacts.points[k + 1], contacts.points[k + 2]);
    const length = arrow * Math.min(2, force.length() / reference);
    if (length > 1e-3 * arrow) lines.arrow(start, force.setLength(length), 0x1fa34a);
    for (const axis of [0, 1]) {
      const half: Vector = axis === 0 ? [0.05 * arrow, 0, 0] : [0, 0.05 * arrow, 0];
      lines.add([start.x - half[0], start.y - half[1], start.z], [start.x + half[0], start.y + half[1], start.z], 0x1fa34a);
    }
  }
}

interface Flash { from: Vector; to: Vector; color: number; end: number }

/** Messages fly from sender to receiver for a fraction of a second of wall time. */
export class RadioFlashes {
  private flashes: Flash[] = [];
  private readonly seconds = 0.45;
  get isActive(): boolean { return this.flashes.length > 0; }

  /** @param isWanted  by the number of a robot that sends or receives */
  add(world: World, poses: Poses, traffic: RadioTraffic, isWanted: (robot: number | undefined) => boolean, now: number): void {
    const end = now + this.seconds;
    type End = { mount: Mount; robot?: number } | undefined;
    const push = (from: End, to: End, color: number): void => {
      if (!from || !to || this.flashes.length >= 2000 || !(isWanted(from.robot) || isWanted(to.robot))) return;
      this.flashes.push({ from: at(poses, from.mount), to: at(poses, to.mount), color, end });
    };
    for (const { sender, receiver } of traffic.messages) push(world.radios[sender], world.radios[receiver], rayColors[1]);
    for (const { sender, receiver } of traffic.packets) {
      push(world.rangeAndBearing[sender], world.rangeAndBearing[receiver], rayColors[2]);
    }
  }

  draw(now: number, lines: Lines): void {
    this.flashes = this.flashes.filter(({ end }) => end > now);
    for (const { from, to, color, end } of this.flashes) {
      const part = 1 - (end - now) / this.seconds;
      const along = (t: number): Vector => from.map((value, i) => value + (to[i] - value) * t) as Vector;
      lines.add(from, to, color, 0.35 * (1 - part));
      lines.add(along(Math.max(0, part - 0.25)), along(part), color, 0.1, 1);
    }
  }
}

/** A line with an upright mark at both ends. */
export function drawRuler(from: Vector, to: Vector, lines: Lines): void {
  const color = 0xcc3311, mark = 0.04 * Math.hypot(...from.map((value, i) => to[i] - value));
  lines.add(from, to, color);
  for (const [x, y, z] of [from, to]) lines.add([x, y, z], [x, y, z + mark], color);
}

/** Paths of entities that were chosen. */
export function drawTrail(points: Vector[], color: number, lines: Lines): void {
  for (let i = 1; i < points.length; ++i) {
    lines.add(points[i - 1], points[i], color, i / points.length, (i + 1) / points.length);
  }
}
