// SPDX-License-Identifier: MIT
// Colours of robots by what they are or by what controls them, which colour-blind people tell apart, too.
import type { World } from "../model/messages";
import type { Part } from "./shapes";

/** How robots are coloured: as in the scene, by model or kind, or by controller. */
export const colorings = ["scene", "model", "controller"] as const;
export type Coloring = (typeof colorings)[number];

/** The palette of Okabe and Ito without black and yellow, which shadows and lights have. */
export const palette = [0x0072b2, 0xe69f00, 0x009e73, 0xcc79a7, 0xd55e00, 0x56b4e9];

/** What robots are told apart by, in the order in which they come. */
function groupsOf(world: World, coloring: Coloring): (string | null)[] {
  return world.entities.map(({ robot, model, kind }) => {
    if (robot === undefined || coloring === "scene") return null;
    return coloring === "model" ? model || String(kind) : world.robots[robot]?.description.controller ?? "";
  });
}

/** The colour of a part [sRGB]: robots that belong together have one, other things that of the scene. */
export function colorOf(world: World, coloring: Coloring): (part: Part) => number {
  const groups = groupsOf(world, coloring);
  const names = [...new Set(groups.filter((group) => group !== null))];
  return ({ link, color, isDecoration }) => {
    const group = groups[world.links[link].entity];
    return group === null || isDecoration ? color : palette[names.indexOf(group) % palette.length];
  };
}
