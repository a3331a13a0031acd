// SPDX-License-Identifier: MIT
// Paths of entities that were chosen, from where they were when the page first saw them.
import type { Entity, Poses, World } from "../model/messages";
import { compose, poseAt, type Pose, type Vector } from "../model/pose";
import type { Frame, Frames } from "../model/timeline";

const longest = 1500; // points
const mostRead = 60_000; // poses of links, for what has been

/** X_WE of an entity's origin. */
export function originIn({ positions, orientations }: Poses, entity: Entity): Pose {
  return compose(poseAt(positions, orientations, entity.referenceLink),
                 { position: entity.originPosition, orientation: entity.originOrientation });
}

function addTo(points: Vector[], origin: Pose | null): void {
  if (!origin?.position.every(Number.isFinite)) return;
  const [x, y, z] = origin.position;
  const last = points[points.length - 1];
  if (!last || Math.hypot(x - last[0], y - last[1], z + 0.002 - last[2]) > 0.001) points.push([x, y, z + 0.002]);
  if (points.length > longest) points.shift();
}

/** Where an entity was before a frame. */
function before(id: string, frame: Frame, world: World, seen: Frames): Vector[] {
  const reads = Math.min(Math.max(mostRead / (world.links.length || 1), 20), 500);
  const first = Math.max(seen.first, frame.sequence - longest);
  const step = Math.max(1, Math.ceil((frame.sequence - first) / reads));
  const origins: Pose[] = [];
  let later = frame;
  for (let s = frame.sequence - step; s >= first; s -= step) {
    const earlier = seen.at(s);
    const message = earlier?.messages.get("/poses");
    if (!earlier?.world || !message) continue;
    const entity = earlier.world.entities.find((one) => one.id === id && !one.removed);
    if (!entity || earlier.timeNs >= later.timeNs) break; // it was not there yet, or the world began anew
    origins.push(originIn(message.read<Poses>(), entity));
    later = earlier;
  }
  const points: Vector[] = [];
  for (const origin of origins.reverse()) addTo(points, origin);
  return points;
}

/** Points by the ids of entities. */
export class Trails extends Map<string, Vector[]> {
  /** @param wanted  ids, @param seen  where trails begin: all frames that can be read at once */
  grow(wanted: string[], frame: Frame, world: World, poses: Poses, seen: Frames | null): void {
    for (const id of [...this.keys()]) if (!wanted.includes(id)) this.delete(id);
    for (const id of wanted) {
      const points = this.get(id) ?? (seen ? before(id, frame, world, seen) : []);
      this.set(id, points);
      const entity = world.entities.find((one) => one.id === id && !one.removed);
      addTo(points, entity ? originIn(poses, entity) : null);
    }
  }
}
