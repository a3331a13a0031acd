// SPDX-License-Identifier: MIT
// Poses: positions [m] and Hamilton quaternions w, x, y, z, as in docs/conventions.md.
import type { Floats } from "./messages";

export type Vector = [number, number, number];
export type Quaternion = [number, number, number, number];
export interface Pose { position: Vector; orientation: Quaternion }

export function rotate(q: Floats, v: Floats): Vector {
  const [w, x, y, z] = [q[0], q[1], q[2], q[3]];
  const tx = 2 * (y * v[2] - z * v[1]);
  const ty = 2 * (z * v[0] - x * v[2]);
  const tz = 2 * (x * v[1] - y * v[0]);
  return [v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz,
          v[2] + w * tz + x * ty - y * tx];
}

export function multiply(a: Floats, b: Floats): Quaternion {
  return [a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]];
}

/** X_AC of X_AB and X_BC. */
export function compose(a: Pose, b: { position: Floats; orientation: Floats }): Pose {
  const p = rotate(a.orientation, b.position);
  return { position: [a.position[0] + p[0], a.position[1] + p[1], a.position[2] + p[2]],
           orientation: multiply(a.orientation, b.orientation) };
}

/** X_WL of a link. */
export function poseAt(positions: Floats, orientations: Floats, link: number): Pose {
  const p = 3 * link, q = 4 * link;
  return { position: [positions[p], positions[p + 1], positions[p + 2]],
           orientation: [orientations[q], orientations[q + 1], orientations[q + 2], orientations[q + 3]] };
}

/** A point of frame B in frame A. */
export function transform(pose: Pose, point: Floats): Vector {
  const p = rotate(pose.orientation, point);
  return [pose.position[0] + p[0], pose.position[1] + p[1], pose.position[2] + p[2]];
}

/**
 * X_WM of what is mounted on a link, into `to`: position, then orientation. For what is done for thousands of links at each
 * frame: nothing is allocated.
 * @param mount  position and orientation in the frame of the link, from `at` on in the same order
 */
export function place(to: Float64Array, positions: Floats, orientations: Floats, link: number, mount: Float64Array, at: number): void {
  const p = 3 * link, q = 4 * link;
  const w = orientations[q], x = orientations[q + 1], y = orientations[q + 2], z = orientations[q + 3];
  const vx = mount[at], vy = mount[at + 1], vz = mount[at + 2];
  const tx = 2 * (y * vz - z * vy), ty = 2 * (z * vx - x * vz), tz = 2 * (x * vy - y * vx);
  to[0] = positions[p] + vx + w * tx + y * tz - z * ty;
  to[1] = positions[p + 1] + vy + w * ty + z * tx - x * tz;
  to[2] = positions[p + 2] + vz + w * tz + x * ty - y * tx;
  const mw = mount[at + 3], mx = mount[at + 4], my = mount[at + 5], mz = mount[at + 6];
  to[3] = w * mw - x * mx - y * my - z * mz;
  to[4] = w * mx + x * mw + y * mz - z * my;
  to[5] = w * my - x * mz + y * mw + z * mx;
  to[6] = w * mz + x * my - y * mx + z * mw;
}

/** Half of the sides, along the world's axes, of the box around a box of these half sides. */
export function halfExtents(q: Floats, half: Floats): Vector {
  const [w, x, y, z] = [q[0], q[1], q[2], q[3]];
  const row = (a: number, b: number, c: number): number => Math.abs(a) * half[0] + Math.abs(b) * half[1] + Math.abs(c) * half[2];
  return [row(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
          row(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
          row(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))];
}

/**
 * Orientations between two, along the shortest turn: slerp.
 * @param to  from `at` on, where the two have theirs; @param part  0: that of `a`, 1: that of `b`
 */
export function turn(to: Float32Array, a: Floats, b: Floats, at: number, part: number): void {
  let dot = 0;
  for (let k = 0; k < 4; ++k) dot += a[at + k] * b[at + k];
  const sign = dot < 0 ? -1 : 1; // a quaternion and its negative are the same orientation
  const angle = Math.acos(Math.min(1, dot * sign)), sine = Math.sin(angle);
  const [p, q] = sine < 1e-3 ? [1 - part, part] : [Math.sin((1 - part) * angle) / sine, Math.sin(part * angle) / sine];
  for (let k = 0; k < 4; ++k) to[at + k] = p * a[at + k] + sign * q * b[at + k];
}

/** Mounts as place() takes them, seven numbers each. */
export function packed(mounts: { position: Floats; orientation: Floats }[]): Float64Array<ArrayBuffer> {
  const numbers = new Float64Array(7 * mounts.length);
  mounts.forEach(({ position, orientation }, i) => {
    for (let k = 0; k < 3; ++k) numbers[7 * i + k] = position[k];
    for (let k = 0; k < 4; ++k) numbers[7 * i + 3 + k] = orientation[k];
  });
  return numbers;
}
