// SPDX-License-Identifier: MIT
// The shapes of links as triangles: unit shapes that stand on the centre of their bottom, and hulls and
// capsules in their own size.
import * as three from "three";
import { isRobot, Kind, type Entity, type Hull, type Link, type World } from "../model/messages";
import { transform, type Quaternion, type Vector } from "../model/pose";

/** A piece of what is drawn: a shape that moves with a link. */
export interface Part {
  shape: string; // key of its geometry
  link: number;
  position: Vector; // in the frame of the link [m]
  orientation: Quaternion;
  scale: Vector;
  color: number; // sRGB
  isDecoration: boolean; // the world does not have it
  isSmall: boolean; // seen from near only
}

/** Whether a shape takes more triangles to look round. */
export function isRound(shape: string): boolean { return /^(cylinder|wheel|sphere|capsule)/.test(shape); }

const upright: Quaternion = [1, 0, 0, 0];

/** The geometry with that key. @param around  pieces around what is round */
export function makeGeometry(key: string, hulls: Hull[], around: number): three.BufferGeometry {
  const [name, a, b] = key.split(" ");
  switch (name) {
    case "box": return new three.BoxGeometry(1, 1, 1).translate(0, 0, 0.5);
    case "cylinder": return new three.CylinderGeometry(1, 1, 1, around).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    case "sphere": return new three.SphereGeometry(1, around, Math.round(around / 2)).rotateX(Math.PI / 2).translate(0, 0, 1);
    case "wheel": return new three.CylinderGeometry(1, 1, 1, around); // its axle is y
    case "arrow": return arrow();
    case "capsule": return capsule(Number(a), Number(b), around);
    default: return hullGeometry(hulls[Number(a)]);
  }
}

function capsule(radius: number, height: number, around: number): three.BufferGeometry {
  const straight = Math.max(height - 2 * radius, 0);
  return new three.CapsuleGeometry(radius, straight, Math.round(around / 4), around).rotateX(Math.PI / 2).translate(0, 0, height / 2);
}

/** A flat one, along +x, on the plane z = 0. */
function arrow(): three.BufferGeometry {
  const vertices = [0, 1].flatMap((z) => [1, 0, z, -0.7, 0.8, z, -0.35, 0, z, -0.7, -0.8, z]);
  const sides = [0, 1, 2, 3].flatMap((i) => { const next = (i + 1) % 4; return [i, next, i + 4, next, next + 4, i + 4]; });
  return hullGeometry({ vertices, triangles: [4, 5, 6, 4, 6, 7, ...sides] });
}

function hullGeometry(hull: Hull | undefined): three.BufferGeometry {
  const indexed = new three.BufferGeometry();
  indexed.setAttribute("position", new three.BufferAttribute(Float32Array.from(hull?.vertices ?? []), 3));
  indexed.setIndex(Array.from(hull?.triangles ?? []));
  const geometry = indexed.toNonIndexed(); // flat faces
  geometry.computeVertexNormals();
  return geometry;
}

/** The box around a part: its sides, and its centre and the middle of its bottom in the frame of the link [m]. */
export function boundsOf({ shape, scale, position, orientation }: Part, hulls: Hull[]): { size: Vector; center: Vector; foot: Vector } {
  const [name, a, b] = shape.split(" ");
  let low: Vector = [-scale[0], -scale[1], 0], high: Vector = [scale[0], scale[1], scale[2]];
  if (name === "box") [low, high] = [[-scale[0] / 2, -scale[1] / 2, 0], [scale[0] / 2, scale[1] / 2, scale[2]]];
  if (name === "sphere") high = [scale[0], scale[1], 2 * scale[2]];
  if (name === "wheel") [low, high] = [[-scale[0], -scale[1] / 2, -scale[2]], [scale[0], scale[1] / 2, scale[2]]];
  if (name === "capsule") [low, high] = [[-Number(a), -Number(a), 0], [Number(a), Number(a), Number(b)]];
  if (name === "hull") {
    const vertices = hulls[Number(a)]?.vertices ?? [];
    [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (let i = 0; i < vertices.length; ++i) {
      low[i % 3] = Math.min(low[i % 3], vertices[i]);
      high[i % 3] = Math.max(high[i % 3], vertices[i]);
    }
    if (vertices.length === 0) low = high = [0, 0, 0];
  }
  const middle = low.map((value, i) => (value + high[i]) / 2) as Vector;
  const pose = { position, orientation };
  return { size: high.map((value, i) => value - low[i]) as Vector, center: transform(pose, middle),
           foot: transform(pose, [middle[0], middle[1], low[2]]) };
}

function partOf(link: Link, index: number): Part | null {
  const base = { link: index, position: [0, 0, 0] as Vector, orientation: upright, color: link.color,
                 isDecoration: false, isSmall: false };
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

const dark = 0x2b2d31, grey = 0x54585f;

/** What makes robots recognisable, by radius r and height h of their bodies. */
function robotParts(entity: Entity, link: Link): Part[] {
  const { radius: r, height: h } = link.cylinder ?? { radius: 0, height: 0 };
  if (r === 0) return [];
  const part = (shape: string, position: Vector, scale: Vector, color: number, isSmall = false): Part =>
    ({ shape, link: entity.referenceLink, position, orientation: upright, scale, color, isDecoration: true, isSmall });
  const sides = [-1, 1];
  if (entity.kind === Kind.footBot) {
    return [
      ...sides.map((side) => part("box", [0, side * 0.84 * r, 0], [1.3 * r, 0.36 * r, 0.27 * h], dark)), // tracks
      part("cylinder", [0, 0, 0.28 * h], [1.01 * r, 1.01 * r, 0.04 * h], grey, true),
      part("cylinder", [0, 0, 0.52 * h], [1.03 * r, 1.03 * r, 0.12 * h], 0xc9ccd1), // the ring of LEDs
      part("cylinder", [0, 0, h], [0.34 * r, 0.34 * r, 0.15 * h], dark, true), // the camera that looks up
      part("arrow", [0.66 * r, 0, h], [0.22 * r, 0.26 * r, 0.012 * h], 0xf2f3f5),
    ];
  }
  if (entity.kind === Kind.kilobot) return [part("arrow", [0.5 * r, 0, h], [0.3 * r, 0.36 * r, 0.02 * h], dark)];
  if (![Kind.ePuck, Kind.piPuck, Kind.khepera].includes(entity.kind)) { // they fly
    return [
      ...sides.flatMap((x) => sides.map((y) =>
        part("cylinder", [0.62 * x * r, 0.62 * y * r, h], [0.4 * r, 0.4 * r, 0.05 * h], grey))), // rotors
      part("arrow", [0.3 * r, 0, h], [0.22 * r, 0.26 * r, 0.1 * h], 0xf2f3f5),
    ];
  }
  return [
    ...sides.map((side) => part("wheel", [0, side * 0.99 * r, 0.585 * r], [0.585 * r, 0.12 * r, 0.585 * r], dark)),
    part("cylinder", [0, 0, 0.8 * h], [1.02 * r, 1.02 * r, 0.06 * h], 0x2f8a55), // the upper board
    part("cylinder", [0, 0, h], [0.42 * r, 0.42 * r, 0.12 * h], dark, true), // the loudspeaker
    part("box", [0.97 * r, 0, 0.42 * h], [0.14 * r, 0.26 * r, 0.2 * h], dark, true), // the camera
    part("arrow", [0.7 * r, 0, h], [0.2 * r, 0.24 * r, 0.03 * h], 0xf2f3f5),
  ];
}

/** All parts of a world, link by link, its own first. Removed entities have none. */
export function partsOf(world: World): Part[] {
  const parts: Part[] = [];
  world.links.forEach((link, index) => {
    if (world.entities[link.entity]?.removed || !link.collides) return;
    const part = partOf(link, index);
    if (part) parts.push(part);
  });
  for (const entity of world.entities) {
    const link = world.links[entity.referenceLink];
    if (isRobot(entity.kind) && !entity.removed && link) parts.push(...robotParts(entity, link));
  }
  return parts.sort((a, b) => a.link - b.link); // it is stable: the link's own part stays first
}
