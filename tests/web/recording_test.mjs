// SPDX-License-Identifier: MIT
// The page as a player of recordings, in a real browser, without a server: ctest -R web/recording.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { after, before, test } from "node:test";
import { isShown, openBrowser, openFile, pictureAtRest, pinnedTick, placeOf, playerFile, root, shownTick, waitFor, ziggurat } from "./browser.mjs";

const drop = "scenes/dynamics3d_single_body_test.argos";
const hostileName = "<img src=x onerror=document.title=666>";

let browser, folder, recording;
before(async () => {
  browser = await openBrowser();
  folder = mkdtempSync(`${tmpdir()}/zr`);
  recording = `${folder}/drop.mcap`;
  run(drop, recording);
});
after(async () => {
  await browser?.close();
  if (folder) rmSync(folder, { recursive: true });
});

function run(scene, file) {
  execFileSync(ziggurat, ["run", scene, "--ticks", "40", "--record", file, "--quiet"], { cwd: root, stdio: "pipe" });
}

/** Drops a file on the page, as from a folder of the desktop. */
async function dropFile(page, bytes, name) {
  await page.evaluate(async ([base64, fileName]) => {
    const data = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File([data], fileName));
    window.dispatchEvent(new DragEvent("drop", { dataTransfer, bubbles: true, cancelable: true }));
  }, [Buffer.from(bytes).toString("base64"), name]);
}

/** The recording of the drop plays, stands, and is at any place. */
async function checkPlaying(page) {
  await waitFor(() => isShown(page), "first frame");
  await page.locator("#speed").selectOption("0.5"); // it lasts 16 s: slow pages pause it before its end
  await waitFor(async () => (await shownTick(page)) >= 2, "tick 2");
  await page.locator("#play").click();
  await waitFor(() => page.evaluate(() => !window.ziggurat.app.playback.isPlaying), "pause");
  const tick = await pinnedTick(page);
  await page.waitForTimeout(500); // more than a tick: elapsed time is the subject
  assert.equal(await shownTick(page), tick);
  await page.locator("#step").click();
  await waitFor(async () => (await shownTick(page)) === tick + 1, "next tick");

  const id = await page.evaluate(() => window.ziggurat.app.world.entities.find(({ movable }) => movable).id);
  const line = await page.locator("#timeline").boundingBox();
  await page.mouse.click(line.x + line.width - 1, line.y + line.height / 2);
  await waitFor(async () => (await shownTick(page)) >= 39, "end");
  const end = await pictureAtRest(page);
  const low = (await placeOf(page, id))[2];
  await page.mouse.click(line.x + 1, line.y + line.height / 2);
  await waitFor(async () => (await shownTick(page)) === 0, "start");
  await waitFor(async () => (await placeOf(page, id))[2] > low + 0.02, "the body where it began");
  assert.ok(!(await pictureAtRest(page)).equals(end)); // bodies moved
}

/** Each kind of damage gives a sentence. */
async function checkDamaged(page) {
  const whole = readFileSync(recording);
  const told = async (bytes, sentence) => {
    await page.evaluate(() => document.querySelector("#notices").replaceChildren());
    await dropFile(page, bytes, "bad.mcap");
    await waitFor(async () => sentence.test(await page.locator("#notices").textContent()), `${sentence}`);
  };
  await told(Buffer.from("<script>document.title=666</script>"), /bad.mcap is no recording/);
  await told(whole.subarray(0, 30), /bad.mcap has no messages/);
  await told(whole.subarray(0, whole.length - 20), /is cut off after/);
  const flipped = Buffer.from(whole);
  for (let i = 2000; i < flipped.length; i += 997) flipped[i] ^= 0x20;
  await told(flipped, /bad.mcap (can't be read|is damaged|has no)/);
}

/** Closes a page that had no trouble. */
async function close(page) {
  assert.deepEqual(page.problems, []);
  assert.deepEqual(page.foreign, []);
  await page.context().close();
}

test("a damaged file gives a sentence; one that is dropped on the page plays, stands and is scrubbed", { timeout: 180_000 }, async () => {
  const page = await openFile(browser, playerFile);
  await page.locator("#overlay", { hasText: "Drop a recording" }).waitFor();
  await checkDamaged(page);
  await dropFile(page, readFileSync(recording), "drop.mcap");
  await waitFor(() => isShown(page, "drop.mcap"), "the file that was dropped"); // one that is damaged may be shown, too
  await checkPlaying(page);
  await page.keyboard.press("e"); // asks for a file, which is there already
  await page.locator("#recording-file").setInputFiles(recording);
  await waitFor(() => isShown(page), "the file that was chosen");
  await close(page);
});

test("the exported page plays from the disk, with nothing but itself", { timeout: 180_000 }, async () => {
  const out = `${folder}/drop.html`;
  execFileSync(ziggurat, ["export", recording, "--html", out, "--quiet"]);
  const text = readFileSync(out, "utf8");
  assert.match(text, /default-src 'none'/);
  assert.doesNotMatch(text, /unsafe-inline|unsafe-eval/);
  const page = await openFile(browser, out);
  await checkPlaying(page);
  await close(page);
});

test("names of a recording are text", { timeout: 180_000 }, async () => {
  const scene = `${folder}/names.argos`;
  const escaped = hostileName.replaceAll("<", "&lt;").replaceAll(">", "&gt;");
  writeFileSync(scene, readFileSync(`${root}tests/web/tags.argos`, "utf8").replace('"near"', `"${escaped}"`));
  const file = `${folder}/"&${hostileName}.mcap`; // in the page, too
  run(scene, file);
  const out = `${folder}/names.html`;
  execFileSync(ziggurat, ["export", file, "--html", out, "--quiet"]);
  const page = await openFile(browser, out, `selected=${encodeURIComponent(hostileName)}`);
  await waitFor(() => isShown(page), "first frame");
  await waitFor(async () => (await page.locator(".tree").textContent()).includes(hostileName), "its name");
  await page.waitForTimeout(200); // elapsed time is the subject
  assert.equal(await page.locator("img").count(), 0);
  assert.notEqual(await page.title(), "666");
  await close(page);
});
