// SPDX-License-Identifier: MIT
// A message that stays encoded until it is read.
import type { Decoder } from "./decode";
import type { Message, Value } from "./source";

const mostDecoded = 24; // messages
const mostBytes = 128 * 1024 * 1024; // of them, encoded
const decoded = new Map<Held, Value>(); // the newest: what is drawn is read at each frame of the screen
let bytes = 0;

export class Held implements Message {
  /** @param value  what it says, if that is known. @throws Unreadable if it is too long, or damaged */
  constructor(readonly topic: string, readonly timeNs: bigint, private readonly data: Uint8Array,
              private readonly decoder: Decoder, value?: Value) {
    if (value) this.keep(value);
    else this.read();
  }
  get bytes(): number { return this.data.byteLength; }
  read<T = Value>(): T {
    let value = decoded.get(this);
    if (!value) {
      value = this.decoder(this.data);
      this.keep(value);
    }
    return value as T;
  }
  private keep(value: Value): void {
    decoded.set(this, value);
    bytes += this.bytes;
    for (const old of decoded.keys()) {
      if (old === this || (decoded.size <= mostDecoded && bytes <= mostBytes)) break;
      decoded.delete(old);
      bytes -= old.bytes;
    }
  }
}
