// SPDX-License-Identifier: MIT
// The page: makes its parts and connects them.
import { embedded } from "./data/embedded";
import { GeneratedSource } from "./data/generated";
import { LiveSource } from "./data/live";
import { NoSource } from "./data/nothing";
import type { Source } from "./data/source";
import { View } from "./drawing/view";
import { fromAddress, toAddress, type Tab } from "./model/settings";
import { App } from "./page/app";
import { listenToKeys } from "./page/keys";
import { listenToFiles, openRecording } from "./page/open";
import { Pointer } from "./page/pointer";
import { copyLink, Film, savePicture } from "./page/share";
import { CameraPanel } from "./panels/camera";
import { Change } from "./panels/change";
import { Controllers } from "./panels/controllers";
import { Devices } from "./panels/devices";
import { icon, longText, make, setText } from "./panels/element";
import { Header } from "./panels/header";
import { fillHelp } from "./panels/help";
import { Layers } from "./panels/layers";
import { LogPanel } from "./panels/log";
import type { Panel } from "./panels/panel";
import { SceneOverlay } from "./panels/scene";
import { Plots } from "./panels/plots";
import { TimeBar } from "./panels/time";
import { Tree } from "./panels/tree";

const query = new URLSearchParams(location.search);
const updateEvery = 90; // [ms], of panels

function part<T extends HTMLElement>(id: string): T { return document.getElementById(id) as T; }

/** The server of this page, unless the address names another: `?server=HOST:PORT`, `?generated=COUNT`. */
function makeSource(): Source {
  const generated = Number(query.get("generated"));
  if (generated > 0) return new GeneratedSource(Math.min(generated, 100_000));
  if (location.protocol === "file:") return new NoSource("Drop a recording here, a file .mcap, or press “Open”.");
  const url = new URL(`${location.protocol === "https:" ? "wss" : "ws"}://${query.get("server") ?? location.host}/`);
  const token = query.get("token");
  if (token) url.searchParams.set("token", token);
  return new LiveSource(url);
}

const settings = fromAddress(location.hash);
const canvas = part<HTMLCanvasElement>("world");
function makeView(): View {
  try {
    return new View(canvas, settings.look !== null);
  } catch (error) {
    part("overlay").className = "full";
    setText(part("overlay"), (error as Error).message);
    throw error;
  }
}
const view = makeView();
const app = new App(makeSource(), settings, view);

// --- theme, address, notices ------------------------------------------------------------------------

const prefersDark = matchMedia("(prefers-color-scheme: dark)");
function applyTheme(): void {
  const theme = settings.theme === "system" ? (prefersDark.matches ? "dark" : "light") : settings.theme;
  document.documentElement.dataset.theme = theme;
  view.stage.setTheme(theme);
}
function toggleTheme(): void {
  settings.theme = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
  applyTheme();
  app.onSettings();
}
prefersDark.addEventListener("change", applyTheme);
applyTheme();

let addressTimer = 0;
app.onSettings = () => {
  clearTimeout(addressTimer);
  addressTimer = setTimeout(() => {
    if (settings.look) settings.look = view.stage.look;
    settings.tick = app.addressTick;
    history.replaceState(null, "", `${location.pathname}${location.search}#${toAddress(settings)}`);
  }, 250) as unknown as number;
};
view.stage.controls.addEventListener("end", () => app.looked());
window.addEventListener("hashchange", () => { // a link to another moment, opened in this page
  app.change(fromAddress(location.hash));
  applyTheme();
});

app.onNotice = ({ level, text }) => {
  const notice = make(`div.notice.${level}`, { click: () => notice.remove() }, longText("span", text));
  part("notices").append(notice);
  while (part("notices").childElementCount > 4) part("notices").firstElementChild!.remove();
  setTimeout(() => { if (!notice.querySelector(".open")) notice.remove(); }, level === "error" ? 12_000 : 6_000);
};

const overlay = part("overlay");
let frames = 0; // that were drawn
app.onStatus = () => {
  const { phase, text } = app.connection;
  const hasWorld = app.frame !== null && frames > 0;
  overlay.className = phase === "open" && hasWorld ? "" : hasWorld ? "banner" : "full";
  setText(overlay, phase === "open" ? (hasWorld ? "" : app.frame ? "Drawing …" : app.recorded ? "Reading …" : "Connected. Waiting for the world …")
                                    : text || `Connecting to ${app.source.name} …`);
};

// --- panels -------------------------------------------------------------------------------------------

const chooseFile = listenToFiles(app);
const help = part<HTMLDialogElement>("help");
fillHelp(help);
function openHelp(): void {
  help.showModal();
  help.scrollTop = 0; // the button that closes it, at its end, got the focus
}
const header = new Header(app, chooseFile, toggleTheme, openHelp);
const tree = new Tree(app);
const change = new Change(app);
const time = new TimeBar(app);
const left: Panel[] = [tree, new Layers(app), change];
const tabs: [Tab, string, Panel][] = [
  ["devices", "Devices", new Devices(app)], ["plots", "Plots", new Plots(app)], ["camera", "Camera", new CameraPanel(app)],
  ["log", "Log", new LogPanel(app)], ["controllers", "Controllers", new Controllers(app)],
];

part("header").append(
  make("button.side", { title: "World and layers", click: () => document.body.classList.toggle("show-left") }, "☰"),
  header.element,
  make("button.side", { title: "Devices, plots, log", click: () => document.body.classList.toggle("show-right") }, "☷"));
part("left").append(...left.map(({ element }) => element));
part("footer").append(time.element);
const tabButtons = new Map(tabs.map(([tab, label]) => [tab,
  make("button", { role: "tab", "data-tab": tab, click: () => app.openTab(tab) }, label)]));
const body = make("div.body");
part("right").append(make("nav", { role: "tablist" }, ...tabButtons.values()), body);

const tools = make("div.tools", {},
  ...(["select", "move", "ruler"] as const).map((tool) => make("button", {
    id: `tool-${tool}`, title: { select: "Select (v)", move: "Move (m)", ruler: "Ruler: the length between two clicks (u)" }[tool], click: () => { app.tool = tool; } }, icon(tool))),
  make("button", { title: "Look at all that moves (a)", click: () => app.look() }, "All"),
  make("button", { title: "From the top (o)", click: () => { view.stage.top(); app.looked(); } }, "Top"));
const scene = new SceneOverlay(app, canvas, () => tree.found);
const paint = scene.paint.bind(scene);
const film = new Film(app, paint);
const filmTime = make("span.number");
const share = make("div.tools.share", {},
  make("button", { id: "picture", title: "Save a picture of what you see (j)", click: () => savePicture(app, paint) }, icon("picture")),
  make("button", { id: "film", title: "Begin a film of what you see, or end and save it (w)", click: () => film.toggle() }, icon("film"), filmTime),
  make("button", { id: "link", title: "Copy a link to this moment (q)", click: () => void copyLink(app) }, icon("link")));
part("center").append(scene.element, tools, share);

function showTab(): Panel {
  const [tab, , panel] = tabs.find(([name]) => name === settings.tab)!;
  if (body.firstElementChild !== panel.element) body.replaceChildren(panel.element);
  for (const [name, button] of tabButtons) button.classList.toggle("on", name === tab);
  return panel;
}

function updatePanels(): void {
  for (const panel of [header, time, ...left, showTab()]) panel.update();
  for (const tool of ["select", "move", "ruler"]) part(`tool-${tool}`).classList.toggle("on", app.tool === tool);
  part("tool-move").hidden = !app.mayChange;
  part("film").classList.toggle("on", film.isRunning);
  setText(filmTime, film.isRunning ? `${film.seconds.toFixed(0)} s` : "");
  canvas.dataset.tool = app.tool;
  app.onStatus();
}

// --- input and frames -----------------------------------------------------------------------------------

new Pointer(app, canvas, (x, y, z) => change.setPlace(x, y, z));
listenToKeys(app, {
  open: chooseFile, help: () => (help.open ? help.close() : openHelp()), theme: toggleTheme,
  search: () => tree.search.focus(), speed: (by) => time.changeSpeed(by),
  picture: () => savePicture(app, paint), film: () => film.toggle(), link: () => void copyLink(app),
});

let shownKey = "";
let updated = 0;
let lastPoses: unknown = null;
function drawFrame(now: number): void {
  app.play(now * 1e-3);
  app.chooseFrame();
  const { frame } = app;
  const poses = frame?.messages.get("/poses");
  if (frame && poses) {
    const key = `${frame.sequence}|${settings.selected}|${settings.trailed.join()}|${frame.messages.size}`;
    if (key !== shownKey || lastPoses !== poses) {
      shownKey = key;
      lastPoses = poses;
      view.show(frame, app.selectedLinks, app.recorded ? null : app.timeline, app.isPaused, now * 1e-3);
    }
  }
  const hasDrawn = view.render(now * 1e-3);
  if (hasDrawn && view.poses && ++frames === 1) app.onStatus();
  scene.update(now);
  film.frame(hasDrawn);
  if (!view.stage.isBusy) app.source.ready?.();
  if (now - updated > updateEvery) {
    updated = now;
    updatePanels();
  }
}

function draw(now: number): void {
  requestAnimationFrame(draw);
  try {
    drawFrame(now);
  } catch (error) {
    if (!app.recorded) throw error;
    // A file may contain anything: what can't be drawn is not shown any longer.
    const text = `${app.source.name} can't be shown: its messages are damaged (${(error as Error).message}).`;
    app.open(new NoSource(text));
    app.notice("error", text);
  }
}

const inside = embedded();
if (inside) void openRecording(app, inside.file, inside.name);
else app.source.start(app);
requestAnimationFrame(draw);

/** For tests and the curious: `ziggurat` in the browser's console. */
Object.assign(window, { ziggurat: { app, view, framesDrawn: () => frames } });
