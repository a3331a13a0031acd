// SPDX-License-Identifier: MIT
// Moments of a recording and of a running world: links, pictures, films, plots, marks, the tree: ctest -R web/moments.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { after, before, test } from "node:test";
import { isShown, liveTick, openBrowser, openFile, openPage, pinnedTick, root, Run, shownTick, waitFor, ziggurat } from "./browser.mjs";

const vehicle = "scenes/dynamics3d_multi_body_test.argos";
const robots = `${root}tests/web/robots.argos`;
const directed = `${root}tests/web/directed.argos`;
const ticks = 60;

let browser, folder, exported;
before(async () => {
  browser = await openBrowser();
  folder = mkdtempSync(`${tmpdir()}/zm`);
  exported = `${folder}/vehicle.html`;
  execFileSync(ziggurat, ["run", vehicle, "--ticks", String(ticks), "--record", `${folder}/vehicle.mcap`, "--quiet"], { cwd: root, stdio: "pipe" });
  execFileSync(ziggurat, ["export", `${folder}/vehicle.mcap`, "--html", exported, "--quiet"]);
});
after(async () => {
  await browser?.close();
  if (folder) rmSync(folder, { recursive: true });
});

const tickIs = (page, tick) => waitFor(async () => (await shownTick(page)) === tick, `tick ${tick}`);
const hashHas = (page, text) => waitFor(() => page.evaluate((part) => location.hash.includes(part), text), `${text} in the address`);

/** The file that the page saves. */
async function saved(page, act) {
  const [download] = await Promise.all([page.waitForEvent("download"), act()]);
  const path = `${folder}/${download.suggestedFilename()}`;
  await download.saveAs(path);
  return { name: download.suggestedFilename(), bytes: readFileSync(path) };
}

const sizeOf = (png) => [png.readUInt32BE(16), png.readUInt32BE(20)];

test("an exported page opens at a tick; plots, pictures, films and links of it", { timeout: 180_000 }, async () => {
  const plot = (topic, path) => `plot=${encodeURIComponent(`/robots/vehicle/${topic}:${path}`)}`;
  const page = await openFile(browser, exported, `tick=20&selected=vehicle&tab=plots&bookmark=30&eye=0.4,-0.4,0.3&at=0,0,0.05&fov=45&${
    plot("observation", "jointReadings.0")}&${plot("command", "jointTargets.0")}&plot=${encodeURIComponent("/poses:positions.12")}`);
  await waitFor(() => isShown(page), "first frame");
  await tickIs(page, 20);
  assert.ok(!(await page.evaluate(() => window.ziggurat.app.playback.isPlaying)));

  // Plots: two series of one unit in one chart, one of another unit, all with labels.
  await waitFor(() => page.evaluate((count) => window.ziggurat.app.series.every(({ values }) => values.length >= count), ticks), "plotted values");
  const wanted = ["vehicle base_wheel_fr velocity [rad/s]", "vehicle base_wheel_fr velocity, commanded [rad/s]", "vehicle/base position x [m]"];
  await waitFor(async () => (await page.locator(".plot-box .label").allTextContents()).join("|") === wanted.join("|"), "three labels");
  assert.equal(await page.locator(".plot-box").count(), 2);
  const table = await saved(page, () => page.locator("#plots-csv").click());
  const rows = table.bytes.toString().trim().split("\n");
  assert.equal(rows[0], "time [s],vehicle base_wheel_fr velocity [rad/s],\"vehicle base_wheel_fr velocity, commanded [rad/s]\",vehicle/base position x [m]");
  assert.equal(rows.length, ticks + 2); // all of the recording, not what was played
  assert.ok(Math.abs(Number(rows[40].split(",")[1]) - 1) < 0.01, rows[40]);
  const charts = await saved(page, () => page.locator("#plots-png").click());
  assert.ok(sizeOf(charts.bytes)[0] > 250 && sizeOf(charts.bytes)[1] > 300, `${sizeOf(charts.bytes)}`);

  // A value at the mouse; a click shows that moment.
  const over = await page.locator(".plot-box .u-over").first().boundingBox();
  await page.mouse.move(over.x + 0.75 * over.width, over.y + over.height / 2);
  const time = await waitFor(async () => {
    const text = await page.locator(".plot-box .title.muted .number").first().textContent();
    return Math.abs(Number.parseFloat(text) - 9) < 0.5 && text;
  }, "time at the mouse");
  await page.mouse.click(over.x + 0.75 * over.width, over.y + over.height / 2);
  await tickIs(page, Math.round(5 * Number.parseFloat(time)));

  // A recording can't be changed, and the page does not offer it.
  await page.locator('[data-tab="devices"]').click();
  for (const control of ["#remove", "#tool-move", ".change"]) await page.locator(control).waitFor({ state: "hidden" });
  assert.doesNotMatch(await page.locator("body").innerText(), /barrier|steer/i);

  // A bookmark of the address and one of the key; the lane of log lines is switched off.
  await waitFor(() => page.evaluate(() => window.ziggurat.app.bookmarks.some(({ sequence }) => sequence === 30)), "bookmark of the address");
  await page.locator("#world").focus();
  await page.keyboard.press("s");
  await waitFor(() => page.evaluate(() => window.ziggurat.app.bookmarks.length === 2), "bookmark of the key");
  await page.locator(".lanes summary").click();
  await page.locator('[data-lane="log"]').click();
  await hashHas(page, "hide=log");

  const picture = await saved(page, () => page.locator("#picture").click());
  assert.match(picture.name, /^dynamics3d_multi_body_test tick \d+\.png$/);
  const box = await page.locator("#world").boundingBox();
  const [width, height] = sizeOf(picture.bytes);
  assert.ok(Math.abs(width / height - box.width / box.height) < 0.02 && width >= 0.5 * box.width, `${width} × ${height}`);
  assert.ok(picture.bytes.length > 5000, `${picture.bytes.length} bytes`); // not of one colour

  await page.locator("#film").click();
  await page.locator("#play").click();
  await page.waitForTimeout(700); // elapsed time is the subject
  const film = await saved(page, () => page.locator("#film").click());
  assert.match(film.name, /^dynamics3d_multi_body_test tick \d+ to \d+\.webm$/);
  assert.equal(film.bytes.readUInt32BE(0), 0x1a45dfa3); // as Matroska begins
  assert.ok(film.bytes.length > 5000, `${film.bytes.length} bytes`);

  // Another link to the same page.
  await page.evaluate(() => { location.hash = "tick=7&tab=log"; });
  await tickIs(page, 7);
  await hashHas(page, "tick=7");
  await page.locator(".log").waitFor();
  assert.deepEqual(page.problems, []);
  await page.context().close();
});

test("a running world is shown at a tick as soon as it comes; metrics are plotted; the tree; a phone", { timeout: 180_000 }, async () => {
  const run = await Run.start(directed);
  try {
    const page = await openPage(browser, run.address, `tick=40&tab=plots&plot=${encodeURIComponent("/metrics:large/ticks")}&plot=${encodeURIComponent("/metrics:judge/half")}`, { width: 390, height: 844 });
    await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
    // A page that draws slowly is sent fewer ticks: time stands at the newest of them, up to that of the address.
    const stands = await pinnedTick(page);
    const next = await waitFor(() => page.evaluate((tick) => {
      const { pinned, timeline } = window.ziggurat.app;
      for (let sequence = pinned + 1; sequence <= timeline.last; ++sequence) {
        if (timeline.tickOf(sequence) > tick) return timeline.tickOf(sequence);
      }
      return null;
    }, stands), "a later tick");
    assert.ok(stands <= 40 && next > 40, `${stands}, then ${next}`);
    await waitFor(async () => (await liveTick(page)) > 42, "ticks after it");
    assert.equal(await shownTick(page), stands);

    await page.locator(".side").last().click();
    await waitFor(async () => (await page.locator(".plot-box .label").allTextContents()).join() === "large ticks,judge half", "labels of the metrics");
    await waitFor(() => page.evaluate(() => window.ziggurat.app.series.every(({ values }) => values.length > 3)), "values of both");
    const [ticks, half] = await page.evaluate(() => window.ziggurat.app.series.map(({ values }) => values));
    for (const values of [ticks, half]) assert.ok(values.every((value, i) => i === 0 || value > values[i - 1]), `${values}`);
    assert.ok(half.every((value) => Number.isInteger(2 * value)) && half.some((value) => !Number.isInteger(value)), `${half}`);
    await page.locator(".side").last().click();

    const line = await page.locator("#timeline").boundingBox(), play = await page.locator("#play").boundingBox();
    assert.ok(line.width > 370 && line.y + line.height <= play.y, "the time line has a row of its own");

    await page.locator(".side").first().click();
    const type = page.locator("#tree-type");
    assert.ok((await type.locator("option").allTextContents()).includes("foot-bot (1)"));
    await type.selectOption("foot-bot");
    assert.deepEqual(await page.locator("[data-entity]").evaluateAll((all) => all.map(({ dataset }) => dataset.entity)), ["large"]);
    await page.locator(".side").first().click();

    await page.locator("#link").click();
    await page.locator(".notice", { hasText: "clipboard" }).waitFor();
    const link = await page.evaluate(() => navigator.clipboard.readText());
    assert.match(link, new RegExp(`#eye=.*tick=${stands}`));
    assert.doesNotMatch(link, /token/);
    assert.deepEqual(page.problems, []);
  } finally {
    await run.stop();
  }
});
