// A message that stays encoded until it is read.
import type { Decoder } from "./decode";
import type { Message, Value } from "./source";

const mostDecoded = 24;
const decoded = new Map<Message, Value>(); // the newest: what is drawn is read at each frame of the screen

export class Held implements Message {
  constructor(readonly topic: string, readonly timeNs: bigint, private readonly data: Uint8Array,
              private readonly decoder: Decoder) {}
  get bytes(): number { return this.data.byteLength; }
  read<T = Value>(): T {
    let value = decoded.get(this);
    if (!value) {
      value = this.decoder(this.data);
      decoded.set(this, value);
      if (decoded.size > mostDecoded) decoded.delete(decoded.keys().next().value as Message);
    }
    return value as T;
  }
}
