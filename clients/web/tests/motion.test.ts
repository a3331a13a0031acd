// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Poses } from "../source/model/messages";
import { Motion } from "../source/model/motion";
import { halfExtents, turn } from "../source/model/pose";

const quarter = [Math.SQRT1_2, 0, 0, Math.SQRT1_2]; // around z

function poses(x: number, orientation: number[]): Poses {
  return { tick: 0, positions: Float32Array.of(x, 0, 0), orientations: Float32Array.from(orientation) } as unknown as Poses;
}

function near(a: ArrayLike<number>, b: number[]): void {
  assert.equal(a.length, b.length);
  b.forEach((value, i) => assert.ok(Math.abs(a[i] - value) < 1e-6, `${Array.from(a)} is not ${b}`));
}

/** A body at 0 that is sent to 1 at 10.2 s, with ticks of 0.2 s. */
function moving(): Motion {
  const motion = new Motion();
  motion.take(poses(-1, [1, 0, 0, 0]), false, 2, 9.8);
  motion.take(poses(0, [1, 0, 0, 0]), false, 2, 10);
  motion.take(poses(1, quarter), true, 2, 10.2);
  return motion;
}

test("positions go straight and rotations turn evenly, and arrive when the next tick is due", () => {
  const motion = moving();
  motion.go(10.2);
  near(motion.shown!.positions, [0, 0, 0]);
  const gap = 0.2;
  motion.go(10.2 + gap / 3);
  near(motion.shown!.positions, [1 / 3, 0, 0]);
  near(motion.shown!.orientations, [Math.cos(Math.PI / 12), 0, 0, Math.sin(Math.PI / 12)]);
  assert.ok(motion.isMoving);
  assert.ok(motion.go(10.2001 + gap));
  assert.ok(!motion.isMoving);
  near(motion.shown!.positions, [1, 0, 0]);
  assert.ok(!motion.go(30));
});

test("ticks that come evenly are one tick late at most, and nothing jumps", () => {
  const motion = new Motion();
  let before = 0;
  for (let tick = 0; tick < 100; ++tick) {
    motion.take(poses(tick, [1, 0, 0, 0]), tick > 0, 2, 0.2 * tick);
    for (let part = 0; part < 10; ++part) {
      const time = tick + part / 10;
      motion.go(0.2 * time);
      const x = motion.shown!.positions[0];
      if (tick > 30) assert.ok(x >= time - 1 - 0.02 && x <= tick, `${x} at ${time}`);
      if (tick > 30) assert.ok(x - before < 0.11, `from ${before} to ${x}`);
      before = x;
    }
  }
});

test("a jump, another world and motion that is off show the tick at once", () => {
  const motion = moving();
  motion.take(poses(5, quarter), false, 2, 10.25);
  near(motion.shown!.positions, [5, 0, 0]);
  motion.take({ ...poses(0, quarter), positions: new Float32Array(6) } as Poses, true, 2, 10.4);
  assert.ok(!motion.isMoving);
  const off = moving();
  off.isOn = false;
  assert.ok(off.go(10.21));
  near(off.shown!.positions, [1, 0, 0]);
});

test("a step of a paused world takes no longer than it may", () => {
  const motion = moving();
  motion.take(poses(2, quarter), true, 0.15, 30);
  motion.go(30.1);
  assert.ok(motion.isMoving);
  motion.go(30.1501);
  assert.ok(!motion.isMoving);
});

test("orientations take the shorter way, also between a quaternion and its negative", () => {
  const to = new Float32Array(4);
  turn(to, [1, 0, 0, 0], [-1, 0, 0, 0], 0, 0.5);
  near(to, [1, 0, 0, 0]);
  turn(to, [1, 0, 0, 0], quarter.map((value) => -value), 0, 0.5);
  near(to, [Math.cos(Math.PI / 8), 0, 0, Math.sin(Math.PI / 8)]);
});

test("the box around a turned box", () => {
  near(halfExtents(quarter, [1, 2, 3]), [2, 1, 3]);
  const angle = Math.PI / 8; // half of 45 degrees
  near(halfExtents([Math.cos(angle), 0, 0, Math.sin(angle)], [1, 1, 3]), [Math.SQRT2, Math.SQRT2, 3]);
});
