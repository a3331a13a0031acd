// SPDX-License-Identifier: MIT
// Messages written by @bufbuild/protobuf itself, by the schemas that the server advertises.
import assert from "node:assert/strict";
import { test } from "node:test";
import { makeDecoder } from "../source/data/decode";
import type { Barrier, Poses, World } from "../source/model/messages";
import { encode, schema } from "./encode";

test("poses have typed arrays", () => {
  const bytes = encode("ziggurat.v1.Poses", {
    tick: 7n, timeNs: 700_000_000n, generation: 2n, positions: [1, 2, 3.5], orientations: [1, 0, 0, 0],
    ledColors: [0xff0000, 0], tagPayloads: [{ tag: 3, payload: new Uint8Array([52, 50]) }] });
  const poses = makeDecoder(schema, "ziggurat.v1.Poses")(bytes) as unknown as Poses;
  assert.equal(poses.tick, 7);
  assert.equal(poses.timeNs, 700_000_000);
  assert.ok(poses.positions instanceof Float32Array);
  assert.deepEqual(Array.from(poses.positions), [1, 2, 3.5]);
  assert.deepEqual(Array.from(poses.ledColors), [0xff0000, 0]);
  assert.deepEqual(poses.tagPayloads, [{ tag: 3, payload: new Uint8Array([52, 50]) }]);
  assert.deepEqual(Array.from(poses.magnetMoments), []);
});

test("worlds: oneofs, optional fields and large integers", () => {
  const bytes = encode("ziggurat.v1.World", {
    generation: 1n, seed: 2n ** 64n - 1n, hasFloor: true, tagPatterns: [2n ** 35n + 5n],
    links: [{ id: "base", shape: { case: "cylinder", value: { radius: 0.1, height: 0.2 } } },
            { id: "arm", shape: { case: "hull", value: 0 } }],
    joints: [{ id: "free" }, { id: "rail", lower: 0, upper: 0.4 }] });
  const world = makeDecoder(schema, "ziggurat.v1.World")(bytes) as unknown as World;
  assert.equal(world.seed, 2n ** 64n - 1n);
  assert.equal(world.hasFloor, true);
  assert.deepEqual(world.tagPatterns, [2 ** 35 + 5]);
  assert.deepEqual(world.links[0].cylinder, { radius: 0.1, height: 0.2 });
  assert.equal(world.links[0].box, undefined);
  assert.equal(world.links[1].hull, 0);
  assert.equal(world.joints[0].lower, undefined);
  assert.equal(world.joints[1].lower, 0);
});

test("messages in messages, enums and negative numbers", () => {
  const barrier = makeDecoder(schema, "ziggurat.v1.Barrier")(encode("ziggurat.v1.Barrier", {
    status: { phase: 3, sessions: [{ client: "lua 1", robots: ["a", "b"], wallLatency: { p50: 0.001 } }] },
    histograms: [{ controller: "c", counts: [0n, 5n] }] })) as unknown as Barrier;
  assert.equal(barrier.status?.phase, 3);
  assert.deepEqual(barrier.status?.sessions[0].robots, ["a", "b"]);
  assert.equal(barrier.status?.sessions[0].wallLatency?.p50, 0.001);
  assert.deepEqual(Array.from(barrier.histograms[0].counts), [0, 5]);
  const contacts = makeDecoder(schema, "ziggurat.v1.Contacts")(encode("ziggurat.v1.Contacts", { links: [4, -1] }));
  assert.deepEqual(contacts["links"], [4, -1]);
});

test("a message that was cut is an error, and so is an unknown type", () => {
  const bytes = encode("ziggurat.v1.Poses", { positions: [1, 2, 3] });
  assert.throws(() => makeDecoder(schema, "ziggurat.v1.Poses")(bytes.slice(0, 6)));
  assert.throws(() => makeDecoder(schema, "ziggurat.v1.Nothing"), /no type ziggurat.v1.Nothing/);
  const link = encode("ziggurat.v1.World", { links: [{ id: "abcdef" }] });
  const longer = Array.from(link);
  longer[3] += 1; // its name is longer than it is
  assert.throws(() => makeDecoder(schema, "ziggurat.v1.World")(new Uint8Array([...longer, ...link])), /is damaged/);
});

test("a message that is too long is not decoded", () => {
  assert.throws(() => makeDecoder(schema, "ziggurat.v1.Poses")(new Uint8Array(2 ** 27 + 1)), /has 134217729 bytes; at most 134217728 are read/);
});
