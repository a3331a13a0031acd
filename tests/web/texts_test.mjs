// SPDX-License-Identifier: MIT
// Long texts of robots, scenes and recordings in the page, in a real browser: ctest -R web/texts.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { pathToFileURL } from "node:url";
import { after, before, test } from "node:test";
import { newPage, openBrowser, openPage, playerFile, Run, waitFor, ziggurat } from "./browser.mjs";

const letters = 20_000;
const mostOfAnyText = 1500;

let browser, folder, scene;
before(async () => {
  browser = await openBrowser();
  folder = mkdtempSync(`${tmpdir()}/zt`);
  writeFileSync(`${folder}/long.lua`, `local n = 0
    function init() robot.tags.set_all_payloads(("P"):rep(60000)) end
    function step() n = n + 1; log(n .. " " .. ("L"):rep(${letters})) end
    function reset() end function destroy() end`);
  scene = `${folder}/long.argos`;
  writeFileSync(scene, `<argos-configuration>
    <framework><experiment length="0" ticks_per_second="10" random_seed="1"/></framework>
    <controllers><lua_controller id="c"><actuators><tags implementation="default"/></actuators><sensors/>
      <params script="long.lua" big="${"B".repeat(100_000)}"/></lua_controller></controllers>
    <arena size="6,6,2"><prototype id="r" movable="true"><body position="0,0,0"/><controller config="c"/>
      <links ref="b"><link id="b" geometry="box" size="0.1,0.1,0.1" mass="1"/></links>
      <devices><tags medium="t"><tag anchor="b" position="0,0,0.11" orientation="0,0,0" observable_angle="80"
        side_length="0.05"/></tags></devices></prototype></arena>
    <physics_engines><dynamics3d id="d" iterations="4"><floor/><gravity g="9.8"/></dynamics3d></physics_engines>
    <media><tag id="t"/></media></argos-configuration>`);
});
after(async () => {
  await browser?.close();
  if (folder) rmSync(folder, { recursive: true });
});

/** Time that the page needs to answer [s], after it has drawn. */
async function answerTime(page) {
  const begin = Date.now();
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve))));
  return (Date.now() - begin) / 1000;
}

function longestText(page) {
  return page.evaluate(() => {
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    let most = 0;
    while (walker.nextNode()) if (walker.currentNode.parentElement.tagName !== "SCRIPT") most = Math.max(most, walker.currentNode.data.length);
    return most;
  });
}

/** Opens the first long line, and closes it. */
async function openLine(page) {
  const text = page.locator(".log .line .text").first();
  await text.locator(".more").click();
  const length = (await text.textContent()).length;
  assert.ok(length > 9000 && length < 11_000, `${length} characters`);
  assert.ok((await answerTime(page)) < 5);
  await text.locator(".more").click();
  assert.ok((await text.textContent()).length < 500);
}

test("long log lines, parameters and payloads: a part of each, the rest on a click, and lines that stay", { timeout: 180_000 }, async () => {
  const run = await Run.start(scene, "--real-time=1");
  try {
    const page = await openPage(browser, run.address, "tab=log");
    const lines = page.locator(".log .line");
    await waitFor(async () => (await lines.count()) >= 3, "lines");
    assert.ok((await lines.first().locator(".text").textContent()).length < 500);
    await openLine(page);
    await page.evaluate(() => { window.firstLine = document.querySelector(".log .line"); });
    const before = await lines.count();
    await waitFor(async () => (await lines.count()) >= before + 10, "more lines");
    assert.ok(await page.evaluate(() => window.firstLine.isConnected), "lines were made anew");
    await page.locator('[aria-label="Pause when a line contains"]').fill("LLL");
    await page.keyboard.press("Enter");
    const notice = page.locator(".notice");
    await notice.waitFor();
    assert.match(await notice.textContent(), /^Paused: r logged “\d+ L+…/);
    assert.ok((await notice.textContent()).length < 500);
    await notice.locator(".more").click();
    assert.ok((await notice.textContent()).length > 9000);
    assert.ok((await answerTime(page)) < 5);
    await notice.click({ position: { x: 3, y: 3 } }); // it goes
    await page.locator(".tree .row", { hasText: "r" }).first().click();
    await page.locator('[data-tab="devices"]').click();
    await page.evaluate(() => window.ziggurat.app.call("/resume"));
    await page.locator('[data-reading^="Commands/Tags"]').waitFor();
    const cell = page.locator(".params tr", { hasText: "big" }).locator("td").nth(1);
    assert.ok((await cell.textContent()).length < 500);
    assert.ok((await longestText(page)) < mostOfAnyText);
    assert.ok((await answerTime(page)) < 5);
    await cell.locator(".more").click();
    assert.match(await cell.textContent(), / … and 90000 more less$/);
    assert.ok((await answerTime(page)) < 5);
    assert.deepEqual(page.problems, []);
    await page.context().close();
  } finally {
    await run.stop();
  }
});

test("a recording with 300 long lines is shown at once", { timeout: 180_000 }, async () => {
  const file = `${folder}/long.mcap`;
  execFileSync(ziggurat, ["run", scene, "--ticks", "310", "--record", file, "--quiet"], { stdio: "ignore" });
  const page = await newPage(browser);
  await page.goto(`${pathToFileURL(playerFile)}#tab=log`);
  await waitFor(() => page.evaluate(() => window.ziggurat !== undefined), "page");
  await page.locator("#recording-file").setInputFiles(file);
  await waitFor(() => page.evaluate(() => window.ziggurat.app.log.entries.length >= 309), "the log");
  await page.keyboard.press("End");
  await waitFor(async () => (await page.locator(".log .line").count()) >= 299, "lines");
  const took = await answerTime(page);
  const other = await newPage(browser); // an empty one is the measure, at this moment
  const idle = await answerTime(other);
  await other.context().close();
  console.log(`300 lines of ${letters} characters: an answer after ${took.toFixed(2)} s`);
  assert.ok(took < 5 + 20 * idle, `an empty page takes ${idle} s`);
  assert.ok((await longestText(page)) < mostOfAnyText);
  const kept = await page.evaluate(() => Math.max(...window.ziggurat.app.log.entries.map(({ text }) => text.length)));
  assert.equal(kept, 10_000);
  await openLine(page);
  assert.deepEqual(page.problems, []);
  await page.context().close();
});
