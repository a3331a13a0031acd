// SPDX-License-Identifier: MIT
// Motion between ticks: what is drawn goes from where it was drawn last to the newest tick, in the time that ticks take, so
// that it is late by one tick at most.
import type { Poses } from "./messages";
import { turn } from "./pose";

const smoothing = 0.3; // weight of the newest time between ticks
const mostGap = 3; // mean times between ticks: a longer one was a pause

export class Motion {
  isOn = true;
  private from: { positions: Float32Array; orientations: Float32Array } = { positions: new Float32Array(0), orientations: new Float32Array(0) };
  private between: Poses | null = null; // what is drawn on the way; its arrays are used again
  private target: Poses | null = null;
  private begin = 0; // [s]
  private duration = 0; // [s]; 0: it has arrived
  private came = -Infinity; // when the newest tick came [s]
  private gap = 0; // mean time between ticks [s]

  /** Poses that are drawn now; null: nothing. */
  get shown(): Poses | null { return this.duration > 0 ? this.between : this.target; }
  get isMoving(): boolean { return this.duration > 0; }

  forget(): void {
    this.target = this.between = null;
    this.duration = this.gap = 0;
    this.came = -Infinity;
  }

  /**
   * A tick came.
   * @param isNext  it follows on the one before; otherwise the picture jumps to it
   * @param longest  time that the way may take [s], @param now  wall time [s]
   */
  take(poses: Poses, isNext: boolean, longest: number, now: number): void {
    this.go(now);
    const before = this.shown;
    const gap = Math.min(now - this.came, longest);
    if (this.gap > 0) this.gap = Math.min(this.gap + smoothing * (Math.min(gap, mostGap * this.gap) - this.gap), longest);
    else if (this.came > -Infinity) this.gap = gap;
    this.came = now;
    this.target = poses;
    this.duration = 0;
    if (!this.isOn || !isNext || !before || before.positions.length !== poses.positions.length) return;
    this.from = { positions: Float32Array.from(before.positions), orientations: Float32Array.from(before.orientations) };
    this.between = { ...poses, positions: new Float32Array(poses.positions.length), orientations: new Float32Array(poses.orientations.length) };
    this.begin = now;
    this.duration = this.gap;
    this.go(now);
  }

  /** Moves on; false if nothing moved. */
  go(now: number): boolean {
    const { target, between, from } = this;
    if (this.duration <= 0 || !target || !between) return false;
    const part = this.isOn ? (now - this.begin) / this.duration : 1;
    if (part >= 1) {
      this.duration = 0;
      return true;
    }
    const positions = between.positions as Float32Array, orientations = between.orientations as Float32Array;
    for (let i = 0; i < positions.length; ++i) positions[i] = from.positions[i] + part * (target.positions[i] - from.positions[i]);
    for (let i = 0; i < orientations.length; i += 4) turn(orientations, from.orientations, target.orientations, i, part);
    return true;
  }
}
