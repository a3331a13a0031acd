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
