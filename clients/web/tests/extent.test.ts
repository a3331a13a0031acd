// What decoding would take, and messages that would take too much.
import assert from "node:assert/strict";
import { test } from "node:test";
import { setFlagsFromString } from "node:v8";
import { runInNewContext } from "node:vm";
import { makeDecoder, type Decoder } from "../source/data/decode";
import { Held } from "../source/data/held";
import { encode, repeated, schema } from "./encode";

setFlagsFromString("--expose-gc");
const gc = runInNewContext("gc") as () => void;

function used(): number {
  for (let i = 0; i < 3; ++i) gc();
  const { heapUsed, arrayBuffers } = process.memoryUsage();
  return heapUsed + arrayBuffers;
}

function measure(decoder: Decoder, bytes: Uint8Array): { counted: number; taken: number } {
  decoder.decode(bytes); // what it keeps itself is there
  const counted = decoder.weigh(bytes);
  const before = used();
  const value = decoder.decode(bytes);
  const taken = used() - before;
  assert.ok(Object.keys(value).length > 0);
  return { counted, taken };
}

/** Small pieces of messages that take much. */
const bombs: [string, string, Uint8Array][] = [
  ["links", "World", encode("ziggurat.v1.World", { links: [{}] })],
  ["entities", "World", encode("ziggurat.v1.World", { entities: [{}] })],
  ["cameras", "World", encode("ziggurat.v1.World", { cameras: [{}] })],
  ["tags", "World", encode("ziggurat.v1.World", { tags: [{ mount: {} }] })],
  ["robots", "World", encode("ziggurat.v1.World", { robots: [{ description: {} }] })],
  ["texts", "World", encode("ziggurat.v1.World", { controllers: [""] })],
  ["large numbers", "World", encode("ziggurat.v1.World", { tagPatterns: [2n ** 63n + 1n] })],
  ["packed numbers", "World", encode("ziggurat.v1.World", { tagPatterns: Array.from({ length: 1000 }, () => 1n) })],
  ["payloads", "Poses", encode("ziggurat.v1.Poses", { tagPayloads: [{ payload: new Uint8Array([1]) }] })],
  ["floats", "Poses", encode("ziggurat.v1.Poses", { positions: Array.from({ length: 1000 }, (_, i) => i) })],
  ["sessions", "Barrier", encode("ziggurat.v1.Barrier", { histograms: [{ counts: [1n, 2n] }] })],
];

test("what is counted is enough for what is taken", () => {
  for (const [name, type, piece] of bombs) {
    const { counted, taken } = measure(makeDecoder(schema, `ziggurat.v1.${type}`), repeated(piece, 200_000));
    console.log(`${name}: ${(counted / 1e6).toFixed(1)} MB counted, ${(taken / 1e6).toFixed(1)} MB taken`);
    assert.ok(counted >= taken, `${name}: ${counted} counted, ${taken} taken`);
  }
});

test("a message of many small parts is not decoded", () => {
  for (const [name, type, piece] of bombs) {
    if (/numbers|floats/.test(name)) continue; // they take less than the bound of bytes allows
    const decoder = makeDecoder(schema, `ziggurat.v1.${type}`);
    const bytes = repeated(piece, type === "World" ? 127e6 : 63e6);
    const before = used();
    assert.throws(() => decoder(bytes), /has parts that take more than (1024|256) MiB of memory/, name);
    assert.ok(used() - before < 50e6);
  }
  assert.throws(() => makeDecoder(schema, "ziggurat.v1.Poses")(new Uint8Array(65e6)), /has 65000000 bytes; at most|is damaged/);
  assert.throws(() => makeDecoder(schema, "ziggurat.v1.Poses")(new Uint8Array(68e6)), /has 68000000 bytes; at most 67108864/);
  assert.throws(() => makeDecoder(repeated(new Uint8Array([10, 0]), 1e6), "any.Type"), /has parts that take more than 64 MiB/);
});

test("real worlds are far below the bounds", () => {
  const robot = { entity: 0, description: { id: "robot_10000", controller: "c", jointSensors: Array(4).fill({ id: "wheel" }),
    proximitySensors: Array(24).fill({ range: 0.1, direction: [1, 0, 0], position: [0, 0, 0], anchor: "base" }), leds: Array(13).fill({ id: "led" }) } };
  const bytes = encode("ziggurat.v1.World", { robots: Array(1000).fill(robot), links: Array(1000).fill({ id: "base", frame: "robot_10000/base" }) });
  const memory = makeDecoder(schema, "ziggurat.v1.World").weigh(bytes);
  console.log(`1000 robots: ${bytes.length} bytes, ${(memory / 1e6).toFixed(1)} MB`);
  assert.ok(memory < 2 ** 30 / 10, `${memory} for ${bytes.length} bytes`);
});

test("damaged messages are told before they are decoded", () => {
  const decoder = makeDecoder(schema, "ziggurat.v1.World");
  const told = (bytes: number[], sentence: RegExp): void => {
    assert.throws(() => decoder(new Uint8Array(bytes)), sentence);
    assert.throws(() => new Held("/world", 0n, new Uint8Array(bytes), decoder), sentence);
  };
  told([0x7b, 0x08, 0x01, 0x7c], /more than 1024 MiB/); // a group
  const link = encode("ziggurat.v1.World", { links: [{ id: "abcdef" }] });
  const longer = Array.from(link);
  longer[3] += 1; // its name is longer than it is
  told([...longer, ...link], /is damaged/);
  const other = Array.from(link);
  other[0] = other[0] & ~7; // a number where a message should be
  assert.deepEqual(decoder(new Uint8Array(other.slice(0, 2)))["links"], []);
});
