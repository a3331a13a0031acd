// The live server, seen by a viewer of its protocol that others have written: Foxglove Studio 1.48.0, the last that npm has.
// It draws /scene by /tf, lists log lines and parameters, and decodes a robot's observation by its schema.
//
// usage: node studio_test.mjs FOLDER [SCREENSHOT]    FOLDER has the packages (npm ci); ZIGGURAT_BIN is that of the programs
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import http from "node:http";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { decode, newPage, openBrowser, Run, waitFor } from "../../web/browser.mjs";

const [folder, screenshot] = process.argv.slice(2);
const here = fileURLToPath(new URL(".", import.meta.url));
const packages = join(folder, "node_modules");
const types = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };

/** Its parts, which look for each other beside index.js or at the root. */
async function find(path) {
  const name = normalize(path === "/" ? "/studio.html" : path);
  for (const place of [here, packages, join(packages, "@foxglove/studio-base/assets")]) {
    try {
      return { data: await readFile(join(place, name)), type: types[extname(name)] };
    } catch { /* the next */ }
  }
  return null;
}

const web = http.createServer(async (request, response) => {
  const found = await find(new URL(request.url, "http://x").pathname);
  response.writeHead(found ? 200 : 404, { "Content-Type": found?.type ?? "application/octet-stream" });
  response.end(found?.data);
});
await new Promise((resolve) => web.listen(0, "127.0.0.1", resolve));

const browser = await openBrowser();
const run = await Run.start("scenes/prototype_radio_test.argos", "--duration=0", "--real-time=1");
try {
  const page = await newPage(browser, { width: 1400, height: 800 });
  const told = [];
  page.on("console", (message) => told.push(message.text()));
  page.on("pageerror", (error) => told.push(`error: ${error.stack ?? error.message}`));
  const url = `ws://${run.address.host}/${run.address.search}`;
  await page.goto(`http://127.0.0.1:${web.address().port}/?url=${encodeURIComponent(url)}`);
  const text = () => page.locator("body").innerText();
  await waitFor(async () => /radio_messages/.test(await text()), "observation", 120);
  await waitFor(async () => /token \d+/.test(await text()), "log line", 120);
  await waitFor(async () => /real_time_factor/.test(await text()), "parameters", 120);
  await page.getByText("Problems").first().click();
  await waitFor(async () => /No problems found/.test(await text()), `viewer without problems; it told ${told.join("\n")}`);
  const isDrawn = async () => { // the robots are blue, and nothing else in the middle of the picture is
    const { data } = await decode(page, await page.screenshot({ clip: { x: 500, y: 120, width: 450, height: 500 } }));
    let blue = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i + 2] - data[i] > 40) ++blue;
    return blue > 5000;
  };
  await waitFor(isDrawn, "robots in the picture", 120);
  if (screenshot) await page.screenshot({ path: screenshot });
  assert.deepEqual(told.filter((line) => /Player problem|^error/.test(line)), []);
  assert.deepEqual(page.foreign, []);
  console.log("Foxglove Studio shows the world and has no problems with it");
} finally {
  await browser.close();
  await run.stop();
  web.close();
}
