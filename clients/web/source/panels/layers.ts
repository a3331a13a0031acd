// Which layers are drawn.
import { layers } from "../drawing/view";
import type { App } from "../page/app";
import { make } from "./element";
import type { Panel } from "./panel";

export class Layers implements Panel {
  readonly element = make("section.layers", {}, make("h2", {}, "Layers"));
  private readonly boxes = new Map<string, HTMLInputElement>();

  constructor(private readonly app: App) {
    const grid = make("div.grid");
    for (const { name, label, key } of layers) {
      const box = make("input", { type: "checkbox", "data-layer": name }) as HTMLInputElement;
      box.addEventListener("change", () => app.toggleLayer(name));
      this.boxes.set(name, box);
      grid.append(make("label", { title: `key ${key}` }, box, label));
    }
    this.element.append(grid);
  }

  update(): void {
    for (const [name, box] of this.boxes) box.checked = this.app.view.shown.has(name as never);
  }
}
