// Plots of any numbers of any topic, over simulated time.
import uPlot from "uplot";
import type { App } from "../page/app";
import { nameOf, numbersIn, type Series } from "../model/series";
import { make, setText } from "./element";
import type { Panel } from "./panel";

const strokes = ["#3d8bfd", "#e0642c", "#2a9d5f", "#a050c8", "#c9a000", "#d6336c", "#14a0b8", "#7a7f87"];

const mostTopics = 5000; // to choose from

interface Drawn { series: Series; chart: uPlot; value: HTMLElement; box: HTMLElement }

export class Plots implements Panel {
  readonly element = make("section.plots");
  private readonly list = make("div");
  private readonly topic = make("select", { "aria-label": "Topic" }) as HTMLSelectElement;
  private readonly path = make("select", { "aria-label": "Number" }) as HTMLSelectElement;
  private drawn = new Map<string, Drawn>();
  private topics: string[] = [];

  constructor(private readonly app: App) {
    this.topic.addEventListener("change", () => this.listNumbers());
    this.path.addEventListener("change", () => {
      if (this.path.value !== "") this.app.togglePlot({ topic: this.topic.value, path: this.path.value });
      this.path.value = "";
    });
    this.element.append(make("div.chooser", {}, this.topic, this.path), this.list);
  }

  update(): void {
    const { app } = this;
    this.listTopics();
    const names = new Set(app.series.map((series) => nameOf(series.name)));
    for (const [name, { chart, box }] of this.drawn) {
      if (names.has(name)) continue;
      chart.destroy();
      box.remove();
      this.drawn.delete(name);
    }
    app.updateSeries();
    app.series.forEach((series, i) => {
      const drawn = this.drawn.get(nameOf(series.name)) ?? this.add(series, strokes[i % strokes.length]);
      drawn.series = series; // a recording that was opened has new ones
      this.fill(drawn);
    });
    if (app.series.length === 0 && !this.list.hasChildNodes()) {
      this.list.append(make("p.empty", {}, "Choose a topic and a number above, or click the plot sign beside a reading."));
    }
  }

  private add(series: Series, stroke: string): Drawn {
    this.list.querySelector(".empty")?.remove();
    const value = make("span.number");
    const box = make("div.plot-box", { "data-plot": nameOf(series.name) }, make("div.title", {},
      make("span.swatch", { style: `background:${stroke}` }), make("span", { title: nameOf(series.name) },
        `${series.name.topic.replace("/robots/", "")} ${series.name.path}`), value,
      make("button", { title: "Remove the plot", click: () => this.app.togglePlot(series.name) }, "×")));
    this.list.append(box);
    const color = (name: string) => () => getComputedStyle(document.body).getPropertyValue(name);
    const axis = { stroke: color("--muted"), grid: { stroke: color("--line"), width: 1 }, ticks: { show: false },
                   font: "10px system-ui" };
    const chart = new uPlot({
      width: Math.max(200, this.element.clientWidth - 24), height: 120, legend: { show: false },
      cursor: { y: false }, scales: { x: { time: false } },
      series: [{}, { stroke, width: 1.5, points: { show: false } }],
      axes: [{ ...axis, size: 24 }, { ...axis, size: 46 }],
      hooks: { draw: [(plot) => this.drawMoment(plot)] },
    }, [[], []], box);
    const drawn = { series, chart, value, box };
    this.drawn.set(nameOf(series.name), drawn);
    return drawn;
  }

  /** A line at the frame that is shown, while the page looks back. */
  private drawMoment(plot: uPlot): void {
    const frame = this.app.pinned === null ? null : this.app.frame;
    if (!frame) return;
    const x = plot.valToPos(Number(frame.timeNs) * 1e-9, "x", true);
    plot.ctx.fillStyle = "#e6a417";
    plot.ctx.fillRect(x - 1, plot.bbox.top, 2, plot.bbox.height);
  }

  private fill({ series, chart, value }: Drawn): void {
    setText(value, series.latest === null ? "–" : series.latest.toPrecision(5));
    // Time must grow: after a reset only the new run is drawn.
    let begin = series.times.length - 1;
    while (begin > 0 && series.times[begin - 1] < series.times[begin]) --begin;
    chart.setData([series.times.slice(Math.max(begin, 0)), series.values.slice(Math.max(begin, 0))]);
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
    const message = this.app.timeline.message(this.topic.value, this.app.pinned ?? this.app.timeline.last);
    const numbers = message ? numbersIn(message.read()) : [];
    this.path.replaceChildren(make("option", { value: "" }, message || this.topic.value === "" ? "Number …"
      : "not shown now: switch its layer on, or select its robot"),
      ...numbers.map(({ path, value }) => make("option", { value: path }, `${path} = ${value.toPrecision(4)}`)));
  }
}
