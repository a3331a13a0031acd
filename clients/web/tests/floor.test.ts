// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { test } from "node:test";
import { regionsOf } from "../source/drawing/floor";

test("painted regions are drawn with y downwards, in the order of painting", () => {
  const regions = regionsOf([1, 2, 0.5, 0.25, 0, 0x123456, -1, 0, 0.1, 0.1, 1, 0xff], [-2, -2], [2, 4], [100, 50]);
  assert.deepEqual(regions, [
    { x: 300, y: 100, halfX: 50, halfY: 12.5, isDisc: false, color: "#123456" },
    { x: 100, y: 200, halfX: 10, halfY: 5, isDisc: true, color: "#0000ff" },
  ]);
});

test("half a region is none", () => {
  assert.deepEqual(regionsOf([1, 2, 3], [0, 0], [1, 1], [1, 1]), []);
});
