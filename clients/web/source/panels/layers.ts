// SPDX-License-Identifier: MIT
// Which layers are drawn.
import { colorings, type Coloring } from "../drawing/colors";
import { layers } from "../drawing/view";
import type { App } from "../page/app";
import { make } from "./element";
import type { Panel } from "./panel";
import { setColoring } from "../page/looks";

const names: Record<Coloring, string> = { scene: "of the scene", model: "by model", controller: "by controller" };

export class Layers implements Panel {
  readonly element = make("section.layers", {}, make("h2", {}, "Layers"));
  private readonly boxes = new Map<string, HTMLInputElement>();

  private readonly colors = make("select", { id: "colors" }) as HTMLSelectElement;

  constructor(private readonly app: App) {
    const grid = make("div.grid");
    for (const { name, label, key } of layers) {
      const box = make("input", { type: "checkbox", "data-layer": name }) as HTMLInputElement;
      box.addEventListener("change", () => app.toggleLayer(name));
      this.boxes.set(name, box);
      grid.append(make("label", { title: `key ${key}` }, box, label));
    }
    for (const coloring of colorings) this.colors.append(make("option", { value: coloring }, names[coloring]));
    this.colors.addEventListener("change", () => setColoring(app, this.colors.value as Coloring));
    this.element.append(grid, make("label.colors", { title: "Colours of robots (y)" }, "Robot colours", this.colors));
  }

  update(): void {
    this.colors.value = this.app.settings.coloring;
    for (const [name, box] of this.boxes) box.checked = this.app.view.shown.has(name as never);
  }
}
