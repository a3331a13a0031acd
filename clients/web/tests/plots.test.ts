// SPDX-License-Identifier: MIT
// Labels of series, their charts, their table; metrics.
import assert from "node:assert/strict";
import { test } from "node:test";
import { makeWorld } from "../source/data/generated";
import { chartOf, labelOf, longLabel } from "../source/model/labels";
import { JointType, type Description, type World } from "../source/model/messages";
import { metricsIn } from "../source/model/metrics";
import { plottable, Series } from "../source/model/series";
import { csvOf } from "../source/model/table";

const joints = [{ id: "base_wheel_fr", entity: 1, type: JointType.revolute }, { id: "lift", entity: 1, type: JointType.prismatic }];
const description = { id: "r:1", jointSensors: [{ id: "base_wheel_fr", mode: 3 }, { id: "lift", mode: 2 }],
  jointActuators: [{ id: "base_wheel_fr", mode: 3 }], proximitySensors: [{}, {}], radios: [], cameras: [], imus: [], contactSensors: [],
  leds: [], directionalLeds: [], tags: [], magnets: [] } as unknown as Description;
const world = { ...makeWorld(2), joints, robots: [{ entity: 1, description }] } as unknown as World;
const seen = { jointReadings: [1, 2], proximity: [0, 1], rangeAndBearing: [], radioMessages: [] };
const told = { jointTargets: [1], ledColors: [], directionalLedColors: [], wheelVelocities: [], rangeAndBearingData: [], radioMessages: [] };
const sensed = (path: string) => ({ topic: "/robots/r:1/observation", path });

test("a series has the label and unit of what was clicked", () => {
  const long = (path: string): string => longLabel(labelOf(sensed(path), world, seen)!);
  assert.equal(long("jointReadings.0"), "r:1 base_wheel_fr velocity [rad/s]");
  assert.equal(long("jointReadings.1"), "r:1 lift position [m]");
  assert.equal(long("proximity.1"), "r:1 Proximity 1");
  assert.equal(long("no.such"), "r:1 no.such");
  assert.equal(longLabel(labelOf({ topic: "/robots/r:1/command", path: "jointTargets.0" }, world, told)!), "r:1 base_wheel_fr velocity, commanded [rad/s]");
  assert.equal(longLabel(labelOf({ topic: "/poses", path: "positions.5" }, world, null)!), "e1 position z [m]");
  assert.equal(longLabel(labelOf({ topic: "/poses", path: "jointPositions.1" }, world, null)!), "e1 lift position [m]");
  assert.equal(longLabel(labelOf({ topic: "/phases", path: "solve" }, null, null)!), "tick solve [s]");
  assert.equal(longLabel(labelOf({ topic: "/metrics", path: "r:1/a.b" }, null, null)!), "r:1 a.b");
  assert.equal(labelOf(sensed("jointReadings.0"), null, null), null); // not known yet
});

test("series of one unit share a chart; without unit, those of one field", () => {
  const chart = (path: string): string => chartOf(sensed(path), labelOf(sensed(path), world, seen));
  assert.equal(chart("jointReadings.0"), chartOf({ topic: "/robots/r:1/command", path: "jointTargets.0" }, { of: "", text: "", unit: "rad/s" }));
  assert.notEqual(chart("jointReadings.0"), chart("jointReadings.1"));
  assert.equal(chart("proximity.0"), chart("proximity.1"));
  assert.notEqual(chart("proximity.0"), chart("batteries.0"));
});

test("metrics of a running world and of a recording are series by ROBOT/NAME", () => {
  const live = { tick: 3, values: { "r.1/blocks": 2, "director/score.a": 0.5 } };
  const recorded = { tick: 3, metrics: [{ robot: "r.1", name: "blocks", value: 4 }] };
  assert.deepEqual(plottable("/metrics", live), [{ path: "r.1/blocks", value: 2 }, { path: "director/score.a", value: 0.5 }]);
  assert.deepEqual(metricsIn(recorded), [{ path: "r.1/blocks", value: 4 }]);
  const series = new Series({ topic: "/metrics", path: "r.1/blocks" });
  series.add(0, 0, live);
  series.add(1, 0.1, { metrics: [] }); // it holds until it is set again
  series.add(2, 0.2, recorded);
  assert.deepEqual([series.sequences, series.values], [[0, 2], [2, 4]]);
});

test("a table has a row for each frame, and no formulas", () => {
  const a = new Series({ topic: "/t", path: "a" }), b = new Series({ topic: "/t", path: "b" });
  a.add(0, 0, { a: 1 });
  a.add(1, 0.1, { a: 0.1 + 0.2 });
  b.add(1, 0.1, { b: -2 });
  b.add(2, 0.2, {});
  assert.equal(csvOf([a, b], ["=r1 \"x\", y [m]", "b"]), 'time [s],"\'=r1 ""x"", y [m]",b\n0,1,\n0.1,0.30000000000000004,-2\n0.2,,\n');
});
