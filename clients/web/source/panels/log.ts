// SPDX-License-Identifier: MIT
// Lines that robots and the server logged.
import type { LogEntry } from "../model/log";
import type { App } from "../page/app";
import { longText, make, setText } from "./element";
import type { Panel } from "./panel";

const mostLines = 300;

export class LogPanel implements Panel {
  readonly element = make("section.log");
  private readonly lines = make("div.lines");
  private readonly filter = make("input", { type: "search", placeholder: "Filter", "aria-label": "Filter the log" }) as HTMLInputElement;
  private readonly pauseOn = make("input", { placeholder: "Pause when a line contains …", "aria-label": "Pause when a line contains" }) as HTMLInputElement;
  private readonly only = make("input", { type: "checkbox" }) as HTMLInputElement;
  private readonly pausing = make("div.chooser", {}, this.pauseOn);
  private readonly lost = make("p.muted.lost", { title: "A recording has all lines: ziggurat run --record" });
  private key = "";
  private last: LogEntry | undefined;
  private shown: LogEntry[] = [];

  constructor(private readonly app: App) {
    this.pauseOn.addEventListener("change", () => { app.pauseOnText = this.pauseOn.value; });
    this.element.append(make("div.chooser", {}, this.filter, make("label", {}, this.only, "selected only")),
                        this.pausing, this.lost, this.lines);
  }

  update(): void {
    const { app } = this;
    this.pausing.hidden = !app.connection.mayControl;
    if (document.activeElement !== this.pauseOn) this.pauseOn.value = app.pauseOnText;
    const { entries, lost } = app.log;
    const last = entries.at(-1);
    const key = `${this.filter.value}|${this.only.checked}|${app.settings.selected}|${app.pinned}`;
    if (key === this.key && last === this.last) return;
    this.key = key;
    this.last = last;
    const until = app.pinned ?? Infinity;
    const text = this.filter.value.toLowerCase();
    const shown = entries.filter((entry) => entry.sequence <= until
      && (!this.only.checked || entry.name === app.settings.selected)
      && (text === "" || `${entry.name} ${entry.text}`.toLowerCase().includes(text))).slice(-mostLines);
    setText(this.lost, lost > 0 ? `The ${lost} oldest lines are not kept by this page.` : "");
    const isAtEnd = this.lines.scrollTop + this.lines.clientHeight > this.lines.scrollHeight - 30;
    this.show(shown);
    if (isAtEnd) this.lines.scrollTop = this.lines.scrollHeight;
  }

  /** Adds what is new at the end, if what is shown stays. */
  private show(entries: LogEntry[]): void {
    const first = entries.length > 0 ? this.shown.indexOf(entries[0]) : -1;
    const stay = first < 0 ? [] : this.shown.slice(first);
    if (stay.length > 0 && stay.every((entry, i) => entry === entries[i])) {
      for (let i = 0; i < first; ++i) this.lines.firstElementChild!.remove();
      this.lines.append(...entries.slice(stay.length).map((entry) => this.line(entry)));
    } else {
      this.lines.replaceChildren(...entries.map((entry) => this.line(entry)));
      if (entries.length === 0) this.lines.append(make("p.empty", {}, "No lines."));
    }
    this.shown = entries;
  }

  private line(entry: LogEntry): HTMLElement {
    const text = longText("span.text", entry.text, entry.length);
    return make(`div.line.level${entry.level}`, { title: "Show this moment", click: () => this.app.pin(entry.sequence) },
      make("span.number.muted", {}, entry.seconds.toFixed(2)), make("span.who", {}, entry.name), text);
  }
}
