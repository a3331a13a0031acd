// SPDX-License-Identifier: MIT
// Memory of the page and of the server over minutes of a running world at twenty times real time. Of the page: what scripts hold
// after a collection, elements of the document, messages of the past, and resident memory of the browser's processes.
import { readFileSync } from "node:fs";
import { openPage, Run } from "../../tests/web/browser.mjs";
import { sleep } from "./frames.mjs";

const scene = "scenes/dynamics3d_multi_body_test.argos"; // each tick logs a line
const interval = 30; // [s]
const mebi = 1024 * 1024;

/** Resident memory of a process [MiB]. */
function residentOf(pid) { return Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]) / 1024; }

export async function measureMemory(browser, screen, minutes = 5) {
  const run = await Run.start(scene, "--duration=0", "--real-time=20", "--view=127.0.0.1:0");
  const page = await openPage(browser, run.address, "", screen);
  const session = await page.context().newCDPSession(page);
  const processes = await browser.newBrowserCDPSession();
  await session.send("Performance.enable");
  console.log("seconds, tick, frames held, their messages [MiB], scripts [MiB], elements, page's process [MiB], drawing [MiB], server [MiB]");
  const begin = performance.now();
  for (let reading = 0; reading <= 60 * minutes / interval; ++reading) {
    await sleep(begin + 1000 * interval * reading - performance.now());
    await session.send("HeapProfiler.collectGarbage");
    const { metrics } = await session.send("Performance.getMetrics");
    const metric = (name) => metrics.find((one) => one.name === name).value;
    const { processInfo } = await processes.send("SystemInfo.getProcessInfo");
    const resident = (type) => processInfo.filter((one) => one.type === type).reduce((sum, { id }) => sum + residentOf(id), 0);
    const [tick, frames, bytes] = await page.evaluate(() => {
      const { timeline } = window.ziggurat.app;
      return [timeline.newest.tick, timeline.length, timeline.heldBytes];
    });
    console.log([((performance.now() - begin) / 1000).toFixed(0), tick, frames, (bytes / mebi).toFixed(1),
                 (metric("JSHeapUsedSize") / mebi).toFixed(1), metric("Nodes"), resident("renderer").toFixed(0),
                 resident("GPU").toFixed(0), residentOf(run.process.pid).toFixed(0)].join(", "));
  }
  await page.context().close();
  await run.stop();
}
