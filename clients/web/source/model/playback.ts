// SPDX-License-Identifier: MIT
// Playing what the page has already: a recording, or the past of a live world.
import type { Frames } from "./timeline";

const fastest = 100; // times; "max" has no other meaning where nothing is computed

export class Playback {
  isPlaying = false;
  private factor = 1;
  private owedNs = 0; // simulated time that has passed and was not shown yet
  private before = 0; // wall time [s]

  get speed(): number { return this.factor; }
  /** @param factor  simulated seconds per second; 0: as fast as it goes */
  set speed(factor: number) { this.factor = factor > 0 ? Math.min(factor, fastest) : fastest; }

  start(): void {
    this.isPlaying = true;
    this.owedNs = this.before = 0;
  }

  /** The frame to show after the one at `sequence`. It waits for frames that are still being read.
      @param now  wall time [s] */
  advance(now: number, sequence: number, frames: Pick<Frames, "last" | "stepNs" | "at">): number {
    const passed = this.before === 0 ? 0 : Math.min(now - this.before, 0.25); // a hidden page stands
    this.before = now;
    if (!this.isPlaying) return sequence;
    this.owedNs += passed * this.factor * 1e9;
    while (sequence < frames.last) {
      const step = frames.stepNs(sequence);
      if (step === null || step > this.owedNs) break;
      if (frames.at(sequence + 1) === null) {
        this.owedNs = 0;
        break;
      }
      this.owedNs -= step;
      ++sequence;
    }
    return sequence;
  }
}
