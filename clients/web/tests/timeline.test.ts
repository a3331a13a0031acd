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
