// SPDX-License-Identifier: MIT
// The recording inside of an exported page: any bytes of it, from parts in base64.
import assert from "node:assert/strict";
import { test } from "node:test";
import { partsReadable } from "../source/data/embedded";

const bytes = Uint8Array.from({ length: 1000 }, (_, i) => (i * i) % 251);
const part = 300;

function readableOf(change = (text: string): string => text): ReturnType<typeof partsReadable> {
  return partsReadable(bytes.length, part, (number) =>
    change(Buffer.from(bytes.subarray(number * part, (number + 1) * part)).toString("base64")));
}

test("any bytes are those of the recording", async () => {
  const file = readableOf();
  assert.equal(await file.size(), 1000n);
  for (const [from, to] of [[0, 1000], [0, 0], [0, 1], [1, 2], [2, 7], [299, 301], [300, 600], [150, 950], [998, 1000], [999, 1000]]) {
    assert.deepEqual(await file.read(BigInt(from), BigInt(to - from)), bytes.slice(from, to), `${from} to ${to}`);
  }
});

test("what is not there is an error", async () => {
  await assert.rejects(readableOf().read(999n, 2n), /behind its own end/);
  await assert.rejects(readableOf((text) => text.slice(0, 40)).read(0n, 300n), /cut off/);
  await assert.rejects(readableOf(() => "").read(0n, 1n), /cut off/);
});
