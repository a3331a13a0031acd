// SPDX-License-Identifier: MIT
// No data: a page that was opened from the disk waits for a recording.
import type { Listener, Source, Value } from "./source";

export class NoSource implements Source {
  readonly isLive = false;
  readonly name = "no recording";

  /** @param text  what to do, for the user */
  constructor(private readonly text: string) {}
  start(listener: Listener): void {
    listener.status({ phase: "closed", text: this.text, mayControl: false, session: "" });
  }
  want(): void { /* nothing comes */ }
  call(): Promise<Value> { return Promise.reject(new Error("there is no server")); }
  setParameter(): void { /* there is none */ }
  close(): void { /* nothing is open */ }
}
