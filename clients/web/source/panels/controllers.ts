// SPDX-License-Identifier: MIT
// Controllers: which the tick waits for, how fast they answer, where the time of a tick goes.
import type { App } from "../page/app";
import type { Barrier, Phases, Session } from "../model/messages";
import { beginning } from "../model/texts";
import { make } from "./element";
import type { Panel } from "./panel";

const states = ["?", "ready", "waited for", "answered", "paused", "draining", "lost"];
const mostSessions = 200; // in the table
const mostRobots = 50; // of a session, when the mouse is over it
const phases = ["encode", "wait", "forces", "magnetism", "contacts", "solve", "integrate", "sensing", "recording", "pacing"] as const;

function seconds(value: number): string {
  if (value >= 1) return `${value.toFixed(2)} s`;
  return value >= 1e-3 ? `${(value * 1e3).toFixed(1)} ms` : `${(value * 1e6).toFixed(0)} µs`;
}

export class Controllers implements Panel {
  readonly element = make("section.controllers");

  constructor(private readonly app: App) {}

  update(): void {
    const { barrier } = this.app;
    if (!barrier?.status) {
      this.element.replaceChildren(make("p.empty", {}, "The server has told nothing about its controllers yet."));
      return;
    }
    const { status, histograms } = barrier;
    const waiting = status.sessions.filter(({ state }) => state === 2 || state === 6);
    this.element.replaceChildren(
      make("h2", {}, waiting.length > 0 ? `Waits for ${waiting.slice(0, 12).map(({ client }) => client).join(", ")}`
        : status.freeRobots.length > 0 ? "Waits for controllers" : "Waits for no controller"),
      status.freeRobots.length > 0 ? make("p.warn", {}, `Without controller: ${status.freeRobots.slice(0, 12).join(", ")}`) : "",
      status.goneRobots.length > 0 ? make("p.muted", {}, `Left for good: ${status.goneRobots.slice(0, 12).join(", ")}`) : "",
      this.phases(), ...(status.sessions.length > 0 ? [make("h3", {}, "Controllers"), this.sessions(status.sessions)] : []),
      histograms.length > 0 ? make("h3", {}, "Time to answer") : "", ...histograms.slice(0, mostSessions).map((one) => this.histogram(one)));
  }

  /** The mean over the last frames, as a bar. */
  private phases(): HTMLElement {
    const { timeline } = this.app;
    const sums = Object.fromEntries(phases.map((phase) => [phase, 0])) as Record<typeof phases[number], number>;
    let count = 0;
    for (let s = timeline.last; s >= timeline.first && s > timeline.last - 60; --s) {
      const message = timeline.at(s)?.messages.get("/phases");
      if (!message) continue;
      const value = message.read<Phases>();
      for (const phase of phases) sums[phase] += value[phase];
      ++count;
    }
    const total = phases.reduce((sum, phase) => sum + sums[phase], 0) || 1;
    return make("div", {}, make("h3", {}, `A tick takes ${seconds(count > 0 ? total / count : 0)}`),
      make("div.stack", {}, ...phases.map((phase) => make(`i.${phase}`, {
        style: `flex:${Math.max(sums[phase] / total, 0.001)}`, title: `${phase} ${seconds(sums[phase] / (count || 1))}` }))),
      make("div.legend", {}, ...phases.map((phase) => make("span", {}, make(`i.${phase}`),
        `${phase} ${seconds(sums[phase] / (count || 1))}`))));
  }

  private sessions(sessions: Session[]): HTMLElement {
    const head = make("tr", {}, ...["client", "state", "median", "99 %", "missed"].map((text) => make("th", {}, text)));
    return make("table.sessions", {}, head, ...sessions.slice(0, mostSessions).map((session) => make(
      `tr${session.state === 2 || session.state === 6 ? ".waiting" : ""}`, { title: session.robots.slice(0, mostRobots).join(", ") },
      make("td", {}, `${beginning(session.client)} (${session.robots.length})`),
      make("td", {}, (states[session.state] ?? "?") + (session.wallWaitingS > 0 ? ` ${seconds(session.wallWaitingS)}` : "")),
      make("td.number", {}, session.wallLatency ? seconds(session.wallLatency.p50) : "–"),
      make("td.number", {}, session.wallLatency ? seconds(session.wallLatency.p99) : "–"),
      make("td.number", {}, String(session.misses)))));
  }

  private histogram({ controller, least, growth, counts, missedTicks }: Barrier["histograms"][number]): HTMLElement {
    const list = Array.from(counts);
    const most = Math.max(1, ...list);
    const first = Math.max(0, list.findIndex((count) => count > 0));
    const bars = list.slice(first).map((count, i) => {
      const low = least * growth ** (first + i);
      return make("i", { style: `height:${count > 0 ? Math.max(3, 100 * Math.log1p(count) / Math.log1p(most)) : 0}%`,
                         title: `${seconds(low)} … ${seconds(low * growth)}: ${count}` });
    });
    const answers = `${list.reduce((sum, count) => sum + count, 0)} answers`;
    return make("div.histogram", {}, make("div.title", {}, controller, make("span.muted", {},
      missedTicks > 0 ? `${answers}, ${missedTicks} deadlines missed` : answers)), make("div.bars", {}, ...bars),
      make("div.ends.muted", {}, make("span", {}, seconds(least * growth ** first)),
           make("span", {}, seconds(least * growth ** list.length))));
  }
}
