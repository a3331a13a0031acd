// SPDX-License-Identifier: MIT
// The tree of entities by type, with their links and devices; chosen by type, and searched.
import type { App } from "../page/app";
import { kindName, type World } from "../model/messages";
import { groupsOf, matching, partsOf, typeOf, type Group } from "../model/population";
import { make, restOf, setText } from "./element";
import type { Panel } from "./panel";

const mostRows = 200; // of a group
const mostGroups = 200;
const mostParts = 400; // of an entity
const fewRows = 20; // of a group that is open at first
const fewEntities = 60; // of a world whose groups all are

export class Tree implements Panel {
  readonly element = make("section.tree");
  readonly search = make("input", { type: "search", placeholder: "Search  (/)", "aria-label": "Search entities" }) as HTMLInputElement;
  private readonly type = make("select", { id: "tree-type", "aria-label": "Type" }) as HTMLSelectElement;
  private readonly list = make("div.rows", { role: "tree" });
  private readonly count = make("span.muted");
  private world: World | null = null;
  private shown = "";
  found: string[] = []; // ids of what is searched; none: nothing is
  private open = new Set<string>(); // entities
  private folded = new Map<string, boolean>(); // groups that the user opened or closed

  constructor(private readonly app: App) {
    this.search.addEventListener("input", () => this.rebuild());
    this.type.addEventListener("change", () => this.rebuild());
    this.element.append(make("h2", {}, "World ", this.count), make("div.filter", {}, this.type, this.search), this.list);
  }

  update(): void {
    const { world } = this.app;
    const key = `${world?.generation}|${this.app.settings.selected}`;
    if (world === this.world && key === this.shown) return;
    if (world !== this.world && world) this.listTypes(world);
    this.world = world;
    this.shown = key;
    this.rebuild();
  }

  private listTypes(world: World): void {
    const chosen = this.type.value;
    const counts = new Map<string, number>();
    for (const { type, members } of groupsOf(world)) counts.set(type, (counts.get(type) ?? 0) + members.length);
    this.type.replaceChildren(make("option", { value: "" }, "All types"),
      ...[...counts].slice(0, mostGroups).map(([type, count]) => make("option", { value: type }, `${type} (${count})`)));
    this.type.value = counts.has(chosen) ? chosen : "";
  }

  private rebuild(): void {
    const { world } = this;
    if (!world) return this.list.replaceChildren(make("p.muted", {}, "No world yet."));
    const text = this.search.value.trim().toLowerCase();
    const groups = groupsOf(world).filter(({ type }) => this.type.value === "" || type === this.type.value)
      .map((group) => ({ ...group, members: matching(world, group, text) })).filter(({ members }) => members.length > 0);
    const count = groups.reduce((sum, { members }) => sum + members.length, 0);
    this.found = text === "" ? [] : groups.flatMap(({ members }) => members.map((index) => world.entities[index].id));
    setText(this.count, `${count}`);
    const isNarrow = text !== "" || this.type.value !== "" || count <= fewEntities;
    const rows = groups.slice(0, mostGroups).flatMap((group) => this.rowsOfGroup(world, group, isNarrow));
    if (groups.length === 0) rows.push(make("p.muted", {}, "Nothing has that name."));
    rows.push(...[restOf(groups.length, mostGroups)].filter((rest) => rest !== null));
    this.list.replaceChildren(...rows);
  }

  /** One entity has a row with its type; several have a row of the group before. The selected one is always among them. */
  private rowsOfGroup(world: World, { label, members }: Group, isNarrow: boolean): HTMLElement[] {
    if (members.length === 1) return this.rowsOf(world, members[0], label);
    const { selected } = this.app.settings;
    const isFolded = this.folded.get(label) ?? !(isNarrow || members.length <= fewRows);
    const chosen = members.findIndex((index) => world.entities[index].id === selected);
    const shown = isFolded ? [] : members.slice(0, mostRows);
    if (chosen >= 0 && !shown.includes(members[chosen])) shown.push(members[chosen]);
    const toggle = (event: Event): void => {
      event.stopPropagation();
      this.folded.set(label, !isFolded);
      this.rebuild();
    };
    const head = make("div.row.group", { role: "treeitem", "data-group": label, "aria-expanded": String(!isFolded), click: toggle },
      make("button.fold", { title: "Show or hide them", click: toggle }, isFolded ? "▸" : "▾"), this.sign(world, members[0]),
      make("span.id", {}, label), make("span.count.number", {}, String(members.length)));
    const rest = isFolded || members.length <= mostRows ? [] : [make("p.muted", {}, `… and ${members.length - mostRows} more: search`)];
    return [head, ...shown.flatMap((index) => this.rowsOf(world, index)), ...rest];
  }

  private sign(world: World, index: number): HTMLElement {
    const { robot, movable } = world.entities[index];
    return make(`span.kind.${robot !== undefined ? "robot" : movable ? "thing" : "fixed"}`);
  }

  /** @param label  of what stands in no group */
  private rowsOf(world: World, index: number, label?: string): HTMLElement[] {
    const { app } = this;
    const entity = world.entities[index];
    const isSelected = app.settings.selected === entity.id;
    const isOpen = this.open.has(entity.id);
    const row = make(`div.row${label === undefined ? ".member" : ""}${isSelected ? ".selected" : ""}`, {
      role: "treeitem", "data-entity": entity.id, "aria-selected": String(isSelected),
      title: `${entity.id}: ${typeOf(entity)}${entity.model ? `, a ${kindName(entity.kind)}` : ""}`,
      click: () => app.select(isSelected ? null : entity.id),
    },
      make("button.fold", { title: "Links and devices", click: (event) => {
        event.stopPropagation();
        if (!this.open.delete(entity.id)) this.open.add(entity.id);
        this.rebuild();
      } }, isOpen ? "▾" : "▸"),
      this.sign(world, index), make("span.id", {}, entity.id), label === undefined || label === entity.id ? null : make("span.muted", {}, label));
    row.addEventListener("dblclick", () => app.look(entity.id));
    if (!isOpen) return [row];
    const parts = partsOf(world)[index];
    const rest = restOf(parts.length, mostParts);
    return [row, ...parts.slice(0, mostParts).map((part) => make("div.part", {}, part)), ...(rest ? [rest] : [])];
  }
}
