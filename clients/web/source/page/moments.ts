// SPDX-License-Identifier: MIT
// Moments: the tick of the address at which the page is opened, and bookmarks.
import type { Settings } from "../model/settings";
import type { Frames, Mark } from "../model/timeline";

export class Moments {
  private places = new Map<number, number>(); // of bookmarks: frames by ticks
  private wanted: number | null; // the tick to show

  constructor(private readonly settings: Settings) { this.wanted = settings.tick; }

  /** Shows the settings' tick as soon as it is there. */
  restart(): void { this.wanted = this.settings.tick; }
  get isWaiting(): boolean { return this.wanted !== null; }

  /** Another source is shown: its ticks are others. */
  forget(): void { this.places.clear(); }

  /**
   * Finds the frames of bookmarks, and of the tick that is wanted.
   * @param isGrowing  the newest frame is that of a running world, which would go on if it was shown
   * @return the frame to show now, or why it can't be shown
   */
  find(frames: Frames, isGrowing: boolean): { sequence: number } | { fault: string } | null {
    for (const tick of this.settings.bookmarks) {
      const place = this.places.has(tick) ? null : frames.sequenceOf(tick);
      if (place !== null) this.places.set(tick, place);
    }
    const tick = this.wanted;
    if (tick === null || frames.length === 0) return null;
    const sequence = frames.sequenceOf(tick);
    if (isGrowing && sequence === frames.last) return null; // time can stand there with the next one
    const oldest = frames.tickOf(frames.first), newest = frames.tickOf(frames.last);
    if (sequence === null && (oldest === null || newest === null || newest < tick)) return null; // it comes
    this.wanted = null;
    return sequence !== null ? { sequence }
      : { fault: `Tick ${tick} was before this page was opened, at tick ${oldest}: only a recording (--record) has it.` };
  }

  get bookmarks(): Mark[] {
    return this.settings.bookmarks.flatMap((tick): Mark[] => {
      const sequence = this.places.get(tick);
      return sequence === undefined ? [] : [{ sequence, kind: "bookmark", text: `bookmark at tick ${tick}` }];
    });
  }

  /** Adds a bookmark, or removes that of the tick. */
  toggle(tick: number, sequence: number): void {
    const { settings } = this;
    const without = settings.bookmarks.filter((other) => this.places.get(other) !== sequence && other !== tick);
    const isNew = without.length === settings.bookmarks.length;
    settings.bookmarks = isNew ? [...without, tick].sort((a, b) => a - b) : without;
    if (isNew) this.places.set(tick, sequence);
    else this.places.delete(tick);
  }
}
