// SPDX-License-Identifier: MIT
// Spawns entities from the scene's models, robots with one of its controllers, or what XML describes.
import type { App } from "../page/app";
import { isRobot, kindName, type World } from "../model/messages";
import { fixed } from "../model/readings";
import { make } from "./element";
import type { Panel } from "./panel";

interface Choice { label: string; xml: (id: string, body: string) => string }

const mostName = 300; // characters of a model or controller that can be chosen
const plain: Choice[] = [
  { label: "box", xml: (id, body) => `<box id="${id}" size="0.05,0.05,0.05" movable="true" mass="0.1">${body}</box>` },
  { label: "cylinder", xml: (id, body) => `<cylinder id="${id}" radius="0.025" height="0.05" movable="true" mass="0.1">${body}</cylinder>` },
];

function escape(text: string): string {
  return text.replace(/[&<>"]/g, (letter) => `&#${letter.charCodeAt(0)};`);
}

/** Elements that can be spawned in a world. */
function choicesOf(world: World): Choice[] {
  const models = world.models.filter(({ id }) => id.length <= mostName).map(({ id: model, kind }) => ({
    label: `${model} (${kindName(kind)})`,
    xml: (id: string, body: string) => `<${kindName(kind)} id="${id}" model="${escape(model)}">${body}</${kindName(kind)}>`,
  }));
  // Foot-bots, e-pucks, … need no model, but a controller: those with which the world has some.
  const robots = new Map<string, Choice>();
  for (const { kind, robot } of world.entities) {
    const described = robot === undefined ? undefined : world.robots[robot]?.description;
    if (!described || described.controller.length > mostName || !isRobot(kind)) continue;
    const { controller, battery } = described;
    const label = `${kindName(kind)} with ${controller}`;
    const more = `${battery ? "<battery/>" : ""}<controller config="${escape(controller)}"/>`;
    robots.set(label, { label, xml: (id, body) => `<${kindName(kind)} id="${id}">${body}${more}</${kindName(kind)}>` });
  }
  return [...plain, ...models, ...robots.values()];
}

export class Change implements Panel {
  readonly element: HTMLElement;
  private readonly what = make("select", { id: "spawn-what", "aria-label": "What to spawn" }) as HTMLSelectElement;
  private readonly name = make("input", { id: "spawn-id", placeholder: "id", "aria-label": "Id", value: "new_1" }) as HTMLInputElement;
  private readonly place = make("input", { id: "spawn-place", title: "x, y, z [m]: shift + right click in the picture fills it in",
                                           value: "0, 0, 0.1", "aria-label": "Position" }) as HTMLInputElement;
  private readonly xml = make("textarea", { rows: 4, spellcheck: "false", "aria-label": "XML" }) as HTMLTextAreaElement;
  private world: World | null = null;
  private choices = plain;

  constructor(private readonly app: App) {
    for (const input of [this.what, this.name, this.place]) input.addEventListener("input", () => this.write());
    const spawn = make("button.primary", { id: "spawn", click: () => void this.spawn() }, "Spawn");
    this.element = make("details.change", {}, make("summary", {}, "Spawn"),
      make("div.grid", {}, this.what, this.name, this.place, spawn), this.xml);
  }

  update(): void {
    (this.element as HTMLDetailsElement).hidden = !this.app.mayChange;
    const { world } = this.app;
    if (!world || world === this.world) return;
    this.world = world;
    const chosen = this.what.value;
    this.choices = choicesOf(world);
    this.what.replaceChildren(...this.choices.map(({ label }) => make("option", { value: label }, label)));
    if (this.choices.some(({ label }) => label === chosen)) this.what.value = chosen;
    this.write();
  }

  setPlace(x: number, y: number, z: number): void {
    this.place.value = [x, y, z].map((value) => fixed(value, 3)).join(", ");
    this.write();
  }

  private write(): void {
    const place = this.place.value.split(",").map((part) => part.trim()).join(",");
    const body = `<body position="${escape(place)}" orientation="0,0,0"/>`;
    const id = escape(this.name.value);
    this.xml.value = (this.choices.find(({ label }) => label === this.what.value) ?? plain[0]).xml(id, body);
  }

  private async spawn(): Promise<void> {
    const done = await this.app.call("/spawn", { xml: this.xml.value });
    if (!done) return;
    this.app.select(this.name.value);
    this.name.value = this.name.value.replace(/\d*$/, (digits) => String(Number(digits || "0") + 1));
    this.write();
  }
}
