// SPDX-License-Identifier: MIT
// The page in a real browser, with real runs of the program: ctest -R web/page.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { after, before, describe, test } from "node:test";
import { decode, liveTick, newPage, onScreen, openBrowser, openPage, pictureAtRest, pinnedTick, placeOf, root, Run, shownTick, waitFor, ziggurat }
  from "./browser.mjs";

const drop = "scenes/dynamics3d_single_body_test.argos";
const vehicle = "scenes/dynamics3d_multi_body_test.argos";
const tags = `${root}tests/web/tags.argos`;
const robots = `${root}tests/web/robots.argos`;
const fromTop = "eye=0,-0.001,0.9&at=0,0,0&fov=45&theme=light";
const token = "test-token-0123456789";
const limit = { timeout: 180_000 };

let browser;
let folder;
before(async () => {
  browser = await openBrowser();
  folder = mkdtempSync(`${tmpdir()}/zw`);
});
after(async () => {
  await browser?.close();
  if (folder) rmSync(folder, { recursive: true });
});

/** Faults that a page must not have: messages of trouble, and requests to other machines. */
function checkTrouble(page) {
  assert.deepEqual(page.problems, []);
  assert.deepEqual(page.foreign, []);
}

/** Shows what an address says, in a page that is open; its world goes on. */
async function show(page, hash) {
  await page.evaluate((wanted) => new Promise((resolve) => {
    window.addEventListener("hashchange", () => setTimeout(resolve), { once: true });
    history.replaceState(null, "", "#"); // so that it changes
    location.hash = wanted;
  }), hash || "tab=devices");
  if (await page.evaluate(() => window.ziggurat.app.parameters.get("phase") === "paused")) {
    assert.ok(await page.evaluate(() => window.ziggurat.app.call("/resume")));
  }
  await phaseIs(page, "running");
}

/** Tests with one page at one run of a scene, one after the other: a page takes a second or more to open. */
function onePage(scene, { options = [], size }, define) {
  describe(scene.replace(root, ""), () => {
    const at = {};
    after(async () => {
      await at.page?.context().close();
      await at.run?.stop();
    });
    define((name, hash, body) => test(name, limit, async () => {
      at.run ??= await Run.start(scene, ...options);
      at.page ??= await openPage(browser, at.run.address, "", size);
      await show(at.page, hash);
      await body(at.page, at);
      checkTrouble(at.page);
    }));
  });
}

function key(page, name) { return page.locator("#world").focus().then(() => page.keyboard.press(name)); }
function phaseIs(page, phase) {
  return waitFor(() => page.evaluate((wanted) => window.ziggurat.app.parameters.get("phase") === wanted, phase), `phase ${phase}`);
}

function countResets(page) {
  return page.evaluate(() => window.ziggurat.app.timeline.marks.filter(({ kind }) => kind === "reset").length);
}

/** Waits until the world is paused and the page has its last tick, and returns that. */
function standing(page) {
  return waitFor(() => page.evaluate(() => {
    const { barrier, timeline } = window.ziggurat.app;
    const paused = 3;
    return barrier?.status.phase === paused && barrier.status.tick === timeline.newest.tick && { tick: barrier.status.tick };
  }), "a world that stands").then(({ tick }) => tick);
}

/** Lets the world begin again, paused. */
async function beginAgain(page) {
  await waitFor(async () => (await liveTick(page)) > 0, "first tick"); // from which the page sees the world go back
  await page.locator("#play").click();
  await standing(page);
  await page.locator("#reset").click();
  await waitFor(async () => (await shownTick(page)) === 0 && (await standing(page)) === 0, "tick 0");
}

/** Steps a paused world to a tick, and waits until the page shows it. */
async function stepTo(page, tick) {
  while ((await standing(page)) < tick) {
    const before = await liveTick(page);
    await page.locator("#step").click();
    await waitFor(async () => (await liveTick(page)) === before + 1, "next tick");
  }
  await waitFor(async () => (await shownTick(page)) === tick, `tick ${tick} in the picture`);
}

/** Which pixels have a colour, as bodies have, and floor, walls and sky have not. */
function silhouette({ width, height, data }) {
  return Uint8Array.from({ length: width * height }, (_, i) => {
    const rgb = data.subarray(4 * i, 4 * i + 3);
    return Math.max(...rgb) - Math.min(...rgb) > 24 ? 1 : 0;
  });
}

onePage(drop, { options: ["--duration=0"], size: { width: 1100, height: 560 } }, (check) => {
  check("the drop: a hundred bodies move, and the picture is that of `render`",
        "eye=0.3,-0.42,0.34&at=0,-0.04,0.04&fov=45&layers=bodies,tags&theme=light", async (page) => {
    await beginAgain(page); // a slow page comes when they lie already
    const first = await pictureAtRest(page);
    await stepTo(page, 8);
    const png = await pictureAtRest(page);
    assert.ok(!png.equals(first));
    const moved = await page.evaluate(() => {
      const { timeline } = window.ziggurat.app;
      const { newest } = timeline;
      let begin = timeline.last;
      while (begin > timeline.first && timeline.at(begin - 1).world === newest.world) --begin;
      const a = timeline.at(begin).messages.get("/poses").read().positions;
      const b = newest.messages.get("/poses").read().positions;
      let count = 0;
      for (let i = 2; i < a.length; i += 3) if (Math.abs(a[i] - b[i]) > 0.01) ++count;
      return count;
    });
    assert.ok(moved >= 100, `${moved} bodies moved`);
    const tick = await shownTick(page);
    const seen = await decode(page, png);
    const file = `${folder}/drop.png`;
    // The page's field of view is vertical, that of `render` horizontal.
    const opening = 2 * Math.atan(Math.tan(22.5 * Math.PI / 180) * seen.width / seen.height) * 180 / Math.PI;
    execFileSync(ziggurat, ["render", drop, "--at", `${tick / 5}`, "--size", `${seen.width}x${seen.height}`, "--quiet",
      "--eye", "0.3,-0.42,0.34", "--look-at", "0,-0.04,0.04", "--fov", opening.toFixed(6), "--out", file], { cwd: root });
    const [ours, theirs] = [silhouette(seen), silhouette(await decode(page, readFileSync(file)))];
    let both = 0, any = 0;
    ours.forEach((value, i) => {
      both += value & theirs[i];
      any += value | theirs[i];
    });
    assert.ok(any > 3000, `${any} pixels show bodies`);
    console.log(`silhouettes at tick ${tick}: ${any} pixels, ${(100 * both / any).toFixed(1)} % shared`);
    assert.ok(both / any > 0.95, `${both} of ${any} pixels are shared`);
  });

  check("scrubbing back shows old poses while the world runs on", "", async (page) => {
    await beginAgain(page);
    await stepTo(page, 8);
    const id = await page.evaluate(() => window.ziggurat.app.world.entities.find(({ movable }) => movable).id);
    const line = await page.locator("#timeline").boundingBox();
    const start = await page.evaluate(() => { // of the new run, as a part of the line
      const { timeline } = window.ziggurat.app;
      let begin = timeline.last;
      while (begin > timeline.first && timeline.at(begin - 1).world === timeline.newest.world) --begin;
      return (begin - timeline.first) / (timeline.length - 1);
    });
    await page.locator("#speed").selectOption("0.5");
    await page.mouse.click(line.x + start * line.width + 1, line.y + line.height / 2);
    const tick = await pinnedTick(page);
    const old = await placeOf(page, id);
    await page.evaluate(() => window.ziggurat.app.call("/resume")); // the button plays the past
    const live = await liveTick(page);
    assert.ok(tick <= 3, `tick ${tick}`);
    await waitFor(async () => (await liveTick(page)) > live, "new ticks");
    assert.equal(await shownTick(page), tick);
    assert.deepEqual(await placeOf(page, id), old);
    await page.locator("#play").click(); // plays the past
    await waitFor(async () => (await shownTick(page)) >= tick + 2, "the past playing");
    await phaseIs(page, "running");
    await page.locator("#live").click();
    await waitFor(async () => (await shownTick(page)) > tick + 3, "live tick");
    await waitFor(async () => Math.abs((await placeOf(page, id))[2] - old[2]) > 0.01, "the new place");
    await page.evaluate((name) => window.ziggurat.app.toggleTrail(name), id);
    const trail = await waitFor(() => page.evaluate((name) => window.ziggurat.view.trails.get(name), id), "trail");
    assert.ok(trail[0][2] >= old[2], "the trail begins where the page first saw the body");
  });
});

onePage(vehicle, { options: ["--duration=0", "--real-time=4"] }, (check) => {
  check("the vehicle's wheels turn with 1 rad/s, and can be plotted; the world pauses at a log line with a text", "selected=vehicle", async (page) => {
    await waitFor(async () => (await liveTick(page)) >= 10, "tick 10");
    const readings = page.locator('[data-reading^="Senses/Joints/base_wheel"] .value');
    const speeds = () => readings.evaluateAll((all) => all.map((one) => Number(one.dataset.value)));
    const values = await waitFor(async () => {
      const found = await speeds();
      return found.length === 4 && found[0] !== 0 && found;
    }, "readings of four wheels");
    for (const value of values) assert.ok(Math.abs(value - 1) < 0.05, `${value} rad/s`);
    await page.locator('[data-reading^="Senses/Joints/base_wheel_fr"] button.plot').click();
    await page.locator('[data-tab="plots"]').click();
    await page.locator(".plot-box canvas").waitFor();
    await waitFor(() => page.evaluate(() => window.ziggurat.app.series[0]?.values.length > 3), "plotted values");
    await waitFor(() => page.evaluate(() => location.hash.includes("plot=") && location.hash.includes("selected=vehicle")), "address");
    await page.locator('[data-tab="controllers"]').click();
    await page.locator(".sessions td").first().waitFor();
    await page.locator('[data-tab="log"]').click();
    await page.locator(".log .line .text").first().waitFor();
    const text = (await page.locator(".log .line .text").first().textContent()).slice(0, 4);
    await page.locator('[aria-label="Pause when a line contains"]').fill(text);
    await page.keyboard.press("Enter");
    await page.locator(".notice", { hasText: /Paused: vehicle logged/ }).waitFor();
    await standing(page);
  });
});

onePage(robots, {}, (check) => {
  check("foot-bots and e-pucks show their heading and stand on a floor", fromTop, async (page) => {
    await waitFor(async () => (await liveTick(page)) >= 3, "tick 3");
    await key(page, "Space");
    await standing(page);
    const { width, data } = await decode(page, await pictureAtRest(page));
    const box = await page.locator("#world").boundingBox();
    const colorAt = async (point) => {
      const { x, y } = await onScreen(page, point);
      const at = 4 * (Math.round(y - box.y) * width + Math.round(x - box.x));
      return [...data.subarray(at, at + 3)];
    };
    const isWhite = ([red, green, blue]) => Math.min(red, green, blue) > 170 && Math.max(red, green, blue) - Math.min(red, green, blue) < 30;
    const isBlue = ([red, , blue]) => blue > red + 40;
    assert.ok(isWhite(await colorAt([-0.14, 0, 0.149])), "the foot-bot's arrow");
    assert.ok(isBlue(await colorAt([-0.26, 0, 0.147])), "the foot-bot's back");
    assert.ok(isWhite(await colorAt([0.2, 0.0255, 0.046])), "the e-puck's arrow");
    assert.ok(isBlue(await colorAt([0.2, -0.025, 0.045])), "the e-puck's back");
    const floors = [await colorAt([0.05, 0.05, 0]), await colorAt([0.15, 0.05, 0])];
    assert.notDeepEqual(floors[0], floors[1]); // squares
  });

  check("models of the scene are spawned, and robots with its controllers", "", async (page) => {
    await page.locator(".change summary").click();
    const spawn = async (what, id, place) => {
      await page.locator("#spawn-what").selectOption({ label: what });
      await page.locator("#spawn-id").fill(id);
      await page.locator("#spawn-place").fill(place);
      await page.locator("#spawn").click();
      await waitFor(() => placeOf(page, id), id);
      await page.locator(`[data-entity="${id}"].selected`).waitFor();
    };
    await spawn("crate (prototype)", "crate_1", "0, 0.3, 0");
    for (const [what, id, place] of [["puck (e-puck)", "puck_1", "0.2, -0.3, 0"],
                                     ["foot-bot with turning", "walker", "-0.2, -0.3, 0"]]) {
      await spawn(what, id, place);
      const left = page.locator('[data-reading="Commands/Wheels/left"] .value');
      await waitFor(async () => Math.abs(Number(await left.getAttribute("data-value")) + 0.01) < 1e-6, `commands of ${id}`);
    }
  });
});

onePage(tags, { options: ["--view=127.0.0.1:0", "--view-token", token] }, (check) => {
  check("keys and fingers turn and zoom the picture", fromTop, async (page) => {
    const look = () => page.evaluate(() => window.ziggurat.view.stage.look);
    const distance = ({ eye, at }) => Math.hypot(...eye.map((value, i) => value - at[i]));
    const first = await look();
    await key(page, "ArrowDown");
    await key(page, "ArrowLeft");
    const turned = await look();
    assert.notDeepEqual(turned.eye, first.eye);
    assert.deepEqual(turned.at, first.at);
    assert.ok(Math.abs(distance(turned) - distance(first)) < 1e-3);
    await key(page, "+");
    assert.ok(distance(await look()) < 0.9 * distance(turned));
    const { eye } = await look();
    await waitFor(async () => {
      const told = new URLSearchParams(new URL(page.url()).hash.slice(1)).get("eye").split(",");
      return told.every((value, i) => Math.abs(Number(value) - eye[i]) < 1e-3);
    }, "this view in the address");
    await key(page, "?");
    await waitFor(() => page.locator("#help h2").first().isVisible(), "help");
    await page.keyboard.press("Escape");
    await waitFor(() => page.locator("#help").isHidden(), "end of help");

    const touch = await page.context().newCDPSession(page);
    const box = await page.locator("#world").boundingBox();
    const fingers = (type, ...places) => touch.send("Input.dispatchTouchEvent", { type,
      touchPoints: places.map(([x, y], id) => ({ id, x: box.x + x * box.width, y: box.y + y * box.height })) });
    const before = await look();
    await fingers("touchStart", [0.5, 0.5]);
    for (const x of [0.52, 0.6, 0.7]) await fingers("touchMove", [x, 0.5]);
    await fingers("touchEnd");
    await waitFor(async () => Math.abs((await look()).eye[0] - before.eye[0]) > 0.01, "picture that is turned");
    const near = distance(await look());
    await fingers("touchStart", [0.45, 0.5], [0.55, 0.5]);
    for (const part of [0.07, 0.12, 0.2]) await fingers("touchMove", [0.5 - part, 0.5], [0.5 + part, 0.5]);
    await fingers("touchEnd");
    await waitFor(async () => distance(await look()) < 0.8 * near, "picture that is nearer");
  });

  check("pause stops the server, a step is one tick, resume goes on; a paused world that begins again stays paused", "", async (page) => {
    await waitFor(async () => (await liveTick(page)) >= 3, "tick 3");
    await key(page, "Space");
    const tick = await standing(page);
    await page.waitForTimeout(400); // four ticks: elapsed time is the subject
    assert.equal(await liveTick(page), tick);
    await page.locator("#step").click();
    await waitFor(async () => (await liveTick(page)) === tick + 1, "next tick");
    assert.equal(await standing(page), tick + 1);
    await page.locator("#play").click();
    await waitFor(async () => (await liveTick(page)) > tick + 3, "further ticks");
    await key(page, "Space");
    await phaseIs(page, "paused");
    for (let i = 0; i < 2; ++i) {
      const resets = await countResets(page);
      await page.locator("#reset").click();
      await waitFor(async () => (await countResets(page)) > resets, "reset");
      await waitFor(async () => (await liveTick(page)) === 0, "tick 0");
      await phaseIs(page, "paused");
      await page.waitForTimeout(300); // elapsed time is the subject
      assert.equal(await liveTick(page), 0);
      assert.equal(await page.evaluate(() => window.ziggurat.app.parameters.get("phase")), "paused");
      await page.locator("#step").click(); // the page sees a world go back only from a later tick
      await waitFor(async () => (await liveTick(page)) === 1, "tick 1");
    }
  });

  check("a tag's pattern is found by libapriltag", "eye=0,-0.001,0.4&at=0,0,0.05&fov=45&layers=bodies,tags&theme=light",
        async (page) => {
    const file = `${folder}/tag.pgm`;
    await waitFor(async () => (await liveTick(page)) >= 3, "tick 3");
    await key(page, "Space");
    await standing(page);
    const found = async () => {
      const { width, height, data } = await decode(page, await pictureAtRest(page));
      const grey = Buffer.from(Uint8Array.from({ length: width * height }, (_, i) => data[4 * i + 1]));
      writeFileSync(file, Buffer.concat([Buffer.from(`P5\n${width} ${height}\n255\n`), grey]));
      return execFileSync(process.env.FIND_TAGS, [file]).toString();
    };
    assert.equal(await waitFor(found, "tag"), "42\n"); // the first pictures of a busy machine may be empty
  });

  check("a block is dragged in the server, what is spawned comes, what is removed goes", fromTop, async (page) => {
    const start = await placeOf(page, "near");
    await page.locator("#tool-move").waitFor(); // it comes with the right to control
    await key(page, "m");
    const from = await onScreen(page, [start[0], start[1], start[2] + 0.1]);
    const to = await onScreen(page, [start[0], start[1] - 0.2, start[2] + 0.1]);
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move((from.x + to.x) / 2, (from.y + to.y) / 2, { steps: 4 });
    await page.mouse.move(to.x, to.y, { steps: 4 });
    await page.mouse.up();
    await waitFor(async () => Math.abs((await placeOf(page, "near"))[1] - (start[1] - 0.2)) < 0.01, "the new place");
    assert.ok(Math.abs((await placeOf(page, "near"))[0] - start[0]) < 0.01);
    const far = await placeOf(page, "far");
    [0.25, 0.2, 0].forEach((value, i) => assert.ok(Math.abs(far[i] - value) < 0.005, String(far)));

    await page.locator(".change summary").click();
    await page.locator("#spawn-id").fill("guest");
    await page.locator("#spawn-place").fill("0.1, -0.3, 0.05");
    await page.locator("#spawn").click();
    await waitFor(() => placeOf(page, "guest"), "guest");
    await waitFor(async () => Math.abs((await placeOf(page, "guest"))[2]) < 0.003, "guest on the floor");
    await page.locator('[data-entity="guest"]').waitFor();
    await page.locator("#remove").click();
    await waitFor(async () => (await placeOf(page, "guest")) === null, "end of guest");
    await page.locator("#spawn-id").fill("near");
    await page.locator("#spawn").click(); // the name is taken
    await page.locator(".notice.error").waitFor();
  });

  check("a page with a wrong token says so; without token it looks and changes nothing", "", async (_, { run }) => {
    const wrong = await newPage(browser);
    await wrong.goto(`${run.address.origin}/?token=not-the-one-that-was-printed`);
    await waitFor(async () => /wrong token/.test(await wrong.locator("#overlay").textContent()), "sentence");
    await wrong.context().close();
    const address = new URL(run.address);
    address.search = "";
    const page = await openPage(browser, address, "selected=near");
    await waitFor(() => page.evaluate(() => document.querySelector("#play").disabled), "play that is disabled");
    for (const control of ["#remove", "#tool-move", ".change"]) assert.ok(await page.locator(control).isHidden(), control);
    await key(page, "Space");
    await page.locator(".notice.error").waitFor();
    await waitFor(async () => (await liveTick(page)) > 3, "ticks");
    await page.context().close();
  });

  check("a server that was killed and started again is found within seconds", "", async (page, at) => {
    const { port } = at.run.address;
    const session = await page.evaluate(() => window.ziggurat.app.connection.session);
    await at.run.stop("SIGKILL");
    await page.locator("#overlay.banner").waitFor();
    assert.match(await page.locator("#overlay").textContent(), /closed the connection|No connection/);
    at.run = await Run.start(tags, `--view=127.0.0.1:${port}`, "--view-token", token);
    const begin = Date.now();
    await waitFor(() => page.evaluate((old) => {
      const { connection, timeline } = window.ziggurat.app;
      return connection.phase === "open" && connection.session !== old && timeline.length > 1;
    }, session), "new session");
    console.log(`back after ${((Date.now() - begin) / 1000).toFixed(1)} s`);
    page.problems = []; // the browser's words on connections that were refused
  });
});

test("a replay is watched as a run, and can't be changed", limit, async () => {
  const file = `${folder}/replayed.mcap`;
  execFileSync(ziggurat, ["run", tags, "--ticks=400", "--quiet", "--record", file], { cwd: root, stdio: "ignore" });
  const run = await Run.replay(file); // 40 s: slow pages pause it before its end
  try {
    const page = await openPage(browser, run.address);
    await waitFor(async () => (await liveTick(page)) >= 3, "tick 3");
    await key(page, "Space");
    const tick = await standing(page);
    await page.locator("#step").click();
    await waitFor(async () => (await liveTick(page)) === tick + 1, "next tick");
    for (const control of ["#tool-move", ".change"]) await page.locator(control).waitFor({ state: "hidden" });
    await waitFor(() => page.locator("#reset").isDisabled(), "reset that is disabled");
    await key(page, "r"); // refused
    await waitFor(() => page.locator("#notices").innerText().then((text) => text.length > 0), "notice");
    assert.equal(await liveTick(page), tick + 1);
    await page.locator("#speed").selectOption("0");
    await page.locator("#play").click();
    await waitFor(async () => (await liveTick(page)) === 400, "last tick");
    await phaseIs(page, "over");
    checkTrouble(page);
    await page.context().close();
  } finally {
    await run.stop();
  }
});
