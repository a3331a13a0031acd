// SPDX-License-Identifier: MIT
// Who is in a world, by type.
import assert from "node:assert/strict";
import { test } from "node:test";
import { makeWorld } from "../source/data/generated";
import { Kind, type Description, type Entity, type World } from "../source/model/messages";
import { groupsOf, matching, partsOf, typeOf } from "../source/model/population";

function entity(id: string, kind: Kind, more: Partial<Entity> = {}): Entity {
  return { id, kind, movable: true, removed: false, model: "", firstLink: 0, linkCount: 0, referenceLink: 0,
           originPosition: [0, 0, 0], originOrientation: [1, 0, 0, 0], ...more };
}

const description = { id: "r1", imus: [{ id: "imu" }], contactSensors: [], proximitySensors: [{}, {}], cameras: [], radios: [],
  battery: true, deviceKinds: [{ name: "lamp", devices: [{ id: "" }] }] } as unknown as Description;
const world = { ...makeWorld(0), links: [{ id: "arm", entity: 1 }], cameras: [{ id: "eye", robot: 0 }], robots: [{ entity: 3, description }], entities: [
  entity("wall", Kind.box, { movable: false }), entity("block1", Kind.prototype, { model: "block" }), entity("old", Kind.box, { removed: true }),
  entity("r1", Kind.prototype, { model: "robot", robot: 0 }), entity("block2", Kind.prototype, { model: "block" }), entity("crate", Kind.box),
] } as unknown as World;

test("entities are grouped by model or kind: robots, what moves, what is fixed", () => {
  assert.deepEqual(groupsOf(world).map(({ label, members }) => [label, members]),
                   [["robot", [3]], ["block", [1, 4]], ["box", [5]], ["box, fixed", [0]]]);
  assert.equal(typeOf(entity("tower_12", Kind.prototype)), "tower");
  assert.equal(typeOf(entity("12", Kind.prototype)), "12");
  assert.equal(typeOf(entity("fb_3", Kind.footBot)), "foot-bot");
});

test("a text is found in ids, types, links and devices", () => {
  const found = (text: string): string[] => groupsOf(world).flatMap((group) => matching(world, group, text)).map((index) => world.entities[index].id);
  assert.deepEqual(partsOf(world)[3], ["camera eye", "IMU imu", "lamp 0", "proximity sensor 0", "proximity sensor 1", "battery"]);
  assert.deepEqual(found("block"), ["block1", "block2"]);
  assert.deepEqual(found("arm"), ["block1"]);
  assert.deepEqual(found("imu"), ["r1"]);
  assert.deepEqual(found("prototype"), ["r1", "block1", "block2"]);
  assert.deepEqual(found("nothing"), []);
  const many = makeWorld(20_000) as unknown as World;
  const begin = process.cpuUsage(); // other programs run beside
  assert.equal(matching(many, groupsOf(many)[1], "e19999").length + matching(many, groupsOf(many)[1], "link").length, 6668);
  const { user, system } = process.cpuUsage(begin);
  assert.ok(user + system < 500_000, `${user + system} us`);
});
