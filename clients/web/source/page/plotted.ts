// SPDX-License-Identifier: MIT
// Series that can be plotted, and those that are, for the panel and for files.
import { metricsTopic } from "../model/metrics";
import { plottable, Series } from "../model/series";
import { beginning } from "../model/texts";
import type { App } from "./app";

/** The plotted series with all values that the page has; of a recording, all of it. */
export async function wholeSeries(app: App): Promise<Series[]> {
  const whole = app.series.map(({ name }) => new Series(name));
  await Promise.all(whole.map((series) => app.recorded?.fill(series, Infinity)));
  app.updateSeries(whole, Infinity);
  return whole;
}

/** Numbers of a topic that can be plotted; null: it has no message near the frame that is shown. */
export function numbersOf({ recorded, timeline, pinned }: App, topic: string): { path: string; value: number }[] | null {
  if (recorded && topic === metricsTopic) return [...recorded.metrics].map(([path, value]) => ({ path, value }));
  const message = timeline.message(topic, pinned ?? timeline.last);
  return message && plottable(topic, message.read());
}

/** Name of what is shown, for files: the scene without its folder and ending. */
export function titleOf({ world, source }: App): string {
  return beginning(world?.scene ?? source.name, 100).replace(/^.*\//, "").replace(/\.argos$/, "");
}
