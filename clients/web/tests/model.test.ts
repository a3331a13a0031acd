// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Points } from "three";
import { Detail } from "../source/drawing/detail";
import { Lights } from "../source/drawing/lights";
import { patternOf } from "../source/drawing/tags";
import { cornersAt } from "../source/drawing/overlays";
import { mergedGeometry, roomFor } from "../source/drawing/merged";
import { levels, Quality, roundness } from "../source/drawing/quality";
import { makeGeometry, partsOf } from "../source/drawing/shapes";
import { makeWorld } from "../source/data/generated";
import type { Camera, Description, Log, Observation, Poses, World } from "../source/model/messages";
import { isPictureOf } from "../source/model/pictures";
import { compose, rotate } from "../source/model/pose";
import { bytesText, fixed, observed } from "../source/model/readings";
import { nameOf, numberAt, numbersIn, parseName } from "../source/model/series";
import { beginning, visible } from "../source/model/texts";
import { fromAddress, settingsAtFirst, toAddress } from "../source/model/settings";
import { LogLines, mostLines } from "../source/model/log";

function near(a: ArrayLike<number>, b: number[], bound = 1e-12): void {
  assert.equal(a.length, b.length);
  b.forEach((value, i) => assert.ok(Math.abs(a[i] - value) < bound, `${Array.from(a)} is not ${b}`));
}

test("a zero has no sign", () => {
  assert.equal(fixed(-2.5e-8, 4), "0.0000");
  assert.equal(fixed(-0.00012, 4), "-0.0001");
  assert.equal(fixed(1.25, 1), "1.3");
});

test("rotations are Hamilton's, w first", () => {
  const half = Math.SQRT1_2;
  near(rotate([half, 0, 0, half], [1, 0, 0]), [0, 1, 0]); // a quarter about z
  const pose = compose({ position: [1, 2, 3], orientation: [half, 0, 0, half] },
                       { position: [1, 0, 0], orientation: [half, half, 0, 0] });
  near(pose.position, [1, 3, 3]);
  near(rotate(pose.orientation, [0, 0, 1]), [1, 0, 0]); // about x first: -y; then about z: +x
});

test("what is not seen, or changes the order of a text, is shown as its number", () => {
  assert.equal(visible("r1\u202e3\u2066\u200b\ufeff"), "r1\\u202e3\\u2066\\u200b\\ufeff");
  assert.equal(visible("\u{e0041}\u001b[2J\u0085"), "\\ue0041\\u001b[2J\\u0085");
  assert.equal(visible("déjà vu: 機械\t🤖\n"), "déjà vu: 機械\t🤖\n");
  assert.equal(beginning("a\u202ebc", 3), "a\\u202eb…");
  assert.equal(beginning(beginning("\u202e")), beginning("\u202e"));
});

test("settings come back from the address", () => {
  const settings = { ...settingsAtFirst(), look: { eye: [1, 2, 3] as [number, number, number], at: [0, 0, 0.5] as [number, number, number], fieldOfView: 50 },
                     selected: "a b&c#d", trailed: ["r1", "r2"], tab: "plots" as const, theme: "dark" as const,
                     layers: ["bodies" as const, "contacts" as const], followed: "r1",
                     plots: [{ topic: "/robots/a:b/observation", path: "jointReadings.0" }] };
  assert.deepEqual(fromAddress(`#${toAddress(settings)}`), settings);
  assert.deepEqual(fromAddress(""), settingsAtFirst());
  assert.equal(fromAddress("#eye=1,2&at=x&tab=nothing").look, null);
  assert.equal(toAddress(settingsAtFirst()), "");
});

test("numbers by their paths", () => {
  const value = { a: [1, { b: 2n }], ok: true, text: "x", list: new Float32Array([0.5]) };
  assert.equal(numberAt(value, "a.1.b"), 2);
  assert.equal(numberAt(value, "ok"), 1);
  assert.equal(numberAt(value, "text"), null);
  assert.equal(numberAt(value, "a.9.b"), null);
  assert.deepEqual(numbersIn(value).map(({ path }) => path), ["a.0", "a.1.b", "ok", "list.0"]);
  assert.equal(numbersIn(value, 2).length, 2);
  const name = { topic: "/robots/r:1/observation", path: "imus.3" };
  assert.deepEqual(parseName(nameOf(name)), name);
});

test("numbers of a message with millions of parts are found without going through it", () => {
  const segments = new Float32Array(16_000_000);
  const contacts = Array.from({ length: 2_000_000 }, () => ({ name: "no number" }));
  const begin = process.cpuUsage(); // other programs run beside
  assert.equal(numbersIn({ segments }).length, 500);
  assert.equal(numbersIn({ contacts, tick: 1 }).length, 0);
  const used = process.cpuUsage(begin);
  const took = (used.user + used.system) / 1000;
  assert.ok(took < 300, `${took.toFixed(0)} ms`);
});

const robot = { id: "r", jointSensors: [{ id: "lift", mode: 2 }, { id: "wheel", mode: 3 }], jointActuators: [], radios: [{ id: "wifi" }],
  leds: [], directionalLeds: [], tags: [], magnets: [], proximitySensors: [{ range: 0.1 }], positioning: false,
  battery: true, cameras: [], imus: [], contactSensors: [], params: [] } as unknown as Description;

test("devices that describe themselves are named by their description", () => {
  const deviceKinds = [
    { name: "lamp", readings: [{ name: "value", unit: "" }, { name: "heat", unit: "K" }], commands: [], mostRows: 0,
      devices: [{ id: "left" }, { id: "" }] },
    { name: "ear", readings: [{ name: "pitch", unit: "Hz" }], commands: [], mostRows: 9, devices: [{ id: "" }] }];
  const seen = { jointReadings: [], proximity: [], batteries: [], rangeAndBearing: [], radioMessages: [],
    deviceReadings: [1, 2, 3, 4], deviceRows: [2], deviceRowValues: [440, 880] } as unknown as Observation;
  const groups = observed("/t", { ...robot, deviceKinds } as Description, seen, () => undefined);
  const lamp = groups.find((one) => one.device === "lamp");
  assert.deepEqual(lamp?.readings.map(({ label, value }) => [label, value]),
                   [["left value", 1], ["left heat", 2], ["1 value", 3], ["1 heat", 4]]);
  assert.equal(lamp?.readings[3].series?.path, "deviceReadings.3");
  const ear = groups.find((one) => one.device === "ear");
  assert.deepEqual(ear?.readings.map(({ text }) => text), ["2.0000", "pitch 440.0000 Hz", "pitch 880.0000 Hz"]);
});

test("of the readings of a device the first are made, and the others are counted", () => {
  const packet = { range: 1, horizontalBearing: 0, verticalBearing: 0, data: new Uint8Array(1) };
  const many = 1_000_000;
  const seen = { jointReadings: [], proximity: [], batteries: [], rangeAndBearing: Array(many).fill(packet),
    radioMessages: Array(many).fill({ radio: 0, payload: new Uint8Array(4) }), imus: new Float32Array(6 * many) } as unknown as Observation;
  const begin = process.cpuUsage();
  const groups = observed("/t", { ...robot, imus: Array(many).fill({ id: "i" }) } as Description, seen, () => undefined);
  const used = process.cpuUsage(begin);
  for (const device of ["Radio", "Range and bearing"]) {
    const group = groups.find((one) => one.device === device);
    assert.equal(group?.readings.length, 300);
    assert.equal(group?.more, many - 300);
  }
  assert.ok(used.user + used.system < 300_000, `${used.user + used.system} us`);
});

test("a picture of another size than the camera's is not decoded", () => {
  const head = (width: number, height: number): Uint8Array => {
    const bytes = new DataView(new ArrayBuffer(33));
    [0x89504e47, 0x0d0a1a0a, 13, 0x49484452, width, height].forEach((word, i) => bytes.setUint32(4 * i, word));
    return new Uint8Array(bytes.buffer);
  };
  const camera = { width: 64, height: 48 };
  assert.ok(isPictureOf(head(64, 48), camera));
  assert.ok(!isPictureOf(head(48, 64), camera));
  assert.ok(!isPictureOf(head(60_000, 60_000), camera));
  assert.ok(!isPictureOf(head(64, 48).subarray(0, 20), camera));
  assert.ok(!isPictureOf(new TextEncoder().encode("<svg xmlns='http://www.w3.org/2000/svg'/>"), camera));
});

test("readings by device have names, limits and places", () => {
  const seen = { jointReadings: [0.02, 1], proximity: [0.5], batteries: [0.9, Infinity], rangeAndBearing: [],
    radioMessages: [{ radio: 0, payload: new TextEncoder().encode("hi") }] } as unknown as Observation;
  const groups = observed("/t", robot, seen, (id) => ({ type: id === "lift" ? 3 : 4, lower: 0, upper: 0.1 }));
  assert.deepEqual(groups.map(({ device }) => device), ["Joints", "Proximity", "Battery", "Radio"]);
  assert.deepEqual(groups[0].readings[0].range, [0, 0.1]);
  assert.equal(groups[0].readings[1].range, undefined); // a speed has no limits
  assert.deepEqual(groups[0].readings[1].series, { topic: "/t", path: "jointReadings.1" });
  assert.equal(groups[2].readings[1].text, "∞");
  assert.equal(groups[3].readings[0].text, "“hi”  68 69");
  assert.equal(bytesText(new Uint8Array([0, 255])), "00 ff");
});

test("LEDs of a robot that is far are one point for each colour, and none for those that are off", () => {
  const mount = { link: 0, position: [0, 0, 0], orientation: [1, 0, 0, 0] };
  const lights = new Lights();
  lights.setWorld({ entities: [{ kind: 5 }], leds: Array(12).fill({ mount, entity: 0 }), directionalLeds: [] } as unknown as World);
  const points = (detail: Detail, ledColors: number[]): number => {
    const poses = { positions: [0, 0, 0], orientations: [1, 0, 0, 0], ledColors, directionalLedColors: [] } as unknown as Poses;
    lights.setPoses(poses, Uint8Array.of(detail));
    return (lights.group.children[0] as Points).geometry.drawRange.count;
  };
  const half = Array.from({ length: 12 }, (_, i) => (i < 6 ? 0xff : 0));
  assert.deepEqual([points(Detail.whole, half), points(Detail.box, half), points(Detail.none, half)], [12, 1, 0]);
  assert.equal(points(Detail.box, [1, 1, 1, 2, 2, 2, 3, 3, 3, 0, 0, 0]), 3);
});

test("tags: only integers below the number of patterns", () => {
  const bytes = (text: string): Uint8Array => new TextEncoder().encode(text);
  assert.equal(patternOf(bytes("1"), [5, 6]), 6);
  assert.equal(patternOf(bytes("2"), [5, 6]), null);
  assert.equal(patternOf(bytes("x"), [5, 6]), null);
  assert.equal(patternOf(bytes(""), [5, 6]), null);
});

test("a camera's corners by its focal length and principal point", () => {
  const camera = { focalLength: [100, 200], principalPoint: [50, 40], width: 160, height: 120 } as unknown as Camera;
  near(cornersAt(camera, 2)[0], [-1, -0.4, 2]);
  near(cornersAt(camera, 2)[2], [2.2, 0.8, 2]);
});

test("removed entities have no parts, foot-bots have more than their links", () => {
  const world = makeWorld(3) as unknown as World;
  assert.equal(partsOf(world).length, 3);
  world.entities[0].removed = true;
  assert.equal(partsOf(world).length, 2);
  world.entities[1].kind = 5;
  assert.ok(partsOf(world).length > 4);
});

test("quality falls where frames are slow and does not swing", () => {
  const quality = new Quality(1, 1);
  const note = (seconds: number, times: number): void => { for (let i = 0; i < times; ++i) quality.note(seconds); };
  note(0.2, 200);
  assert.equal(quality.level, levels.length - 1);
  for (let i = 0; i < 20; ++i) {
    note(0.005, 12);
    note(0.2, 12);
  }
  assert.equal(quality.level, levels.length - 1);
});

test("frames that take seconds lower the quality at once, and many round shapes get fewer pieces", () => {
  const quality = new Quality(2, 1);
  quality.note(1.3);
  assert.equal(quality.note(1.3), true);
  assert.equal(quality.level, 3);
  assert.equal(roundness(100, 1_000_000), 36);
  assert.ok(334 * roundness(334, 50_000) ** 2 <= 50_000);
  assert.equal(roundness(100_000, 1000), 6);
});

test("a merged mesh has each copy's corners and number", () => {
  const box = makeGeometry("box", [], 8);
  const vertices = box.getAttribute("position").count, corners = box.index!.count;
  const merged = mergedGeometry(box, 2);
  const of = (name: string, i: number): number[] => {
    const { array, itemSize } = merged.getAttribute(name);
    return Array.from(array.slice(i * itemSize, (i + 1) * itemSize));
  };
  assert.equal(merged.getAttribute("position").count, 2 * vertices);
  assert.equal(merged.index!.count, 2 * corners);
  for (const name of ["position", "normal"]) assert.deepEqual(of(name, vertices + 3), of(name, 3));
  assert.deepEqual([of("copy", vertices - 1), of("copy", vertices)], [[0], [1]]);
  assert.equal(merged.index!.array[corners + 5], box.index!.array[5] + vertices);
  assert.deepEqual([1, 256, 257].map(roomFor), [256, 256, 512]);
});

test("a log keeps its newest lines, and counts those that it does not", () => {
  const log = new LogLines();
  for (let i = 0; i < mostLines + 1; ++i) log.add({ level: 2, name: "robot", message: `line ${i}` } as Log, i, 0.1 * i);
  assert.equal(log.lost, 1000);
  assert.equal(log.entries.length, mostLines + 1 - log.lost);
  assert.equal(log.entries[0].text, "line 1000");
  assert.equal(log.entries.at(-1)!.text, `line ${mostLines}`);
});
