// The shapes of links as triangles: unit shapes that stand on the centre of their bottom, and hulls and
// capsules in their own size.
import * as three from "three";
import { Kind, type Entity, type Hull, type Link, type World } from "../model/messages";
import type { Quaternion, Vector } from "../model/pose";

/** A piece of what is drawn: a shape that moves with a link. */
export interface Part {
  shape: string; // key of its geometry
  link: number;
  position: Vector; // in the frame of the link [m]
  orientation: Quaternion;
  scale: Vector;
  color: number; // sRGB
  isDecoration: boolean; // the world does not have it
}

/** Whether a shape takes more triangles to look round. */
export function isRound(shape: string): boolean { return /^(cylinder|sphere|capsule)/.test(shape); }

const upright: Quaternion = [1, 0, 0, 0];

/** The geometry with that key. @param around  pieces around what is round */
export function makeGeometry(key: string, hulls: Hull[], around: number): three.BufferGeometry {
  const [name, a, b] = key.split(" ");
  switch (name) {
    case "box": return new three.BoxGeometry(1, 1, 1).translate(0, 0, 0.5);
    case "cylinder": return new three.CylinderGeometry(1, 1, 1, around).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    case "sphere": return new three.SphereGeometry(1, around, Math.round(around / 2)).rotateX(Math.PI / 2).translate(0, 0, 1);
    case "ring": return new three.TorusGeometry(1, 0.08, 8, 40);
    case "wedge": return new three.ConeGeometry(1, 1, 3).rotateZ(-Math.PI / 2).translate(0, 0, 0);
    case "capsule": return capsule(Number(a), Number(b), around);
    default: return hullGeometry(hulls[Number(a)]);
  }
}

function capsule(radius: number, height: number, around: number): three.BufferGeometry {
  const straight = Math.max(height - 2 * radius, 0);
  return new three.CapsuleGeometry(radius, straight, Math.round(around / 4), around).rotateX(Math.PI / 2).translate(0, 0, height / 2);
}

function hullGeometry(hull: Hull | undefined): three.BufferGeometry {
  const indexed = new three.BufferGeometry();
  indexed.setAttribute("position", new three.BufferAttribute(Float32Array.from(hull?.vertices ?? []), 3));
  indexed.setIndex(Array.from(hull?.triangles ?? []));
  const geometry = indexed.toNonIndexed(); // flat faces
  geometry.computeVertexNormals();
  return geometry;
}

function partOf(link: Link, index: number): Part | null {
  const base = { link: index, position: [0, 0, 0] as Vector, orientation: upright, color: link.color,
                 isDecoration: false };
  if (link.box) return { ...base, shape: "box", scale: [link.box.size[0], link.box.size[1], link.box.size[2]] };
  if (link.cylinder) {
    const { radius, height } = link.cylinder;
    return { ...base, shape: "cylinder", scale: [radius, radius, height] };
  }
  if (link.sphere) return { ...base, shape: "sphere", scale: [link.sphere.radius, link.sphere.radius, link.sphere.radius] };
  if (link.capsule) {
    return { ...base, shape: `capsule ${link.capsule.radius} ${link.capsule.height}`, scale: [1, 1, 1] };
  }
  if (link.hull !== undefined) return { ...base, shape: `hull ${link.hull}`, scale: [1, 1, 1] };
  return null;
}

/** What makes foot-bots and e-pucks recognisable: tracks or wheels, a ring, and a wedge that points ahead. */
function robotParts(entity: Entity, link: Link): Part[] {
  const { radius, height } = link.cylinder ?? { radius: 0, height: 0 };
  if (radius === 0) return [];
  const isFootBot = entity.kind === Kind.footBot;
  const part = (shape: string, position: Vector, scale: Vector, color: number): Part =>
    ({ shape, link: entity.referenceLink, position, orientation: upright, scale, color, isDecoration: true });
  const parts = [
    part("wedge", [0.55 * radius, 0, height + 0.002], [0.3 * radius, 0.3 * radius, 0.004], 0xf2f3f5),
    part("ring", [0, 0, 0.82 * height], [1.0 * radius, 1.0 * radius, 0.5 * radius],
         isFootBot ? 0xc9ccd1 : 0x7fc46b),
  ];
  for (const side of [-1, 1]) {
    parts.push(isFootBot
      ? part("box", [0, side * 0.86 * radius, 0.0], [1.15 * radius, 0.3 * radius, 0.3 * height], 0x2b2d31)
      : part("box", [0, side * 0.98 * radius, 0.0], [1.0 * radius, 0.12 * radius, 0.7 * height], 0x2b2d31));
  }
  if (isFootBot) parts.push(part("cylinder", [0, 0, height], [0.22 * radius, 0.22 * radius, 0.5 * height], 0x3c4046));
  return parts;
}

/** All parts of a world, links first. Removed entities have none. */
export function partsOf(world: World): Part[] {
  const parts: Part[] = [];
  world.links.forEach((link, index) => {
    if (world.entities[link.entity]?.removed || !link.collides) return;
    const part = partOf(link, index);
    if (part) parts.push(part);
  });
  for (const entity of world.entities) {
    const isRobot = entity.kind === Kind.footBot || entity.kind === Kind.ePuck;
    const link = world.links[entity.referenceLink];
    if (isRobot && !entity.removed && link) parts.push(...robotParts(entity, link));
  }
  return parts;
}
