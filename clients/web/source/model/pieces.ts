// SPDX-License-Identifier: MIT
// Work that takes long, in pieces between which the page can draw.
const longest = 25; // [ms]

export class Pieces {
  private begin = performance.now();

  /** Waits if the present piece took long enough. */
  async next(): Promise<void> {
    if (performance.now() - this.begin < longest) return;
    await new Promise((resolve) => setTimeout(resolve));
    this.begin = performance.now();
  }
}
