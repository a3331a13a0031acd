// A message that stays encoded until it is read.
import type { Decoder } from "./decode";
import type { Message, Value } from "./source";

const mostDecoded = 24; // messages
const mostMemory = 512 * 1024 * 1024; // of them, as it is counted [bytes]
const decoded = new Map<Held, Value>(); // the newest: what is drawn is read at each frame of the screen
let memory = 0;

export class Held implements Message {
  private readonly memory: number;

  /** @throws Unreadable if it would take too much memory, or is damaged */
  constructor(readonly topic: string, readonly timeNs: bigint, private readonly data: Uint8Array,
              private readonly decoder: Decoder) { this.memory = decoder.weigh(data); }
  get bytes(): number { return this.data.byteLength; }
  read<T = Value>(): T {
    let value = decoded.get(this);
    if (!value) {
      value = this.decoder.decode(this.data);
      decoded.set(this, value);
      memory += this.memory;
      for (const old of decoded.keys()) {
        if (old === this || (decoded.size <= mostDecoded && memory <= mostMemory)) break;
        decoded.delete(old);
        memory -= old.memory;
      }
    }
    return value as T;
  }
}
