// SPDX-License-Identifier: MIT
// Choices of the user, as they stand in the address after "#", so that a link shows the same view.
import { colorings, type Coloring } from "../drawing/colors";
import type { Look } from "../drawing/stage";
import { layers, layersAtFirst, type Layer } from "../drawing/view";
import { lanes, type Lane } from "./marks";
import { nameOf, parseName, type SeriesName } from "./series";

export type Tab = "devices" | "plots" | "camera" | "log" | "controllers";
export interface Settings {
  look: Look | null; // null: the page frames the world itself
  layers: Layer[];
  selected: string | null; // id of an entity
  followed: string | null;
  trailed: string[];
  plots: SeriesName[];
  apart: boolean; // each series in a chart of its own
  tick: number | null; // at which time stands; null: it goes on
  bookmarks: number[]; // ticks
  hiddenLanes: Lane[]; // of the time line
  tab: Tab;
  theme: "light" | "dark" | "system";
  isSmooth: boolean; // motion between ticks is drawn
  coloring: Coloring; // of robots
}

export function settingsAtFirst(): Settings {
  return { look: null, layers: [...layersAtFirst], selected: null, followed: null, trailed: [], plots: [], apart: false,
           tick: null, bookmarks: [], hiddenLanes: [], tab: "devices", theme: "system", isSmooth: true, coloring: "scene" };
}

const tabs: Tab[] = ["devices", "plots", "camera", "log", "controllers"];
const round = (value: number): string => String(Number(value.toFixed(4)));

export function toAddress(settings: Settings): string {
  const parts = new URLSearchParams();
  const { look } = settings;
  if (look) {
    parts.set("eye", look.eye.map(round).join(","));
    parts.set("at", look.at.map(round).join(","));
    parts.set("fov", round(look.fieldOfView));
  }
  if (settings.layers.join() !== layersAtFirst.join()) parts.set("layers", settings.layers.join(","));
  if (settings.selected !== null) parts.set("selected", settings.selected);
  if (settings.followed !== null) parts.set("follow", settings.followed);
  for (const id of settings.trailed) parts.append("trail", id);
  for (const plot of settings.plots) parts.append("plot", nameOf(plot));
  if (settings.tick !== null) parts.set("tick", String(settings.tick));
  for (const tick of settings.bookmarks) parts.append("bookmark", String(tick));
  if (settings.hiddenLanes.length > 0) parts.set("hide", settings.hiddenLanes.join(","));
  if (settings.apart) parts.set("apart", "1");
  if (settings.tab !== "devices") parts.set("tab", settings.tab);
  if (settings.theme !== "system") parts.set("theme", settings.theme);
  if (!settings.isSmooth) parts.set("motion", "off");
  if (settings.coloring !== "scene") parts.set("colors", settings.coloring);
  return parts.toString();
}

function vector(text: string | null): [number, number, number] | null {
  const numbers = (text ?? "").split(",").map(Number);
  return text && numbers.length === 3 && numbers.every(Number.isFinite) ? numbers as [number, number, number] : null;
}

/** Settings of an address; words that can't be understood are left out. */
export function fromAddress(text: string): Settings {
  const parts = new URLSearchParams(text.replace(/^#/, ""));
  const settings = settingsAtFirst();
  const eye = vector(parts.get("eye")), at = vector(parts.get("at"));
  const fieldOfView = Number(parts.get("fov") ?? "45");
  if (eye && at) {
    settings.look = { eye, at, fieldOfView: fieldOfView > 1 && fieldOfView < 170 ? fieldOfView : 45 };
  }
  const named = parts.get("layers")?.split(",");
  if (named) settings.layers = layers.map(({ name }) => name).filter((name) => named.includes(name));
  settings.selected = parts.get("selected");
  settings.followed = parts.get("follow");
  settings.trailed = parts.getAll("trail");
  settings.plots = parts.getAll("plot").map(parseName).filter((name) => name !== null);
  const isTick = (value: number): boolean => Number.isSafeInteger(value) && value >= 0;
  const tick = Number(parts.get("tick") ?? "none");
  settings.tick = isTick(tick) ? tick : null;
  settings.bookmarks = parts.getAll("bookmark").map(Number).filter(isTick).slice(0, 200);
  const hidden = parts.get("hide")?.split(",") ?? [];
  settings.hiddenLanes = lanes.map(({ name }) => name).filter((name) => hidden.includes(name));
  settings.apart = parts.get("apart") === "1";
  settings.tab = tabs.find((tab) => tab === parts.get("tab")) ?? "devices";
  const theme = parts.get("theme");
  settings.theme = theme === "light" || theme === "dark" ? theme : "system";
  settings.isSmooth = parts.get("motion") !== "off";
  settings.coloring = colorings.find((one) => one === parts.get("colors")) ?? "scene";
  return settings;
}
