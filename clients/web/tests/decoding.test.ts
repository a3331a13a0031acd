// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { test } from "node:test";
import { MessageChannel } from "node:worker_threads";
import { buffersIn, Decoding } from "../source/data/decoding";
import { Unreadable } from "../source/data/decode";
import type { Value } from "../source/data/source";

/** The first byte twice; 9 can't be read. */
function decoder(bytes: Uint8Array): Value {
  if (bytes[0] === 9) throw new Unreadable("is damaged");
  return { twice: 2 * bytes[0], numbers: Float32Array.of(bytes[0]) };
}

test("without worker messages are decoded at once", () => {
  const decoding = new Decoding(null), got: unknown[] = [];
  decoding.add(decoder, new Uint8Array(0), "t");
  for (const first of [1, 9, 2]) {
    decoding.decode(decoder, new DataView(Uint8Array.of(0, first, 7).buffer, 1, 2), (bytes, value) => got.push([...bytes, value.twice]),
                    (fault) => got.push(fault));
  }
  assert.deepEqual(got, [[1, 7, 2], "is damaged", [2, 7, 4]]);
});

test("a worker's answers come in order, and those of before a new connection not at all", () => {
  type Port = NonNullable<ConstructorParameters<typeof Decoding>[0]>;
  const sent: { buffer: ArrayBuffer }[] = [];
  const port: Port = { postMessage: (message) => sent.push(message as { buffer: ArrayBuffer }), onmessage: null };
  const decoding = new Decoding(port), got: unknown[] = [];
  decoding.add(decoder, new Uint8Array(0), "t");
  const ask = (first: number): void => decoding.decode(decoder, new DataView(Uint8Array.of(first).buffer),
    (bytes, value) => got.push([...bytes, value.twice]), (fault) => got.push(fault));
  const answer = (data: unknown): void => port.onmessage!({ data } as MessageEvent);
  [1, 2].forEach(ask);
  decoding.forget();
  [3, 4].forEach(ask);
  assert.equal(sent.length, 5); // the schema, then four
  answer({ buffer: sent[1].buffer, value: { twice: 2 } });
  answer({ buffer: sent[2].buffer, value: { twice: 4 } });
  answer({ buffer: sent[3].buffer, value: { twice: 6 } });
  answer({ fault: "is damaged" });
  assert.deepEqual(got, [[3, 6], "is damaged"]);
});

test("long rows of numbers change hands without being copied", async () => {
  const value = { long: new Float32Array(1000).fill(2), short: Float64Array.of(3), list: [{ long: new Float32Array(1000) }], text: "x" };
  const buffers = buffersIn(value);
  assert.deepEqual(buffers, [value.long.buffer]);
  const { port1, port2 } = new MessageChannel();
  const came = new Promise<Value>((resolve) => port2.once("message", resolve));
  port1.postMessage(value, buffers);
  assert.equal(value.long.length, 0);
  assert.deepEqual((await came).long, new Float32Array(1000).fill(2));
  port1.close();
});
