// SPDX-License-Identifier: MIT
// Readings and commands of one robot, device by device, with the place of each number in its message,
// so that it can be plotted.
import { JointType, type Command, type Description, type DeviceField, type DeviceKind, type Floats, type Joint, type Observation, type World }
  from "./messages";
import { beginning } from "./texts";

const mostLetters = 200; // of bytes that are text

export interface Reading {
  label: string;
  text: string;
  value?: number;
  range?: [number, number]; // of a bar
  series?: { topic: string; path: string };
  name?: string; // of the series, without its robot and unit
  unit?: string;
}
export interface Group { device: string; readings: Reading[]; more: number } // so many more are not made

/** Readings of a device that are made, and devices: a message of a stranger may have millions. */
export const mostReadings = 300;

/** Bytes as text where they are printable, and as hex. */
export function bytesText(bytes: Uint8Array): string {
  const hex = Array.from(bytes.slice(0, 48), (byte) => byte.toString(16).padStart(2, "0")).join(" ");
  const more = bytes.length > 48 ? " …" : "";
  const first = bytes.subarray(0, mostLetters + 1);
  const isPrintable = first.length > 0 && first.every((byte) => byte >= 32 && byte < 127);
  return isPrintable ? `“${beginning(new TextDecoder().decode(first), mostLetters)}”  ${hex}${more}` : hex + more || "(empty)";
}

/** With so many digits; a zero has no sign: what stands on the floor is pressed in by some nanometres. */
export function fixed(value: number, digits: number): string {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? (0).toFixed(digits) : text;
}

export function number(value: number, unit = ""): string {
  if (!Number.isFinite(value)) return value > 0 ? "∞" : String(value);
  const text = Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-4) ? value.toExponential(2)
                                                                                 : value.toFixed(4);
  return unit ? `${text} ${unit}` : text;
}

/** Adds readings of one message; `group` collects them by device. */
class Collector {
  groups: Group[] = [];
  /** @param suffix  of the names of series */
  constructor(private readonly topic: string, private readonly suffix = "") {}

  group(device: string): Group {
    let found = this.groups.find((group) => group.device === device);
    if (!found) this.groups.push(found = { device, readings: [], more: 0 });
    return found;
  }

  /** The first ones of what a device has. */
  first<T>(device: string, list: ArrayLike<T>): T[] {
    if (list.length > mostReadings) this.group(device).more += list.length - mostReadings;
    return Array.from({ length: Math.min(list.length, mostReadings) }, (_, i) => list[i]);
  }

  add(device: string, label: string, field: string, values: Floats, index: number, unit = "",
      range?: [number, number]): void {
    if (index >= values.length) return;
    const value = values[index];
    const name = (device === "Joints" ? label : `${device} ${label}`) + this.suffix;
    this.group(device).readings.push({ label, value, text: number(value, unit), range, name, unit,
                                       series: { topic: this.topic, path: `${field}.${index}` } });
  }
}

const modes = ["", "disabled", "position", "velocity"];
const turretModes = ["", "passive", "position", "speed"];
const axes = ["x", "y", "z"];

/** The joint of a robot with that id. */
export type Joints = (id: string) => Pick<Joint, "type" | "lower" | "upper"> | undefined;

export function jointsOf(world: World, entity: number): Joints {
  return (id) => world.joints.find((joint) => joint.entity === entity && joint.id === id);
}

/** Unit of a joint's position or velocity; empty: it is not known. */
function unitOf(joint: ReturnType<Joints>, mode: number): string {
  const unit = joint?.type === JointType.prismatic ? "m" : joint?.type === JointType.revolute ? "rad" : "";
  return unit !== "" && modes[mode] === "velocity" ? `${unit}/s` : unit;
}

function limitsOf(joint: ReturnType<Joints>): [number, number] | undefined {
  return joint?.lower !== undefined && joint.upper !== undefined ? [joint.lower, joint.upper] : undefined;
}

function addJoints(out: Collector, list: { id: string; mode: number }[], field: string, values: Floats, joints: Joints): void {
  out.first("Joints", list).forEach(({ id, mode }, i) => {
    const joint = joints(id);
    out.add("Joints", `${id} ${modes[mode] ?? ""}`, field, values, i, unitOf(joint, mode), mode === 2 ? limitsOf(joint) : undefined);
  });
}

export function observed(topic: string, robot: Description, o: Observation, joints: Joints): Group[] {
  const out = new Collector(topic);
  addJoints(out, robot.jointSensors, "jointReadings", o.jointReadings, joints);
  out.first("Proximity", robot.proximitySensors).forEach((_, i) => out.add("Proximity", `${i}`, "proximity", o.proximity, i, "", [0, 1]));
  if (robot.positioning) {
    axes.forEach((axis, i) => out.add("Position", axis, "positioning", o.positioning, i, "m"));
    ["w", "x", "y", "z"].forEach((axis, i) => out.add("Position", `q${axis}`, "positioning", o.positioning, 3 + i));
  }
  if (robot.battery) {
    out.add("Battery", "charge", "batteries", o.batteries, 0, "", [0, 1]);
    out.add("Battery", "time left", "batteries", o.batteries, 1, "s");
  }
  if (robot.wheels?.measures) {
    ["left", "right"].forEach((side, i) => out.add("Wheels", `speed ${side}`, "wheels", o.wheels, i, "m/s"));
    ["left", "right"].forEach((side, i) => out.add("Wheels", `distance ${side}`, "wheels", o.wheels, 2 + i, "m"));
  }
  if (robot.turret?.measures) out.add("Turret", "rotation", "turretRotations", o.turretRotations, 0, "rad");
  robot.imus.slice(0, mostReadings).forEach(({ id }, k) => {
    axes.forEach((axis, i) => out.add(`IMU ${id}`, `acceleration ${axis}`, "imus", o.imus, 6 * k + i, "m/s²"));
    axes.forEach((axis, i) => out.add(`IMU ${id}`, `turning ${axis}`, "imus", o.imus, 6 * k + 3 + i, "rad/s"));
  });
  robot.contactSensors.slice(0, mostReadings).forEach(({ id }, k) => {
    out.add(`Contact ${id}`, "touches", "contactSensors", o.contactSensors, 5 * k);
    axes.forEach((axis, i) => out.add(`Contact ${id}`, `force ${axis}`, "contactSensors", o.contactSensors, 5 * k + 1 + i, "N"));
    out.add(`Contact ${id}`, "strength", "contactSensors", o.contactSensors, 5 * k + 4, "N");
  });
  addDescribed(out, robot, "deviceReadings", o.deviceReadings, (kind) => kind.mostRows > 0 ? [] : kind.readings);
  addRows(out, robot, o);
  addCounts(out, robot, o);
  for (const { radio, payload } of out.first("Radio", o.radioMessages)) {
    out.group("Radio").readings.push({ label: `${robot.radios[radio]?.id ?? radio} got`, text: bytesText(payload) });
  }
  out.first("Range and bearing", o.rangeAndBearing).forEach((packet, i) => out.group("Range and bearing").readings.push({
    label: `packet ${i}`,
    text: `${number(packet.range, "m")}  ${number(packet.horizontalBearing, "rad")}  ${bytesText(packet.data)}`,
  }));
  return out.groups;
}

/** Values of devices that describe themselves, in the order of their descriptions. */
function addDescribed(out: Collector, robot: Description, field: string, values: Floats,
                      fieldsOf: (kind: DeviceKind) => DeviceField[]): void {
  let place = 0;
  for (const kind of robot.deviceKinds ?? []) {
    const fields = fieldsOf(kind);
    if (fields.length === 0) continue;
    out.first(kind.name, kind.devices).forEach(({ id }, i) => fields.forEach(({ name, unit }, k) =>
      out.add(kind.name, `${id || i} ${name}`, field, values, place + i * fields.length + k, unit)));
    place += kind.devices.length * fields.length;
  }
}

/** Devices that read any number of rows: how many, and what they are. */
function addRows(out: Collector, robot: Description, o: Observation): void {
  let list = 0, first = 0;
  for (const kind of (robot.deviceKinds ?? []).filter(({ mostRows }) => mostRows > 0)) {
    for (const { id } of out.first(kind.name, kind.devices)) {
      const rows = o.deviceRows[list] ?? 0;
      out.add(kind.name, `${id} rows`.trim(), "deviceRows", o.deviceRows, list++);
      for (const row of out.first(kind.name, Array.from({ length: Math.min(rows, mostReadings + 1) }, (_, i) => i))) {
        const text = kind.readings.map(({ name, unit }, k) =>
          `${name} ${number(o.deviceRowValues[first + row * kind.readings.length + k] ?? NaN, unit)}`).join("  ");
        out.group(kind.name).readings.push({ label: `${row}`, text });
      }
      first += rows * kind.readings.length;
    }
  }
}

/** Numbers of LEDs and tags that each camera sees. */
function addCounts(out: Collector, robot: Description, o: Observation): void {
  let leds = 0, directional = 0, tags = 0;
  for (const camera of robot.cameras.slice(0, mostReadings)) {
    const device = `Camera ${camera.id}`;
    if (camera.detectsLeds) out.add(device, "LEDs seen", "ledCounts", o.ledCounts, leds++);
    if (camera.detectsDirectionalLeds) {
      out.add(device, "directional LEDs seen", "directionalLedCounts", o.directionalLedCounts, directional++);
    }
    if (camera.detectsTags) out.add(device, "tags seen", "tagCounts", o.tagCounts, tags++);
  }
}

export function commanded(topic: string, robot: Description, c: Command, joints: Joints): Group[] {
  const out = new Collector(topic, ", commanded");
  addJoints(out, robot.jointActuators, "jointTargets", c.jointTargets, joints);
  out.first("Magnets", robot.magnets).forEach(({ id }, i) => out.add("Magnets", id || `${i}`, "magnetCurrents", c.magnetCurrents, i));
  const color = (values: Floats, i: number): string => `#${(values[i] ?? 0).toString(16).padStart(6, "0")}`;
  out.first("LEDs", robot.leds.slice(0, c.ledColors.length)).forEach(({ id }, i) =>
    out.group("LEDs").readings.push({ label: id || `${i}`, text: color(c.ledColors, i) }));
  out.first("Directional LEDs", robot.directionalLeds.slice(0, c.directionalLedColors.length)).forEach(({ id }, i) =>
    out.group("Directional LEDs").readings.push({ label: id || `${i}`, text: color(c.directionalLedColors, i) }));
  const payloads = c.tagPayloads ?? [];
  out.first("Tags", robot.tags.slice(0, payloads.length)).forEach(({ id }, i) =>
    out.group("Tags").readings.push({ label: id || `${i}`, text: bytesText(payloads[i]) }));
  if (robot.wheels?.drives) {
    ["left", "right"].forEach((side, i) => out.add("Wheels", side, "wheelVelocities", c.wheelVelocities, i, "m/s"));
  }
  if (robot.turret?.drives && c.turretModes.length > 0) {
    out.group("Turret").readings.push({ label: "mode", text: turretModes[c.turretModes[0]] ?? "?" });
    out.add("Turret", "rotation", "turretRotations", c.turretRotations, 0, "rad");
    out.add("Turret", "speed", "turretSpeeds", c.turretSpeeds, 0, "rad/s");
  }
  if (c.rangeAndBearingData.length > 0) {
    out.group("Range and bearing").readings.push({ label: "data", text: bytesText(c.rangeAndBearingData) });
  }
  addDescribed(out, robot, "deviceCommands", c.deviceCommands, (kind) => kind.commands);
  for (const { radio, payload } of out.first("Radio", c.radioMessages)) {
    out.group("Radio").readings.push({ label: `${robot.radios[radio]?.id ?? radio} sends`, text: bytesText(payload) });
  }
  return out.groups;
}
