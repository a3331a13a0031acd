// SPDX-License-Identifier: MIT
// Topics that the page subscribes: of what it shows now.
import { layers, mostRobotsAtOnce } from "../drawing/view";
import { metricsTopic } from "../model/metrics";
import type { World } from "../model/messages";
import type { App } from "./app";

/** With more links than this, collisions are looked for only while the layer of contacts is on. */
const mostLinksForCollisions = 300;

/** @param newest  the newest world, also while the page looks back; null: none yet */
export function wantedTopics({ selectedRobot: selected, view, series, settings }: App, newest: World | null): Set<string> {
  const wanted = new Set(["/world", "/poses", "/log", "/barrier", "/phases", metricsTopic]);
  const robots = newest?.robots ?? [];
  const areShown = (newest !== null && robots.length <= mostRobotsAtOnce) || selected !== null || view.shown.has("everyone");
  for (const layer of layers) {
    const isOfRobots = layer.name === "rays" || layer.name === "radio";
    if ("topic" in layer && view.shown.has(layer.name) && (areShown || !isOfRobots)) wanted.add(layer.topic);
  }
  if ((newest?.links.length ?? Infinity) <= mostLinksForCollisions) wanted.add("/contacts");
  for (const { name } of series) wanted.add(name.topic);
  for (const robot of robots.length <= mostRobotsAtOnce ? robots : selected ? [selected] : []) {
    wanted.add(`/robots/${robot.description.id}/observation`);
    wanted.add(`/robots/${robot.description.id}/command`);
  }
  if (selected && settings.tab === "camera") {
    wanted.add("/detections");
    for (const { id } of selected.description.cameras) wanted.add(`/robots/${selected.description.id}/cameras/${id}/image`);
  }
  return wanted;
}
