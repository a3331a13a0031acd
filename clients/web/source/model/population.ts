// SPDX-License-Identifier: MIT
// Who is in a world, for the tree: entities by type, robots first, and the names of their parts.
import { Kind, kindName, type Entity, type World } from "./messages";

/** Entities of one type that are robots, that can be moved, or that can't. */
export interface Group {
  label: string; // the type; "TYPE, fixed" of what can't be moved
  type: string;
  members: number[]; // into World.entities, ascending
}

/** The model; of one that is written out its kind, and of a prototype that is, its id without the number. */
export function typeOf({ model, kind, id }: Entity): string {
  if (model !== "") return model;
  return kind === Kind.prototype ? id.replace(/[_-]?\d+$/, "") || id : kindName(kind);
}

function rankOf({ robot, movable }: Entity): number { return robot !== undefined ? 0 : movable ? 1 : 2; }

/** Robots first, then what moves, then the rest; removed entities are in none. */
export function groupsOf({ entities }: World): Group[] {
  const groups = new Map<string, Group & { rank: number }>();
  entities.forEach((entity, index) => {
    if (entity.removed) return;
    const type = typeOf(entity), rank = rankOf(entity);
    const key = `${rank} ${type}`;
    const known = groups.get(key);
    if (known) known.members.push(index);
    else groups.set(key, { label: rank === 2 ? `${type}, fixed` : type, type, rank, members: [index] });
  });
  return [...groups.values()].sort((a, b) => a.rank - b.rank).map(({ label, type, members }) => ({ label, type, members }));
}

const known = new WeakMap<World, string[][]>();

/** Links, joints and devices of each entity, by name. */
export function partsOf(world: World): string[][] {
  const found = known.get(world);
  if (found) return found;
  const parts: string[][] = world.entities.map(() => []);
  const own = (list: { entity: number; id: string }[], kind: string): void => {
    for (const { entity, id } of list) parts[entity]?.push(`${kind} ${id}`);
  };
  const robots = (list: { robot: number; id: string }[], kind: string): void => {
    for (const { robot, id } of list) parts[world.robots[robot]?.entity ?? -1]?.push(`${kind} ${id}`);
  };
  own(world.links, "link");
  own(world.joints, "joint");
  robots(world.cameras, "camera");
  robots(world.radios, "radio");
  own(world.leds, "LED");
  own(world.directionalLeds, "directional LED");
  own(world.tags, "tag");
  own(world.magnets, "magnet");
  for (const { entity, description } of world.robots) {
    const flags = [["rangeAndBearing", "range and bearing"], ["positioning", "positioning"], ["battery", "battery"],
                   ["wheels", "wheels"], ["turret", "turret"]] as const;
    parts[entity]?.push(...description.imus.map(({ id }) => `IMU ${id}`), ...description.contactSensors.map(({ id }) => `contact sensor ${id}`),
      ...(description.deviceKinds ?? []).flatMap(({ name, devices }) => devices.map(({ id }, i) => `${name} ${id || i}`)),
      ...description.proximitySensors.map((_, i) => `proximity sensor ${i}`),
      ...flags.filter(([field]) => description[field]).map(([, label]) => label));
  }
  known.set(world, parts);
  return parts;
}

/** Entities whose id, type or parts have a text, in lower case. */
export function matching(world: World, { type, members }: Group, text: string): number[] {
  if (text === "" || type.toLowerCase().includes(text)) return members;
  const parts = partsOf(world);
  return members.filter((index) => {
    const { id, kind } = world.entities[index];
    return id.toLowerCase().includes(text) || kindName(kind).includes(text) || parts[index].some((part) => part.toLowerCase().includes(text));
  });
}
