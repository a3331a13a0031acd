// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { test } from "node:test";
import { makePoses, makeWorld } from "../source/data/generated";
import type { Message, Source, Value } from "../source/data/source";
import type { View } from "../source/drawing/view";
import type { World } from "../source/model/messages";
import { settingsAtFirst } from "../source/model/settings";
import { App } from "../source/page/app";

function message(topic: string, timeNs: number, value: Value): Message {
  return { topic, timeNs: BigInt(timeNs), bytes: 100, read: <T>() => value as T };
}

/** An app without a document, and what it wanted. */
function makeApp(): { app: App; wants: ReadonlySet<string>[] } {
  const wants: ReadonlySet<string>[] = [];
  const source: Source = { name: "test", isLive: true, start: () => undefined, want: (topics) => wants.push(topics),
                           call: () => Promise.resolve({}), setParameter: () => undefined, close: () => undefined };
  const view = { shown: new Set(), applyLayers: () => undefined, setColoring: () => undefined, motion: {} } as unknown as View;
  return { app: new App(source, settingsAtFirst(), view), wants };
}

/** A world of so many boxes. */
function boxes(count: number, generation: number): Value {
  return { ...makeWorld(count), generation };
}

test("the frame stays the same during a redraw, however long that takes", (t) => {
  let now = 1000;
  t.mock.method(performance, "now", () => now);
  const { app } = makeApp();
  app.message(message("/world", 0, boxes(2, 1)));
  app.message(message("/poses", 0, makePoses(2, 0)));
  now += 20;
  app.chooseFrame();
  assert.equal(app.frame?.tick, 0);
  app.message(message("/world", 20_000_000, boxes(3, 2)));
  app.message(message("/poses", 20_000_000, { ...makePoses(3, 1), generation: 2 }));
  app.chooseFrame(); // the next frame may not be whole yet
  assert.equal(app.world?.generation, 1);
  app.settings.selected = "e2";
  assert.deepEqual(app.selectedLinks, []);
  now += 20; // within the redraw
  assert.equal(app.world?.generation, 1);
  assert.deepEqual(app.selectedLinks, []);
  app.chooseFrame();
  assert.equal(app.world?.generation, 2);
  assert.deepEqual(app.selectedLinks, [2]);
});

test("topics of a spawned robot are wanted when it comes, also while the page looks back", () => {
  const { app, wants } = makeApp();
  app.message(message("/world", 0, boxes(1, 1)));
  app.message(message("/poses", 0, makePoses(1, 0)));
  app.message(message("/poses", 20_000_000, makePoses(1, 1)));
  app.pin(0);
  app.chooseFrame();
  const robots = [{ entity: 1, description: { id: "r", cameras: [] } }];
  const before = wants.length;
  app.message(message("/world", 20_000_000, { ...boxes(2, 2), robots })); // of a world that is paused
  app.message(message("/poses", 20_000_000, { ...makePoses(2, 1), generation: 2 }));
  app.chooseFrame();
  assert.equal((app.world as World).generation, 1);
  assert.ok(wants.length > before && wants.at(-1)?.has("/robots/r/observation"));
});
