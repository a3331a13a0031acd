// SPDX-License-Identifier: MIT
// Frames of a page: how many are drawn, and what they take of the page's thread and of the process that draws.
import { waitFor } from "../../tests/web/browser.mjs";

export const seconds = 10; // that are measured
export const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Seconds of processor time: scripts, all of the page's thread, the process that draws; and frames that were drawn. */
async function look(page, session) {
  const processes = await page.context().browser().newBrowserCDPSession();
  const { metrics } = await session.send("Performance.getMetrics");
  const { processInfo } = await processes.send("SystemInfo.getProcessInfo");
  const metric = (name) => metrics.find((one) => one.name === name).value;
  await processes.detach();
  return { script: metric("ScriptDuration"), thread: metric("TaskDuration"),
           drawing: processInfo.filter(({ type }) => type === "GPU").reduce((sum, { cpuTime }) => sum + cpuTime, 0),
           frames: await page.evaluate(() => window.ziggurat.framesDrawn()) };
}

/** Cost of drawing for some seconds, as a line. */
export async function measureFrames(page) {
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable", { timeDomain: "threadTicks" });
  await waitFor(() => page.evaluate(() => window.ziggurat?.framesDrawn() > 15), "fifteen frames", 120);
  const before = await look(page, session);
  const begin = performance.now();
  await sleep(1000 * seconds);
  const after = await look(page, session);
  const frames = after.frames - before.frames;
  const each = (name) => (1000 * (after[name] - before[name]) / frames).toFixed(2);
  return `${(1000 * frames / (performance.now() - begin)).toFixed(1)} frames a second; a frame takes ${each("script")} ms of scripts, `
    + `${each("thread")} ms of the page's thread, ${each("drawing")} ms of the process that draws`;
}
