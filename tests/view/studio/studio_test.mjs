// SPDX-License-Identifier: MIT
// The live server and a recording, seen by a viewer that others have written: Foxglove Studio 1.48.0, the last that npm has.
// It draws /scene by /tf, lists log lines and parameters, decodes messages by their schemas, and has no problem with any topic.
//
// usage: node studio_test.mjs FOLDER [SCREENSHOT]    FOLDER has the packages (npm ci); ZIGGURAT_BIN is that of the programs
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { readFile } from "node:fs/promises";
import http from "node:http";
import { tmpdir } from "node:os";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { decode, newPage, openBrowser, root, Run, waitFor, ziggurat } from "../../web/browser.mjs";

const [folder, screenshot] = process.argv.slice(2);
const scene = "scenes/prototype_radio_test.argos";
const recorded = mkdtempSync(join(tmpdir(), "studio-"));
const here = fileURLToPath(new URL(".", import.meta.url));
const packages = join(folder, "node_modules");
const types = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };

/** Its parts, which look for each other beside index.js or at the root. */
async function find(path) {
  const name = normalize(path === "/" ? "/studio.html" : path);
  for (const place of [here, recorded, packages, join(packages, "@foxglove/studio-base/assets")]) {
    try {
      return { data: await readFile(join(place, name)), type: types[extname(name)] };
    } catch { /* the next */ }
  }
  return null;
}

/** What a file has, or the part of it that is asked for. */
const web = http.createServer(async (request, response) => {
  const found = await find(new URL(request.url, "http://x").pathname);
  const part = found && /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? "");
  const data = part ? found.data.subarray(Number(part[1]), Number(part[2]) + 1) : found?.data;
  const range = part ? { "Content-Range": `bytes ${part[1]}-${part[2]}/${found.data.length}` } : {};
  response.writeHead(found ? (part ? 206 : 200) : 404, {
    "Content-Type": found?.type ?? "application/octet-stream", "Content-Length": data?.length ?? 0, "Accept-Ranges": "bytes", ...range });
  response.end(data);
});
await new Promise((resolve) => web.listen(0, "127.0.0.1", resolve));
const browser = await openBrowser();

/** What a page tells when its viewer has no picture, and whether its browser lost the graphics. */
async function state(page, told) {
  const graphics = await page.evaluate(() => [...document.querySelectorAll("canvas")].map((canvas) => {
    const context = canvas.getContext("webgl2");
    return `${canvas.width} x ${canvas.height}${context ? (context.isContextLost() ? ", graphics lost" : "") : ", no graphics"}`;
  }));
  return [...graphics, ...told, await page.locator("body").innerText()].join("\n");
}

/**
 * The viewer with the world at `url`, with no problem, after it has shown `texts` and the robots.
 * `begin` is called when it has shown the first.
 */
async function open({ url, topic, texts, begin }) {
  const page = await newPage(browser, { width: 1400, height: 800 });
  page.setDefaultTimeout(120000); // machines may be busy
  const told = [];
  page.on("console", (message) => told.push(message.text()));
  page.on("pageerror", (error) => told.push(`error: ${error.stack ?? error.message}`));
  await page.goto(`http://127.0.0.1:${web.address().port}/?${new URLSearchParams({ url, topic })}`);
  const text = () => page.locator("body").innerText();
  for (const each of texts) {
    await waitFor(async () => each.test(await text()), `${each}`, 120);
    if (each === texts[0]) begin();
  }
  await page.getByText("Problems").first().click();
  await waitFor(async () => /No problems found/.test(await text()), `viewer without problems; it told ${told.join("\n")}`);
  const isDrawn = async () => { // the robots are blue, and nothing else in the middle of the picture is
    const { data } = await decode(page, await page.screenshot({ clip: { x: 500, y: 120, width: 450, height: 500 } }));
    let blue = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i + 2] - data[i] > 40) ++blue;
    return blue > 5000;
  };
  try {
    await waitFor(isDrawn, "robots in the picture", 120);
  } catch (error) {
    throw new Error(`${error.message}; the page had ${await state(page, told)}`);
  }
  if (screenshot) await page.screenshot({ path: `${screenshot}${topic.replaceAll("/", "_")}.png` });
  assert.deepEqual(told.filter((line) => /Player problem|^error/.test(line)), []);
  assert.deepEqual(page.foreign, []);
  await page.close();
}

/** A world that stands at its beginning is shown, and then runs. */
async function openLive() {
  const endpoint = `ipc://${recorded}/world`;
  const run = await Run.start(scene, "--duration=0", "--real-time=1", "--paused", `--endpoint=${endpoint}`);
  const begin = () => execFileSync(ziggurat, ["ctl", endpoint, "resume"]);
  try {
    const url = `ws://${run.address.host}/${run.address.search}`;
    await open({ url, topic: "/robots/repeater0/observation", texts: [/radio_messages/, /token \d+/, /real_time_factor/], begin });
  } finally {
    await run.stop();
  }
}

async function openRecording() {
  const file = join(recorded, "run.mcap");
  execFileSync(ziggurat, ["run", scene, "--ticks=50", "--quiet", "--record", file], { cwd: root, stdio: ["ignore", "ignore", "inherit"] });
  const url = `http://127.0.0.1:${web.address().port}/run.mcap`;
  await open({ url, topic: "/inputs", texts: [/commands/, /hash/], begin() {} });
}

try {
  await openLive();
  await openRecording();
  console.log("Foxglove Studio shows the live world and its recording, and has no problems with them");
} finally {
  await browser.close();
  web.close();
  rmSync(recorded, { recursive: true });
}
