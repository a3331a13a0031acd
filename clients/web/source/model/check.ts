// SPDX-License-Identifier: MIT
// Whether indices of a world point into its lists. Servers send true ones; a file may contain anything.
import type { Mount, Poses, World } from "./messages";

/** @throws Error that says what is wrong */
export function checkWorld(world: World): void {
  const check = (what: string, index: number, list: { length: number }): void => {
    if (!(index >= 0 && index < list.length)) throw new Error(`the world of the recording is damaged: ${what} ${index} does not exist`);
  };
  const { entities, links, hulls, robots } = world;
  const mounted = (list: { mount?: Mount }[]): void => {
    for (const { mount } of list) {
      check("link", mount?.link ?? -1, links);
      if (mount?.position.length !== 3 || mount.orientation.length !== 4) throw new Error("the world of the recording is damaged: a device has no place");
    }
  };
  for (const entity of entities) {
    if (entity.linkCount > 0) check("link", entity.firstLink + entity.linkCount - 1, links);
    check("link", entity.referenceLink, links);
    if (entity.robot !== undefined) check("robot", entity.robot, robots);
  }
  for (const link of links) {
    check("entity", link.entity, entities);
    if (link.hull !== undefined) check("hull", link.hull, hulls);
  }
  for (const hull of hulls) {
    const corners = hull.vertices.length / 3;
    if (Array.from(hull.triangles).some((index) => index >= corners)) throw new Error("the world of the recording is damaged: a hull has a corner that does not exist");
  }
  for (const { entity, description } of robots) {
    check("entity", entity, entities);
    if (!description) throw new Error("the world of the recording is damaged: a robot has no description");
  }
  for (const list of [world.joints, world.leds, world.directionalLeds, world.tags, world.magnets]) {
    for (const { entity } of list) check("entity", entity, entities);
  }
  for (const { robot } of [...world.cameras, ...world.radios]) check("robot", robot, robots);
  for (const list of [world.cameras, world.leds, world.directionalLeds, world.tags, world.magnets, world.radios,
                      world.proximitySensors, world.rangeAndBearing]) mounted(list);
  for (const camera of world.cameras) {
    if (!(camera.width > 0 && camera.width <= 8192 && camera.height > 0 && camera.height <= 8192)
        || camera.focalLength.length !== 2 || camera.principalPoint.length !== 2) {
      throw new Error("the world of the recording is damaged: a camera has no size");
    }
  }
}

/** Whether poses have all links of their world. */
export function areWhole(poses: Poses, world: World): boolean {
  return poses.positions.length >= 3 * world.links.length && poses.orientations.length >= 4 * world.links.length;
}
