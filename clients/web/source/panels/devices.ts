// SPDX-License-Identifier: MIT
// Readings and commands of the selected robot, device by device; of any other entity its pose.
import type { App } from "../page/app";
import { kindName, type Command, type Observation, type Poses, type World } from "../model/messages";
import { commanded, fixed, jointsOf, mostReadings, number, observed, type Group, type Reading } from "../model/readings";
import { nameOf } from "../model/series";
import type { Frame } from "../model/timeline";
import { icon, longText, make, restOf, setText } from "./element";
import type { Panel } from "./panel";
import { follow } from "../page/looks";

interface Row { text: HTMLElement; bar: HTMLElement | null; plot: HTMLElement | null; reading: Reading }

const mostBesideFan = 12;
const mostRows = mostReadings; // of a device, and of parameters

export class Devices implements Panel {
  readonly element = make("section.devices");
  private shape = "";
  private rows: Row[] = [];
  private readonly pose = make("div.pose.number");
  private readonly fan = make("canvas.fan", { width: 180, height: 180, title: "Proximity: each sensor by its direction" }) as HTMLCanvasElement;

  constructor(private readonly app: App) {}

  update(): void {
    const { app } = this;
    const selected = app.selected;
    if (!selected) {
      if (this.shape !== "none") {
        this.shape = "none";
        this.element.replaceChildren(make("p.empty", {}, "Click a robot or an object, in the picture or in the list, "
          + "to see what it senses and does."));
      }
      return;
    }
    const groups = this.groups();
    const shape = `${selected.entity.id}|${app.mayChange}|${groups.map(([title, list]) => title + list.map(
      ({ device, readings }) => device + readings.map(({ label }) => label).join()).join()).join()}`;
    if (shape !== this.shape) this.rebuild(shape, groups);
    this.fill(groups.flatMap(([, list]) => list.flatMap(({ readings }) => readings)));
    this.showPose(selected.index);
    const { followed, trailed } = app.settings;
    this.element.querySelector(".follow")?.classList.toggle("on", followed === selected.entity.id);
    this.element.querySelector(".trail")?.classList.toggle("on", trailed.includes(selected.entity.id));
    this.drawFan();
  }

  private groups(): [string, Group[]][] {
    const robot = this.app.selectedRobot?.description;
    const { frame, selected } = this.app;
    if (!robot || !frame || !selected || !this.app.world) return [];
    const found: [string, Group[]][] = [];
    const joints = jointsOf(this.app.world, selected.index);
    const seen = this.app.timeline.message(`/robots/${robot.id}/observation`, frame.sequence, 60, selected.index);
    if (seen) found.push(["Senses", observed(seen.topic, robot, seen.read<Observation>(), joints)]);
    const told = this.app.timeline.message(`/robots/${robot.id}/command`, frame.sequence, 60, selected.index);
    if (told) {
      const command = { tagPayloads: this.payloads(this.app.world, frame), ...told.read<Command>() };
      found.push(["Commands", commanded(told.topic, robot, command, joints)]);
    }
    return found.map(([title, list]) => [title, list.slice(0, mostRows).map(({ device, readings, more }) =>
      ({ device, readings: readings.slice(0, mostRows), more: more + Math.max(readings.length - mostRows, 0) }))]);
  }

  /** Payloads of the robot's tags: servers leave them out of commands, which other viewers could not read with it. */
  private payloads(world: World, frame: Frame): Uint8Array[] {
    const selected = this.app.selected?.index;
    const changed = new Map((frame.messages.get("/poses")?.read<Poses>().tagPayloads ?? []).map(({ tag, payload }) => [tag, payload]));
    return world.tags.flatMap(({ entity, payload }, i) => (entity === selected ? [changed.get(i) ?? payload] : []));
  }

  private rebuild(shape: string, groups: [string, Group[]][]): void {
    const { app } = this;
    const { entity } = app.selected!;
    this.shape = shape;
    this.rows = [];
    const robot = app.selectedRobot?.description;
    this.element.replaceChildren(
      make("h2", {}, entity.id, " ", make("span.muted", {}, kindName(entity.kind)
        + (entity.model ? ` · ${entity.model}` : "") + (robot ? ` · ${robot.controller}` : ""))),
      make("div.actions", {},
        make("button", { click: () => app.look(entity.id), title: "Look at it (F)" }, "Look"),
        make("button.follow", { click: () => follow(app, app.settings.followed === entity.id ? null : entity.id), title: "Move with it (G)" }, "Follow"),
        make("button.trail", { click: () => app.toggleTrail(entity.id), title: "Draw its path (T)" }, "Trail"),
        app.mayChange ? make("button.danger", { click: () => void app.call("/remove", { entity: entity.id }), title: "Remove it (Delete)",
                                id: "remove" }, "Remove") : null),
      this.pose);
    for (const [title, list] of groups) {
      if (list.length > 0) this.element.append(make("h3", {}, title));
      for (const group of list) this.addGroup(title, group);
    }
    if (robot && robot.params.length > 0) {
      this.element.append(make("h3", {}, "Params"), make("table.params", {}, ...robot.params.slice(0, mostRows).map(
        ({ name, value }) => make("tr", {}, make("td", {}, name), longText("td", value)))),
        restOf(robot.params.length, mostRows) ?? "");
    }
  }

  private addGroup(title: string, { device, readings, more }: Group): void {
    const count = readings.length + more;
    const rows = readings.map((reading) => this.makeRow(title, device, reading));
    const hasFan = device === "Proximity" && title === "Senses" && this.levelSensors().length > 2;
    // Rays that the fan shows are not listed at once: other devices would be far below.
    const list = hasFan && rows.length > mostBesideFan
      ? [make("details.values", {}, make("summary.muted", {}, "Numbers"), ...rows)] : rows;
    this.element.append(make("details.device", { open: true }, make("summary", {}, device,
      make("span.muted", {}, count > 3 ? ` ${count}` : "")), hasFan ? this.fan : null, ...list,
      restOf(count, readings.length)));
  }

  private makeRow(title: string, device: string, reading: Reading): HTMLElement {
    const { app } = this;
    const text = make("span.value.number");
    const bar = reading.range ? make("span.bar", {}, make("i")) : null;
    const { series } = reading;
    const plot = series ? make("button.plot", { title: "Plot it", click: () => app.togglePlot(series) }, icon("plot")) : null;
    this.rows.push({ text, bar, plot, reading });
    return make("div.reading", { "data-reading": `${title}/${device}/${reading.label}` },
                make("span.label", {}, reading.label), bar, text, plot);
  }

  private fill(readings: Reading[]): void {
    const plotted = new Set(this.app.series.map((series) => nameOf(series.name)));
    this.rows.forEach(({ text, bar, plot }, i) => {
      const reading = readings[i];
      if (!reading) return;
      setText(text, reading.text);
      text.dataset.value = reading.value === undefined ? "" : String(reading.value);
      if (bar && reading.range && reading.value !== undefined) {
        const [low, high] = reading.range;
        const part = Math.min(1, Math.max(0, (reading.value - low) / (high - low)));
        (bar.firstElementChild as HTMLElement).style.width = `${(100 * part).toFixed(1)}%`;
        bar.title = `${number(low)} … ${number(high)}`;
      }
      if (plot && reading.series) plot.classList.toggle("on", plotted.has(nameOf(reading.series)));
    });
  }

  private showPose(entity: number): void {
    const pose = this.app.view.originOf(entity);
    if (!pose) return;
    const [w, x, y, z] = pose.orientation;
    const yaw = Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) * 180 / Math.PI;
    setText(this.pose, `${pose.position.map((value) => fixed(value, 4)).join("  ")} m   heading ${fixed(yaw, 1)}°`);
  }

  /** Proximity sensors that look along the floor, with the angle from the robot's +x. */
  private levelSensors(): { index: number; way: number }[] {
    return (this.app.selectedRobot?.description.proximitySensors ?? [])
      .map(({ angle, direction }, index) => ({ index, way: angle ?? Math.atan2(direction[1], direction[0]), isLevel: Math.abs(direction[2]) < 0.7 }))
      .filter(({ isLevel }) => isLevel);
  }

  /** These sensors from above. */
  private drawFan(): void {
    const robot = this.app.selectedRobot?.description;
    const message = robot && this.app.frame?.messages.get(`/robots/${robot.id}/observation`);
    if (!message || !this.fan.isConnected) return;
    const { proximity } = message.read<Observation>();
    const draw = this.fan.getContext("2d")!;
    const style = getComputedStyle(this.element);
    draw.clearRect(0, 0, 180, 180);
    for (const { index, way } of this.levelSensors()) {
      const length = 30 + 55 * Math.min(1, proximity[index] ?? 0);
      // The robot's +x is up.
      const at = (r: number): [number, number] => [90 - r * Math.sin(way), 90 - r * Math.cos(way)];
      for (const [end, color, width] of [[85, "--line", 2], [length, "--accent", 5]] as const) {
        draw.strokeStyle = style.getPropertyValue(color);
        draw.lineWidth = width;
        draw.beginPath();
        draw.moveTo(...at(30));
        draw.lineTo(...at(end));
        draw.stroke();
      }
    }
  }
}
