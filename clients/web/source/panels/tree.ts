// The tree of entities, links and devices, with search.
import type { App } from "../page/app";
import { kindName, type Entity, type World } from "../model/messages";
import { make, restOf, setText } from "./element";
import type { Panel } from "./panel";

const mostRows = 400;
const mostParts = 400; // of an entity

export class Tree implements Panel {
  readonly element = make("section.tree");
  readonly search = make("input", { type: "search", placeholder: "Search  (/)", "aria-label": "Search entities" }) as HTMLInputElement;
  private readonly list = make("div.rows", { role: "tree" });
  private readonly count = make("span.muted");
  private world: World | null = null;
  private shown = "";
  found: string[] = []; // ids of what is searched; none: nothing is
  private open = new Set<string>();

  constructor(private readonly app: App) {
    this.search.addEventListener("input", () => this.rebuild());
    this.element.append(make("h2", {}, "World ", this.count), this.search, this.list);
  }

  update(): void {
    const { world } = this.app;
    const key = `${world?.generation}|${this.app.settings.selected}|${this.app.settings.trailed.join()}`;
    if (world !== this.world || key !== this.shown) {
      this.world = world;
      this.shown = key;
      this.rebuild();
    }
  }

  private rebuild(): void {
    const { world } = this;
    const text = this.search.value.trim().toLowerCase();
    if (!world) return this.list.replaceChildren(make("p.muted", {}, "No world yet."));
    const matching = world.entities.filter((entity) => !entity.removed && this.matches(world, entity, text));
    // Robots first, then what moves, then the rest.
    const rank = (entity: Entity): number => (entity.robot !== undefined ? 0 : entity.movable ? 1 : 2);
    const ordered = matching.map((entity, i) => ({ entity, i }))
      .sort((a, b) => rank(a.entity) - rank(b.entity) || a.i - b.i).map(({ entity }) => entity);
    this.found = text === "" ? [] : ordered.map(({ id }) => id);
    setText(this.count, `${ordered.length}`);
    const rows = ordered.slice(0, mostRows).flatMap((entity) => this.rowsOf(world, entity));
    if (ordered.length > mostRows) rows.push(make("p.muted", {}, `… and ${ordered.length - mostRows} more: search`));
    if (ordered.length === 0) rows.push(make("p.muted", {}, "Nothing has that name."));
    this.list.replaceChildren(...rows);
  }

  private matches(world: World, entity: Entity, text: string): boolean {
    if (text === "" || entity.id.toLowerCase().includes(text) || kindName(entity.kind).includes(text)) return true;
    return this.partsOf(world, entity).some((part) => part.toLowerCase().includes(text));
  }

  /** Links, joints and devices, by name. */
  private partsOf(world: World, entity: Entity): string[] {
    const index = world.entities.indexOf(entity);
    const own = <T extends { entity: number; id: string }>(list: T[], kind: string): string[] =>
      list.filter((item) => item.entity === index).map((item) => `${kind} ${item.id}`);
    const robot = (list: { robot: number; id: string }[], kind: string): string[] =>
      entity.robot === undefined ? [] : list.filter((item) => item.robot === entity.robot).map(({ id }) => `${kind} ${id}`);
    const described = entity.robot === undefined ? undefined : world.robots[entity.robot]?.description;
    const proximity = world.proximitySensors.filter(({ robot }) => robot === entity.robot).map((_, i) => `proximity sensor ${i}`);
    const more = described ? [
      ...described.imus.map(({ id }) => `IMU ${id}`), ...described.contactSensors.map(({ id }) => `contact sensor ${id}`),
      ...(described.deviceKinds ?? []).flatMap(({ name, devices }) => devices.map(({ id }, i) => `${name} ${id || i}`)),
      ...proximity, ...(described.rangeAndBearing ? ["range and bearing"] : []), ...(described.positioning ? ["positioning"] : []),
      ...(described.battery ? ["battery"] : []), ...(described.wheels ? ["wheels"] : []), ...(described.turret ? ["turret"] : [])] : [];
    return [...own(world.links, "link"), ...own(world.joints, "joint"), ...robot(world.cameras, "camera"),
            ...robot(world.radios, "radio"), ...own(world.leds, "LED"), ...own(world.directionalLeds, "directional LED"),
            ...own(world.tags, "tag"), ...own(world.magnets, "magnet"), ...more];
  }

  private rowsOf(world: World, entity: Entity): HTMLElement[] {
    const { app } = this;
    const isSelected = app.settings.selected === entity.id;
    const isOpen = this.open.has(entity.id);
    const row = make(`div.row${isSelected ? ".selected" : ""}`, {
      role: "treeitem", "data-entity": entity.id, "aria-selected": String(isSelected),
      click: () => app.select(isSelected ? null : entity.id),
    },
      make("button.fold", { title: "Links and devices", click: (event) => {
        event.stopPropagation();
        if (!this.open.delete(entity.id)) this.open.add(entity.id);
        this.rebuild();
      } }, isOpen ? "▾" : "▸"),
      make(`span.kind.${entity.robot !== undefined ? "robot" : entity.movable ? "thing" : "fixed"}`),
      make("span.id", {}, entity.id), make("span.muted", {}, kindName(entity.kind)));
    row.addEventListener("dblclick", () => app.look(entity.id));
    if (!isOpen) return [row];
    const parts = this.partsOf(world, entity);
    const rest = restOf(parts.length, mostParts);
    return [row, ...parts.slice(0, mostParts).map((part) => make("div.part", {}, part)), ...(rest ? [rest] : [])];
  }
}
