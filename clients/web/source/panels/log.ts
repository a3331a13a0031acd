// What robots and the server logged.
import type { App, LogEntry } from "../page/app";
import { make, setText } from "./element";
import type { Panel } from "./panel";

const mostLines = 300;

export class LogPanel implements Panel {
  readonly element = make("section.log");
  private readonly lines = make("div.lines");
  private readonly filter = make("input", { type: "search", placeholder: "Filter", "aria-label": "Filter the log" }) as HTMLInputElement;
  private readonly pauseOn = make("input", { placeholder: "Pause when a line contains …", "aria-label": "Pause when a line contains" }) as HTMLInputElement;
  private readonly only = make("input", { type: "checkbox" }) as HTMLInputElement;
  private key = "";

  constructor(private readonly app: App) {
    this.pauseOn.addEventListener("change", () => { app.pauseOnText = this.pauseOn.value; });
    this.element.append(make("div.chooser", {}, this.filter, make("label", {}, this.only, "selected only")),
                        make("div.chooser", {}, this.pauseOn), this.lines);
  }

  update(): void {
    const { app } = this;
    if (document.activeElement !== this.pauseOn) this.pauseOn.value = app.pauseOnText;
    const last = app.log[app.log.length - 1];
    const key = `${app.log.length}|${last?.sequence}|${this.filter.value}|${this.only.checked}|${app.settings.selected}|${app.pinned}`;
    if (key === this.key) return;
    this.key = key;
    const until = app.pinned ?? Infinity;
    const text = this.filter.value.toLowerCase();
    const shown = app.log.filter((entry) => entry.sequence <= until
      && (!this.only.checked || entry.name === app.settings.selected)
      && (text === "" || `${entry.name} ${entry.text}`.toLowerCase().includes(text))).slice(-mostLines);
    const isAtEnd = this.lines.scrollTop + this.lines.clientHeight > this.lines.scrollHeight - 30;
    this.lines.replaceChildren(...shown.map((entry) => this.line(entry)));
    if (shown.length === 0) this.lines.append(make("p.empty", {}, "No lines."));
    if (isAtEnd) this.lines.scrollTop = this.lines.scrollHeight;
  }

  private line(entry: LogEntry): HTMLElement {
    const text = make("span.text");
    setText(text, entry.text);
    return make(`div.line.level${entry.level}`, { title: "Show this moment", click: () => this.app.pin(entry.sequence) },
      make("span.number.muted", {}, entry.seconds.toFixed(2)), make("span.who", {}, entry.name), text);
  }
}
