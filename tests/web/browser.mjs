// SPDX-License-Identifier: MIT
// A real Chromium without a display, a run of the real program, and what both tell.
import { spawn } from "node:child_process";
import { accessSync } from "node:fs";
import { once } from "node:events";
import { createInterface } from "node:readline";
import { fileURLToPath, pathToFileURL } from "node:url";

export const root = fileURLToPath(new URL("../../", import.meta.url));
const bin = process.env.ZIGGURAT_BIN ?? `${root}build/release/bin`;
export const ziggurat = `${bin}/ziggurat`;
export const playerFile = `${bin}/../share/ziggurat/web/player.html`;
const skipped = 77; // ctest's sign

function chromiumPath() {
  const named = process.env.CHROMIUM; // another one than Debian's
  for (const path of named ? [named] : ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"]) {
    try {
      accessSync(path);
      return path;
    } catch { /* the next */ }
  }
  console.log("SKIPPED: chromium is not installed (apt-get install chromium)");
  process.exit(skipped);
}

export async function openBrowser() {
  const executablePath = chromiumPath();
  const { chromium } = await import("playwright-core");
  return chromium.launch({ executablePath, args: [
    "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
    "--disable-sync", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
}

/** A run with --view; it ends with stop(). */
export class Run {
  constructor(process, address) {
    this.process = process;
    this.address = address;
  }

  /** @param options  further arguments of `ziggurat run` */
  static start(scene, ...options) { return Run.launch("run", scene, options); }

  /** The same of `ziggurat replay`. */
  static replay(recording, ...options) { return Run.launch("replay", recording, options); }

  /** The same of `ziggurat view` for a folder of scenes. */
  static view(folder, ...options) { return Run.launch("view", folder, options, []); }

  static async launch(command, file, options, quiet = ["--quiet"]) {
    const child = spawn(ziggurat, [command, file, ...quiet, ...(options.some((option) => option.startsWith("--view"))
      ? options : ["--view=127.0.0.1:0", ...options])], { cwd: root, stdio: ["ignore", "ignore", "pipe"] });
    const told = [];
    for await (const line of createInterface({ input: child.stderr })) {
      told.push(line);
      const address = /http:\/\/\S+/.exec(line)?.[0];
      if (!address) continue;
      child.stderr.resume();
      return new Run(child, new URL(address));
    }
    throw new Error(`no address was printed:\n${told.join("\n")}`);
  }

  async stop(signal = "SIGINT") {
    if (this.process.exitCode !== null || this.process.signalCode !== null) return;
    this.process.kill(signal);
    await once(this.process, "exit");
  }
}

/** An empty page. What goes wrong in it is in `problems`, requests to other machines in `foreign`. */
export async function newPage(browser, size = { width: 940, height: 460 }) {
  const context = await browser.newContext({ viewport: size });
  const page = await context.newPage();
  page.problems = [];
  page.foreign = [];
  page.on("console", (message) => {
    if (message.type() === "error" || message.type() === "warning") page.problems.push(message.text());
  });
  page.on("pageerror", (error) => page.problems.push(error.stack ?? error.message));
  page.on("request", (request) => {
    const url = new URL(request.url());
    if (!["127.0.0.1", ""].includes(url.hostname)) page.foreign.push(request.url());
  });
  page.on("websocket", (socket) => {
    if (new URL(socket.url()).hostname !== "127.0.0.1") page.foreign.push(socket.url());
  });
  return page;
}

/** A page at a run. */
export async function openPage(browser, address, hash = "", size = undefined) {
  const page = await newPage(browser, size);
  const url = new URL(address);
  url.hash = hash;
  await page.goto(url.href);
  await waitFor(() => page.evaluate(() => {
    const { app, view } = window.ziggurat ?? {};
    if (!app?.frame?.messages.has("/poses")) return false;
    if (!view.poses) return false; // its first frame is not drawn yet
    const index = app.world.entities.findIndex((entity) => !entity.removed);
    return index < 0 || view.originOf(index) !== null;
  }), "world in the page");
  return page;
}

/** A page from the disk, which is there when its program runs. */
export async function openFile(browser, path, hash = "", size = undefined) {
  const page = await newPage(browser, size);
  await page.goto(`${pathToFileURL(path)}#${hash}`);
  await waitFor(() => page.evaluate(() => window.ziggurat !== undefined), "page");
  return page;
}

/** Whether a page shows a recording. @param name  of its file; "": of any */
export function isShown(page, name = "") {
  return page.evaluate((wanted) => {
    const { app, view } = window.ziggurat;
    return app.recorded !== null && (wanted === "" || app.source.name === wanted) && app.frame !== null && view.poses !== null;
  }, name);
}

/** The tick of the newest frame that the page has. */
export function liveTick(page) { return page.evaluate(() => window.ziggurat.app.timeline.newest.tick); }
/** The tick that is shown; null: none is yet. */
export function shownTick(page) { return page.evaluate(() => window.ziggurat.app.frame?.tick ?? null); }

/** The tick at which time stands in the page: the picture follows what is chosen at a later redraw. */
export function pinnedTick(page) {
  return waitFor(() => page.evaluate(() => {
    const { app, view } = window.ziggurat;
    const isShown = app.pinned !== null && app.frame?.sequence === app.pinned && view.poses?.tick === app.frame.tick;
    return isShown && { tick: app.frame.tick };
  }), "moment that is shown").then(({ tick }) => tick);
}

/** Place of an entity's reference link in the frame that is shown. */
export function placeOf(page, id) {
  return page.evaluate((name) => {
    const { app, view } = window.ziggurat;
    const index = app.world.entities.findIndex((entity) => entity.id === name && !entity.removed);
    return index < 0 ? null : view.originOf(index)?.position ?? null;
  }, id);
}

/** Place of a point of the world on the page [px]. */
export function onScreen(page, point) {
  return page.evaluate((place) => {
    const { view } = window.ziggurat;
    const { camera, canvas } = view.stage;
    camera.updateMatrixWorld();
    const target = camera.position.clone().set(...place).project(camera);
    const box = canvas.getBoundingClientRect();
    return { x: box.left + (target.x + 1) / 2 * box.width, y: box.top + (1 - target.y) / 2 * box.height };
  }, point);
}

/** Pixels of a PNG: { width, height, data } with red, green, blue, alpha. */
export async function decode(page, png) {
  const { width, height, text } = await page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(image.width, image.height);
    const draw = canvas.getContext("2d");
    draw.drawImage(image, 0, 0);
    const { data } = draw.getImageData(0, 0, image.width, image.height);
    let text = "";
    for (let i = 0; i < data.length; i += 8192) text += String.fromCharCode(...data.subarray(i, i + 8192));
    return { width: image.width, height: image.height, text: btoa(text) };
  }, png.toString("base64"));
  return { width, height, data: Buffer.from(text, "base64") };
}

/** The picture of a world that stands: drawn as well as the page can. */
export async function pictureAtRest(page) {
  await waitFor(() => page.evaluate(() => {
    const { app, view } = window.ziggurat;
    const isShown = app.pinned === null ? view.poses?.tick === app.timeline.newest?.tick : app.frame?.sequence === app.pinned;
    return isShown && view.isAtRest;
  }), "picture at rest");
  return picture(page);
}

/** The picture of the world, without what lies over it. */
export async function picture(page) {
  const showOver = (visibility) => page.evaluate((wanted) => {
    for (const element of document.querySelectorAll(".tools, #notices, .scene-overlay")) element.style.visibility = wanted;
  }, visibility);
  await showOver("hidden");
  await page.evaluate(async () => {
    const frame = () => new Promise((resolve) => requestAnimationFrame(resolve));
    await frame();
    window.ziggurat.view.stage.renderer.getContext().finish(); // all that was asked for is drawn
    await frame(); // and handed over
    await frame();
  });
  const png = await page.locator("#world").screenshot();
  await showOver("");
  return png;
}

/** @param seconds  far more than it takes: machines may be busy */
export async function waitFor(look, what, seconds = 60) {
  const end = Date.now() + 1000 * seconds;
  for (;;) {
    const found = await look();
    if (found) return found;
    if (Date.now() > end) throw new Error(`within ${seconds} s: no ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}
