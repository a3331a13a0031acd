// SPDX-License-Identifier: MIT
// Plots of any numbers of any topic over simulated time. Series of one unit share a chart.
import type { App } from "../page/app";
import { numbersOf, titleOf, wholeSeries } from "../page/plotted";
import { save } from "../page/save";
import { chartOf, labelOf, longLabel, type Label } from "../model/labels";
import { nameOf, type Series } from "../model/series";
import { csvOf } from "../model/table";
import { Chart, type Curve } from "./chart";
import { make } from "./element";
import type { Panel } from "./panel";
import { setApart } from "../page/looks";

// Colours that are told apart also by those who do not see some of them: Okabe and Ito's.
const strokes = ["#2f86d1", "#e69f00", "#009e73", "#d55e00", "#cc79a7", "#56b4e9", "#8c6d1f", "#7a7f87"];

const mostTopics = 5000; // to choose from

export class Plots implements Panel {
  readonly element = make("section.plots");
  private readonly list = make("div");
  private readonly topic = make("select", { "aria-label": "Topic" }) as HTMLSelectElement;
  private readonly path = make("select", { "aria-label": "Number" }) as HTMLSelectElement;
  private readonly apart = make("input", { type: "checkbox", id: "plots-apart" }) as HTMLInputElement;
  private readonly table = make("button", { id: "plots-csv", title: "All values as a table, of a recording those of the whole of it",
                                            click: () => void this.saveTable() }, "CSV") as HTMLButtonElement;
  private readonly actions = make("div.actions", {}, this.table,
    make("button", { id: "plots-png", title: "The charts as a picture", click: () => this.savePicture() }, "PNG"),
    make("label", { title: "Otherwise series of one unit share a chart" }, this.apart, "a chart for each"));
  private charts = new Map<string, Chart>();
  private topics: string[] = [];

  constructor(private readonly app: App) {
    this.topic.addEventListener("change", () => this.listNumbers());
    this.path.addEventListener("change", () => {
      if (this.path.value !== "") this.app.togglePlot({ topic: this.topic.value, path: this.path.value });
      this.path.value = "";
    });
    this.apart.addEventListener("change", () => setApart(app, this.apart.checked));
    this.element.append(make("div.chooser", {}, this.topic, this.path), this.actions, this.list);
  }

  update(): void {
    const { app } = this;
    this.listTopics();
    app.updateSeries();
    this.apart.checked = app.settings.apart;
    this.actions.hidden = app.series.length === 0;
    const wanted = new Map<string, Curve[]>();
    app.series.forEach((series, i) => {
      const label = this.labelOf(series);
      const key = app.settings.apart ? nameOf(series.name) : chartOf(series.name, label);
      const curve = { series, label: label ?? { of: series.name.topic, text: series.name.path, unit: "" }, stroke: strokes[i % strokes.length] };
      wanted.set(key, [...wanted.get(key) ?? [], curve]);
    });
    for (const [key, chart] of this.charts) {
      if (wanted.has(key) && chart.shows(wanted.get(key)!)) continue;
      chart.remove();
      this.charts.delete(key);
    }
    for (const [key, curves] of wanted) {
      const chart = this.charts.get(key) ?? new Chart(app, curves, () => this.element.clientWidth - 2);
      this.charts.set(key, chart);
      if (!chart.element.isConnected) this.list.append(chart.element);
      chart.update();
    }
    if (wanted.size > 0) this.list.querySelector(".empty")?.remove();
    else if (!this.list.hasChildNodes()) {
      this.list.append(make("p.empty", {}, "Choose a topic and a number above, or click the plot sign beside a reading."));
    }
  }

  /** A label stays as it was first known: the robot may be gone later. */
  private labelOf(series: Series): Label | null {
    if (series.label) return series.label;
    const { frame, timeline, world } = this.app;
    const message = frame && series.name.topic.startsWith("/robots/") ? timeline.message(series.name.topic, frame.sequence, 60) : null;
    return series.label = labelOf(series.name, world, message?.read());
  }

  private async saveTable(): Promise<void> {
    const { series: shown } = this.app;
    this.table.disabled = true; // all of a recording is read now
    const series = await wholeSeries(this.app);
    this.table.disabled = false;
    const labels = shown.map((one) => longLabel(this.labelOf(one) ?? { of: one.name.topic, text: one.name.path, unit: "" }));
    save(new Blob([csvOf(series, labels)], { type: "text/csv" }), `${titleOf(this.app)} plots.csv`);
  }

  private savePicture(): void {
    const charts = [...this.charts.values()];
    const ratio = window.devicePixelRatio;
    const height = charts.reduce((sum, chart) => sum + chart.pictureHeight, 0);
    const canvas = make("canvas", { width: Math.max(...charts.map(({ width }) => width)) * ratio, height: height * ratio }) as HTMLCanvasElement;
    const draw = canvas.getContext("2d")!;
    draw.fillStyle = getComputedStyle(document.body).getPropertyValue("--panel");
    draw.fillRect(0, 0, canvas.width, canvas.height);
    let top = 0;
    for (const chart of charts) top += chart.paint(draw, top, ratio);
    canvas.toBlob((blob) => { if (blob) save(blob, `${titleOf(this.app)} plots.png`); });
  }

  private listTopics(): void {
    const { topicNames } = this.app;
    if (topicNames === this.topics) return;
    this.topics = topicNames;
    const chosen = this.topic.value;
    this.topic.replaceChildren(make("option", { value: "" }, "Topic …"),
      ...topicNames.slice(0, mostTopics).map((topic) => make("option", { value: topic }, topic)));
    this.topic.value = chosen;
    this.listNumbers();
  }

  private listNumbers(): void {
    const { value: topic } = this.topic;
    const numbers = numbersOf(this.app, topic);
    this.path.replaceChildren(make("option", { value: "" }, numbers || topic === "" ? "Number …"
      : "not shown now: switch its layer on, or select its robot"),
      ...(numbers ?? []).map(({ path, value }) => make("option", { value: path }, `${path} = ${value.toPrecision(4)}`)));
  }
}
