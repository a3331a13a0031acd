// SPDX-License-Identifier: MIT
// Jumps on the time line: from the call to the picture, of a page with a recording inside and of a running world's past. A
// picture is there when the graphics processor, or what stands for it, has finished it. The moments between jumps differ, so
// that some come while the picture that stays is still drawn.
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { isShown, openFile, openPage, root, Run, waitFor, ziggurat } from "../../tests/web/browser.mjs";

const vehicle = "scenes/dynamics3d_multi_body_test.argos";
const jumps = 40;
const longestWait = 900; // [s], for the ticks of a running world

/** Milliseconds of each jump: until the page has the frame, until its drawing has begun, until it is drawn. Runs in the page. */
async function jumpAbout(count) {
  const { app, view } = window.ziggurat;
  const gl = view.stage.renderer.getContext();
  const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
  let state = 12345;
  const random = () => (state = (state * 1103515245 + 12345) % 2147483648) / 2147483648;
  const times = [];
  while (times.length < count) {
    await sleep(200 + 1200 * random());
    const { first, length } = app.timeline;
    const wanted = first + Math.floor(random() * (length - 1));
    if (app.timeline.at(wanted)?.messages.has("/poses") === false) continue; // it came in part: its picture is that of before
    const begin = performance.now();
    const passed = () => performance.now() - begin;
    let known = 0;
    app.pin(wanted);
    do {
      await new Promise((resolve) => requestAnimationFrame(resolve));
      if (known === 0 && app.frame?.sequence === wanted) known = passed();
    } while (view.drawn?.sequence !== wanted);
    const drawn = passed();
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    while (gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED) await sleep(2);
    gl.deleteSync(fence);
    times.push({ known, drawn, done: passed() });
  }
  return times;
}

async function tell(what, page) {
  const times = await page.evaluate(jumpAbout, jumps);
  const of = (name) => {
    const sorted = times.map((time) => time[name]).sort((a, b) => a - b);
    return `${sorted[sorted.length >> 1].toFixed(0)} ms (at most ${sorted.at(-1).toFixed(0)} ms)`;
  };
  console.log(`${what}: ${jumps} jumps; frame known after ${of("known")}, drawing begun after ${of("drawn")}, drawn after ${of("done")}`);
}

/** @param count  ticks of the recording, @param past  of the running world, of which the page is sent as many as it draws */
export async function measureJumps(browser, screen, count = 10_001, past = count - 1) {
  const folder = mkdtempSync(`${tmpdir()}/zj`);
  const [recording, exported] = [`${folder}/run.mcap`, `${folder}/run.html`];
  execFileSync(ziggurat, ["run", vehicle, "--ticks", String(count), "--record", recording, "--quiet"], { cwd: root, stdio: "ignore" });
  execFileSync(ziggurat, ["export", recording, "--html", exported, "--quiet"]);
  const still = await openFile(browser, exported, "", screen);
  await waitFor(() => isShown(still), "first frame");
  await still.waitForTimeout(3000); // it plays
  await still.evaluate(() => { window.ziggurat.app.playback.isPlaying = false; });
  await tell(`recording of ${count} ticks`, still);
  await still.context().close();

  const run = await Run.start(vehicle, "--duration=0", "--real-time=20", "--view=127.0.0.1:0");
  const live = await openPage(browser, run.address, "", screen);
  const length = () => live.evaluate(() => window.ziggurat.app.timeline.length);
  await waitFor(async () => (await length()) >= past, `${past} ticks in the page`, longestWait);
  await tell(`running world, ${await length()} ticks of the past`, live);
  await live.context().close();
  await run.stop();
  rmSync(folder, { recursive: true });
}
