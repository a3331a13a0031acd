// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { test } from "node:test";
import { PerspectiveCamera, Vector3 } from "three";
import { colorOf, palette } from "../source/drawing/colors";
import { makePoses, makeWorld } from "../source/data/generated";
import { Bodies } from "../source/drawing/bodies";
import { Detail, detailOf, isInside, ofProcessor, sizeOnScreen } from "../source/drawing/detail";
import { boxOf, firstBox, lookAt, Settling, wayToCamera, type Box } from "../source/drawing/framing";
import { marksOf, stepOf } from "../source/drawing/ground";
import { Lines } from "../source/drawing/lines";
import { drawMarkers } from "../source/drawing/overlays";
import { partsOf } from "../source/drawing/shapes";
import type { Poses, World } from "../source/model/messages";
import type { Pose, Vector } from "../source/model/pose";

const way: Vector = [0.55, -0.75, 0.62].map((value) => value / Math.hypot(0.55, 0.75, 0.62)) as Vector;

/** Where a camera sees the corners of a box, -1 to 1. */
function seenCorners({ low, high }: Box, fieldOfView: number, aspect: number): Vector3[] {
  const look = lookAt({ low, high }, way, fieldOfView, aspect);
  const camera = new PerspectiveCamera(fieldOfView, aspect, 0.001, 1000);
  camera.up.set(0, 0, 1);
  camera.position.set(...look.eye);
  camera.lookAt(...look.at);
  camera.updateMatrixWorld();
  return Array.from({ length: 8 }, (_, i) => new Vector3(...low.map((value, k) => ((i >> k) & 1 ? high[k] : value)) as Vector).project(camera));
}

test("a link is drawn by its size on the screen", () => {
  assert.equal(sizeOnScreen(0.1, 2, 600), 60);
  assert.equal(sizeOnScreen(0.1, -1, 600), Infinity); // around the camera, or beside it
  const { plain, whole } = ofProcessor;
  assert.deepEqual([0, plain - 0.1, plain, whole - 0.1, whole, Infinity].map((pixels) => detailOf(pixels, ofProcessor)),
                   [Detail.box, Detail.box, Detail.plain, Detail.plain, Detail.whole, Detail.whole]);
  assert.ok(isInside(Float64Array.of(1, 0, 0, -1), 0.9, 0, 0, 0.2));
  assert.ok(!isInside(Float64Array.of(1, 0, 0, -1), 0.7, 0, 0, 0.2));
});

test("bodies that are far are boxes, those out of view are none, and what is drawn can be picked", () => {
  const world = makeWorld(3) as unknown as World, poses = makePoses(3, 0) as unknown as Poses; // box, cylinder, sphere
  const bodies = new Bodies(true);
  bodies.setWorld(world, 30_000, ({ color }) => color);
  const camera = new PerspectiveCamera(45, 1, 0.001, 1000);
  camera.up.set(0, 0, 1);
  const lookFrom = (y: number): void => {
    camera.position.set(0, y, 0.5);
    camera.lookAt(0, 0, 0);
    bodies.setPoses(poses, camera, 600, false);
  };
  lookFrom(-0.5);
  assert.deepEqual([...bodies.details], [Detail.whole, Detail.whole, Detail.whole]);
  lookFrom(-1.5);
  assert.deepEqual([...bodies.details], [Detail.plain, Detail.plain, Detail.plain]);
  lookFrom(-30);
  assert.deepEqual([...bodies.details], [Detail.box, Detail.box, Detail.box]);
  camera.lookAt(0, -60, 0);
  bodies.setPoses(poses, camera, 600, false);
  assert.deepEqual([...bodies.details], [Detail.none, Detail.none, Detail.none]);
});

test("a camera sees all of a box, as large as it can be and in the middle", () => {
  for (const aspect of [0.4, 1, 2.5]) {
    for (const box of [{ low: [-2, -2, 0], high: [2, 2, 0.2] }, { low: [5, 1, 0], high: [5.1, 1.2, 3] }] as Box[]) {
      const corners = seenCorners(box, 45, aspect);
      const sides = (["x", "y"] as const).map((axis) => {
        const all = corners.map((corner) => corner[axis]);
        return [Math.min(...all), Math.max(...all)];
      });
      for (const [least, most] of sides) assert.ok(Math.abs(least + most) < 1e-3, `${least} to ${most}`);
      assert.ok(Math.abs(Math.max(sides[0][1], sides[1][1]) - 0.95) < 1e-3, `${sides}`);
    }
  }
});

test("the first view has the floor and what stands on it, of a far larger floor the middle", () => {
  const world = makeWorld(9) as unknown as World, poses = makePoses(9, 0) as unknown as Poses;
  const things = boxOf(world, poses, () => true)!;
  assert.ok(Math.abs(things.low[0] + 0.1424) < 0.003 && things.high[2] > 0.1);
  assert.equal(boxOf(world, poses, () => false), null);
  const box = firstBox(world, poses);
  assert.deepEqual([box.low[0], box.high[1], box.low[2]].map((value) => Math.round(100 * value)), [-16, 17, 0]);
  const wide = firstBox({ ...world, arenaSize: [50, 50, 1] }, poses);
  assert.ok(wide.high[0] < 0.3);
});

test("the first view is from higher in a tall picture", () => {
  const [wide, tall] = [wayToCamera(1.6), wayToCamera(0.5)];
  for (const way of [wide, tall]) assert.ok(Math.abs(Math.hypot(...way) - 1) < 1e-9);
  assert.ok(tall[2] > wide[2] && Math.abs(tall[0]) < Math.abs(wide[0]));
});

test("what falls settles once, and what never rests does not", () => {
  const settling = new Settling();
  const box = (height: number): Box => ({ low: [0, 0, 0], high: [1, 1, height] });
  const settled = Array.from({ length: 40 }, (_, tick) => settling.take(box(Math.max(0.1, 2 - 0.2 * tick)), 0.1 * tick));
  assert.equal(settled.filter(Boolean).length, 1);
  assert.ok(settled.indexOf(true) >= 14, `at ${settled.indexOf(true)}`);
  const restless = new Settling();
  for (let tick = 0; tick < 400; ++tick) assert.ok(!restless.take(box(1 + tick % 2), 0.1 * tick));
  assert.ok(restless.isOver);
});

test("scales have few round numbers", () => {
  assert.equal(stepOf(4, 8), 0.5);
  assert.equal(stepOf(17.9, 8), 5);
  assert.deepEqual(marksOf(-0.25, 0.25).map(({ text }) => text), ["\u22120.2", "\u22120.1", "0.0", "0.1", "0.2"]);
  assert.deepEqual(marksOf(-2, 2).map(({ text }) => text)[4], "0.0");
  assert.ok(marksOf(-1e4, 1e4).length <= 9);
});

test("robots are coloured by model or controller, other things as in the scene", () => {
  const world = makeWorld(4) as unknown as World;
  world.entities.forEach((entity, i) => { if (i > 0) Object.assign(entity, { robot: i - 1, model: i === 1 ? "a" : "b" }); });
  world.robots = ["x", "y", "x"].map((controller, i) => ({ entity: i + 1, description: { id: `r${i}`, controller } })) as World["robots"];
  const colors = (coloring: Parameters<typeof colorOf>[1]): number[] => partsOf(world).map(colorOf(world, coloring));
  const scene = world.links.map(({ color }) => color);
  assert.deepEqual(colors("scene"), scene);
  assert.deepEqual(colors("model"), [scene[0], palette[0], palette[1], palette[1]]);
  assert.deepEqual(colors("controller"), [scene[0], palette[0], palette[1], palette[0]]);
});

test("markers are drawn in the frame of the robot's origin", () => {
  const lines = new Lines();
  const turned: Pose = { position: [1, 0, 0], orientation: [Math.SQRT1_2, 0, 0, Math.SQRT1_2] }; // a quarter, about z
  const marker = { robot: 0, at: [0, 0, 0.5], to: [], radius: 0, text: "", color: 0xff0000 };
  drawMarkers([{ ...marker, to: [2, 0, 0.5] }, { ...marker, radius: 2 }, { ...marker, text: "a label's" }, { ...marker, robot: 1, radius: 1 }],
              (robot) => (robot === 0 ? turned : null), lines);
  lines.commit();
  const { geometry } = lines.object;
  const points = geometry.getAttribute("position");
  const near = (i: number, [x, y, z]: Vector): void => {
    assert.ok(Math.hypot(points.getX(i) - x, points.getY(i) - y, points.getZ(i) - z) < 1e-5, `${i}`);
  };
  near(0, [1, 0, 0.5]);
  near(1, [1, 2, 0.5]); // ahead of the robot is +y of the world
  assert.equal(geometry.drawRange.count, 2 * (5 + 32));
  for (let i = 10; i < 74; ++i) assert.ok(Math.abs(Math.hypot(points.getX(i) - 1, points.getY(i)) - 2) < 1e-5, "on the ring");
});
