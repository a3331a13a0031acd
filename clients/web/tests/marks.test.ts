// SPDX-License-Identifier: MIT
// Marks of the time line, moments and bookmarks.
import assert from "node:assert/strict";
import { test } from "node:test";
import { makePoses, makeWorld } from "../source/data/generated";
import type { Value } from "../source/data/source";
import { Connections, lanesOf } from "../source/model/marks";
import type { Session } from "../source/model/messages";
import { fromAddress, settingsAtFirst, toAddress } from "../source/model/settings";
import { Timeline, type Mark } from "../source/model/timeline";
import { Moments } from "../source/page/moments";

function put(timeline: Timeline, topic: string, timeNs: number, value: Value): void {
  timeline.take({ topic, timeNs: BigInt(timeNs), bytes: 100, read: <T>() => value as T });
}

/** A world whose page gets every second tick, from `first` on. */
function seen(first: number, count: number, timeline = new Timeline()): Timeline {
  put(timeline, "/world", 20_000_000 * first, makeWorld(1));
  for (let i = 0; i < count; ++i) put(timeline, "/poses", 20_000_000 * (first + 2 * i), makePoses(1, first + 2 * i));
  return timeline;
}

test("marks stand in lanes by kind; those that are switched off or empty have none", () => {
  const marks: Mark[] = [{ sequence: 1, kind: "log", text: "" }, { sequence: 2, kind: "error", text: "" }, { sequence: 3, kind: "missed", text: "" },
                         { sequence: 4, kind: "collision", text: "" }, { sequence: 5, kind: "bookmark", text: "" }];
  const shown = (hidden: Parameters<typeof lanesOf>[1]) => lanesOf(marks, hidden).map(({ name, marks: own }) => [name, ...own.map(({ sequence }) => sequence)]);
  assert.deepEqual(shown([]), [["bookmarks", 5], ["connections", 3], ["collisions", 4], ["log", 1, 2]]);
  assert.deepEqual(shown(["log", "bookmarks"]), [["connections", 3], ["collisions", 4]]);
});

test("who connects and leaves is told, but not who was there already", () => {
  const session = (client: string, state = 2): Session => ({ client, state, robots: [`${client}_1`] } as Session);
  const connections = new Connections();
  assert.deepEqual(connections.take([session("a")]), []);
  assert.deepEqual(connections.take([session("a"), session("b")]), ["b connected"]);
  assert.deepEqual(connections.take([session("a", 6), session("b", 3)]), ["a left"]);
  assert.deepEqual(connections.take([session("a"), session("b")]), ["a connected"]);
});

test("ticks of a running world are found in its newest run", () => {
  const timeline = seen(10, 6);
  assert.deepEqual([9, 10, 13, 20, 21].map((tick) => timeline.sequenceOf(tick)), [null, 0, 1, 5, null]);
  put(timeline, "/world", 0, { ...makeWorld(1), generation: 2 }); // it begins again
  put(timeline, "/poses", 0, { ...makePoses(1, 0), generation: 2 });
  put(timeline, "/poses", 40_000_000, { ...makePoses(1, 2), generation: 2 });
  assert.deepEqual([0, 1, 2, 12].map((tick) => timeline.sequenceOf(tick)), [6, 6, 7, null]);
});

test("time stands at a tick's poses, not at a later frame without any", () => {
  const timeline = seen(10, 6); // tick 20 is at 0.4 s
  put(timeline, "/phases", 420_000_000, {});
  put(timeline, "/poses", 440_000_000, makePoses(1, 22));
  assert.deepEqual([20, 21, 22].map((tick) => timeline.sequenceOf(tick)), [5, 5, 7]);
});

test("the address has a moment and bookmarks; a moment that comes is waited for, one that is over is told", () => {
  const settings = { ...settingsAtFirst(), tick: 14, bookmarks: [12, 40], hiddenLanes: ["log" as const], apart: true };
  assert.deepEqual(fromAddress(`#${toAddress(settings)}`), settings);
  assert.deepEqual(fromAddress("#tick=-1&bookmark=x&bookmark=1e99&hide=no").bookmarks, []);
  assert.equal(fromAddress("#tick=1.5").tick, null);

  const moments = new Moments(settings);
  assert.equal(moments.find(new Timeline(), true), null);
  assert.equal(moments.find(seen(8, 2), true), null);
  assert.equal(moments.find(seen(8, 4), true), null); // the newest frame would go on
  assert.deepEqual(new Moments(settings).find(seen(8, 4), false), { sequence: 3 });
  assert.ok(moments.isWaiting);
  assert.deepEqual(moments.find(seen(8, 6), true), { sequence: 3 });
  assert.ok(!moments.isWaiting);
  assert.deepEqual(moments.bookmarks.map(({ sequence }) => sequence), [2]);
  moments.toggle(16, 4);
  assert.deepEqual(settings.bookmarks, [12, 16, 40]);
  moments.toggle(16, 4);
  assert.deepEqual(settings.bookmarks, [12, 40]);
  const late = new Moments(settings).find(seen(30, 3), true);
  assert.match(late && "fault" in late ? late.fault : "", /Tick 14 was before this page was opened, at tick 30/);
});
