// SPDX-License-Identifier: MIT
// Matrices of instances, written where they are needed.

/**
 * The matrix of an instance, column by column.
 * @param to  from `at` on; its last row is written by others
 * @param pose  position, then orientation w, x, y, z; @param sx, sy, sz  scales along its axes
 */
export function writeMatrix(to: { [i: number]: number }, at: number, pose: Float64Array, sx: number, sy: number, sz: number): void {
  const w = pose[3], x = pose[4], y = pose[5], z = pose[6];
  to[at] = (1 - 2 * (y * y + z * z)) * sx;
  to[at + 1] = 2 * (x * y + w * z) * sx;
  to[at + 2] = 2 * (x * z - w * y) * sx;
  to[at + 4] = 2 * (x * y - w * z) * sy;
  to[at + 5] = (1 - 2 * (x * x + z * z)) * sy;
  to[at + 6] = 2 * (y * z + w * x) * sy;
  to[at + 8] = 2 * (x * z + w * y) * sz;
  to[at + 9] = 2 * (y * z - w * x) * sz;
  to[at + 10] = (1 - 2 * (x * x + y * y)) * sz;
  to[at + 12] = pose[0];
  to[at + 13] = pose[1];
  to[at + 14] = pose[2];
  to[at + 15] = 1;
}
