// SPDX-License-Identifier: MIT
// Lines of the log: the newest of them, and how many older ones are not kept.
import type { Log } from "./messages";
import { kept } from "./texts";

export interface LogEntry { sequence: number; seconds: number; name: string; level: number; text: string; length: number }

const mostName = 200; // characters of who logged a line
export const mostLines = 5000;
const lostAtOnce = 1000;

export class LogLines {
  readonly entries: LogEntry[] = [];
  lost = 0; // lines, the oldest

  /** @param sequence  of the frame, @param seconds  simulated */
  add({ level, message: text, name }: Log, sequence: number, seconds: number): void {
    this.entries.push({ sequence, seconds, name: kept(name, mostName), level, text: kept(text), length: text.length });
    if (this.entries.length <= mostLines) return;
    this.entries.splice(0, lostAtOnce);
    this.lost += lostAtOnce;
  }
}
