// SPDX-License-Identifier: MIT
// The gallery of `ziggurat view FOLDER` in a real browser: ctest -R web/gallery.
import assert from "node:assert/strict";
import { copyFileSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { after, before, test } from "node:test";
import { Run, newPage, openBrowser, root, waitFor } from "./browser.mjs";

let browser, gallery, folder;

before(async () => {
  folder = mkdtempSync(`${tmpdir()}/ziggurat-gallery-`);
  process.env.XDG_CACHE_HOME = `${folder}/cache`;
  mkdirSync(`${folder}/scenes/broken`, { recursive: true });
  copyFileSync(`${root}scenes/dynamics3d_single_body_test.argos`, `${folder}/scenes/single.argos`);
  copyFileSync(`${root}tests/web/tags.argos`, `${folder}/scenes/tags.argos`);
  writeFileSync(`${folder}/scenes/broken/scene.argos`, "<!-- It <b>can't</b> be read. More. --><argos-configuration><nothing/></argos-configuration>");
  browser = await openBrowser();
  gallery = await Run.view(`${folder}/scenes`);
});

after(async () => {
  await gallery?.stop();
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** A look at a page that may be loaded anew meanwhile. */
function steady(look) {
  return async () => {
    try {
      return await look();
    } catch (error) {
      if (/context was destroyed|navigat/i.test(error.message)) return false;
      throw error;
    }
  };
}

test("each scene has a card with a picture and a sentence, and runs", async () => {
  const page = await newPage(browser);
  await page.goto(gallery.address.href);
  assert.deepEqual(await page.locator("h2").allTextContents(), ["broken/scene", "single", "tags"]);
  assert.equal(await page.locator("article p").first().textContent(), "It <b>can't</b> be read.");
  await waitFor(steady(() => page.evaluate(() => document.querySelector(".none")?.textContent === "no picture"
    && document.images.length === 2 && [...document.images].every(({ naturalWidth }) => naturalWidth === 480))),
  "pictures of the scenes that can be read");
  assert.deepEqual(page.problems, []);

  const running = async (name) => {
    await page.goto(gallery.address.href);
    await page.locator("article", { hasText: name }).locator(".run").click();
    await waitFor(steady(() => page.evaluate(() => {
      const { frame, connection } = window.ziggurat?.app ?? {};
      return connection?.mayControl && frame?.messages.has("/poses");
    })), `world of ${name}`);
    return new URL(page.url()).host;
  };
  const first = await running("single");
  const second = await running("tags");
  assert.notEqual(first, second);
  await assert.rejects(fetch(`http://${first}/`), "the run before has ended");

  await page.goto(gallery.address.href);
  await page.locator("article", { hasText: "broken" }).locator(".run").click();
  await waitFor(steady(async () => /ended with exit code 1/.test(await page.textContent("body"))), "end of the run that can't begin");
  await page.locator("a").click();
  await waitFor(async () => (await page.locator("h2").count()) === 3, "the gallery again");
  assert.deepEqual(page.foreign, []);
});

test("nothing is there without the token, for other names and for other paths", async () => {
  const { origin, pathname, port } = gallery.address;
  const status = async (path, options) => (await fetch(`${origin}${path}`, { redirect: "manual", ...options })).status;
  assert.equal(await status("/"), 403);
  assert.equal(await status("/run/0"), 403);
  assert.equal(await status(`${pathname.slice(0, -2)}x/`), 403);
  assert.equal(await status(`${pathname}picture/..%2f..%2fetc%2fpasswd`), 404);
  assert.equal(await status(`${pathname}run/17`), 404);
  assert.equal(await status(`${pathname}run/0`, { method: "POST" }), 405);
  const { request } = await import("node:http");
  const evil = await new Promise((resolve) => request({ port, host: "127.0.0.1", path: pathname, headers: { Host: "evil.example" } },
    (answer) => resolve(answer.statusCode)).end());
  assert.equal(evil, 403);
});

test("Ctrl-C ends the gallery and its run", async () => {
  const { origin, pathname } = gallery.address;
  await fetch(`${origin}${pathname}run/1`, { redirect: "manual" });
  const place = await waitFor(async () => (await fetch(`${origin}${pathname}wait`, { redirect: "manual" })).headers.get("location"), "run");
  assert.equal((await fetch(`http:${place}`)).status, 200);
  await gallery.stop();
  await assert.rejects(fetch(`http:${place}`));
  await assert.rejects(fetch(origin));
});
