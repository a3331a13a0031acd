// SPDX-License-Identifier: MIT
// Choices of how things look, which change nothing else.
import type { Coloring } from "../drawing/colors";
import type { App } from "./app";

/** Moves what is drawn smoothly from tick to tick, or as the ticks come. */
export function toggleMotion(app: App): void {
  const { settings, view } = app;
  settings.isSmooth = view.motion.isOn = !settings.isSmooth;
  app.notice("info", settings.isSmooth ? "Motion between ticks is drawn." : "Each tick is drawn as it is.");
  app.onSettings();
}

/** Colours robots in the next way: of the scene, by model, by controller. */
export function setColoring({ settings, view, onSettings }: App, coloring: Coloring): void {
  settings.coloring = coloring;
  view.setColoring(coloring);
  onSettings();
}

/** Moves the camera with an entity; null: it stays. */
export function follow({ settings, view, onSettings }: App, id: string | null): void {
  settings.followed = view.followed = id;
  onSettings();
}

/** Whether each series has a chart of its own. */
export function setApart({ settings, onSettings }: App, isApart: boolean): void {
  settings.apart = isApart;
  onSettings();
}
