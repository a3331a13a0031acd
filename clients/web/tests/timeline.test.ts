// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { test } from "node:test";
import { makePoses, makeWorld } from "../source/data/generated";
import type { Message, Value } from "../source/data/source";
import { Series } from "../source/model/series";
import { Timeline } from "../source/model/timeline";

function message(topic: string, timeNs: number, value: Value, bytes = 100): Message {
  return { topic, timeNs: BigInt(timeNs), bytes, read: <T>() => value as T };
}
function poses(tick: number): Message { return message("/poses", tick * 20_000_000, makePoses(2, tick)); }
function begun(...limits: number[]): Timeline {
  const timeline = new Timeline(...limits);
  timeline.take(message("/world", 0, makeWorld(2)));
  return timeline;
}

test("messages of one time are one frame, in any order", () => {
  const timeline = begun();
  timeline.take(poses(0));
  assert.equal(timeline.take(message("/rays", 20_000_000, {})), true);
  assert.equal(timeline.take(poses(1)), false);
  assert.equal(timeline.length, 2);
  assert.equal(timeline.newest?.tick, 1);
  assert.equal(timeline.newest?.world?.scene, "generated");
  assert.equal(timeline.at(0)?.tick, 0);
});

test("what is sent again for a new subscription goes to its own frame", () => {
  const timeline = begun();
  for (let tick = 0; tick < 5; ++tick) timeline.take(poses(tick));
  timeline.take(message("/contacts", 3 * 20_000_000, {}));
  assert.equal(timeline.length, 5);
  assert.ok(timeline.at(3)?.messages.has("/contacts"));
});

test("a reset begins new frames and is marked", () => {
  const timeline = begun();
  for (let tick = 0; tick < 5; ++tick) timeline.take(poses(tick));
  timeline.take(message("/world", 0, { ...makeWorld(2), generation: 2 }));
  timeline.take(message("/poses", 0, { ...makePoses(2, 0), generation: 2 }));
  assert.equal(timeline.length, 6);
  assert.equal(timeline.newest?.tick, 0);
  assert.equal(timeline.newest?.world?.generation, 2);
  assert.equal(timeline.at(0)?.world?.generation, 1);
  assert.deepEqual(timeline.marks.map(({ kind }) => kind), ["reset"]);
});

test("memory is bounded, and old frames are given up first", () => {
  const timeline = begun(10_000, 1_000_000);
  for (let tick = 0; tick < 5000; ++tick) timeline.take(poses(tick));
  assert.ok(timeline.heldBytes <= 10_000);
  assert.ok(timeline.length <= 100 && timeline.length > 90, `${timeline.length}`);
  assert.equal(timeline.newest?.tick, 4999);
  assert.equal(timeline.at(0)?.sequence, timeline.first);
  const few = begun(1e9, 50);
  for (let tick = 0; tick < 5000; ++tick) few.take(poses(tick));
  assert.equal(few.length, 50);
});

test("log lines and the barrier begin no frame", () => {
  const timeline = begun();
  timeline.take(poses(0));
  timeline.take(message("/log", 40_000_000, {}));
  timeline.take(message("/barrier", 40_000_000, {}));
  assert.equal(timeline.length, 1);
});

test("series read each complete frame once", () => {
  const timeline = begun();
  const series = new Series({ topic: "/poses", path: "positions.2" });
  for (let tick = 0; tick < 10; ++tick) timeline.take(poses(tick));
  series.update(timeline);
  series.update(timeline);
  assert.equal(series.values.length, 9);
  assert.equal(series.times[8].toFixed(3), "0.160");
  assert.equal(series.latest, (makePoses(2, 8)["positions"] as Float32Array)[2]);
});

/** Worlds in which the robot `a` is removed, and another `a` spawned. */
function worldsOfTwo(): { withFirst: Value; withSecond: Value } {
  const robot = { id: "a", kind: 5, movable: true, removed: false, robot: 0 };
  const others = [{ id: "box", kind: 1, movable: true, removed: false }];
  return { withFirst: { ...makeWorld(0), generation: 1, entities: [robot, ...others] },
           withSecond: { ...makeWorld(0), generation: 2, entities: [{ ...robot, removed: true }, ...others, { ...robot, robot: 1 }] } };
}
function posesOf(generation: number, tick: number): Message {
  return message("/poses", tick * 20_000_000, { ...makePoses(0, tick), generation });
}
const readings = "/robots/a/observation";

test("readings of a removed robot are not those of another one with its id", () => {
  const { withFirst, withSecond } = worldsOfTwo();
  const timeline = new Timeline();
  for (const one of [message("/world", 0, withFirst), posesOf(1, 0), message(readings, 0, {})]) timeline.take(one);
  timeline.take(posesOf(1, 1));
  assert.ok(timeline.message(readings, 1, 60, 0), "of the tick before");
  for (const one of [message("/world", 40_000_000, withSecond), posesOf(2, 2)]) timeline.take(one);
  assert.equal(timeline.message(readings, 2, 60, 2), null);
  assert.ok(timeline.message(readings, 1, 60, 0), "of the first, while the page looks back");
  timeline.take(message(readings, 40_000_000, { second: true }));
  assert.ok(timeline.message(readings, 2, 60, 2));
});

test("a robot that stays keeps its readings when others come, and none outlive a reset", () => {
  const { withFirst } = worldsOfTwo();
  const timeline = new Timeline();
  for (const one of [message("/world", 0, withFirst), posesOf(1, 0), message(readings, 0, {})]) timeline.take(one);
  const entities = [...withFirst["entities"] as Value[], { id: "b", kind: 1 }];
  for (const one of [message("/world", 20_000_000, { ...withFirst, generation: 2, entities }), posesOf(2, 1)]) timeline.take(one);
  assert.ok(timeline.message(readings, 1, 60, 0));
  for (const one of [message("/world", 0, { ...withFirst, generation: 3 }), posesOf(3, 0)]) timeline.take(one);
  assert.equal(timeline.length, 3);
  assert.equal(timeline.message(readings, 2, 60, 0), null);
});

test("a robot that another one replaces while the world is paused leaves no readings", () => {
  const { withFirst, withSecond } = worldsOfTwo();
  const timeline = new Timeline();
  const other = "/robots/b/observation";
  for (const one of [message("/world", 0, withFirst), posesOf(1, 0), message(readings, 0, {}), message(other, 0, {})]) timeline.take(one);
  for (const one of [message("/world", 0, withSecond), posesOf(2, 0)]) timeline.take(one);
  assert.equal(timeline.length, 1);
  assert.equal(timeline.message(readings, 0, 60, 2), null);
  assert.ok(timeline.message(other, 0));
  assert.equal(timeline.heldBytes, 300); // of the world, the poses and the other's readings
});
