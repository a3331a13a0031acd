// What the page costs in a browser, per frame that it draws: processor time of its own thread, in which scripts run, and of
// the thread and process that do the drawing. Without graphics processor the latter is most, and only the former is what a
// laptop would also have to do. Processor time depends little on what else the machine does.
//
// usage: node bench/page.mjs [LINKS...]    in the project's folder; ZIGGURAT_BIN is the folder of the programs, whose build
//                                           has the page, and the packages of tests/web (target web_tests)
import { pathToFileURL } from "node:url";
import { newPage, openBrowser, playerFile, waitFor } from "../tests/web/browser.mjs";

const seconds = 10;
const counts = process.argv.length > 2 ? process.argv.slice(2).map(Number) : [500, 5000];
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

const browser = await openBrowser();
const processes = await browser.newBrowserCDPSession();

/** Seconds of processor time: scripts, all of the page's thread, the process that draws; and frames that were drawn. */
async function look(page, session) {
  const { metrics } = await session.send("Performance.getMetrics");
  const { processInfo } = await processes.send("SystemInfo.getProcessInfo");
  const metric = (name) => metrics.find((one) => one.name === name).value;
  return { script: metric("ScriptDuration"), thread: metric("TaskDuration"),
           drawing: processInfo.filter(({ type }) => type === "GPU").reduce((sum, { cpuTime }) => sum + cpuTime, 0),
           frames: await page.evaluate(() => window.ziggurat.framesDrawn()) };
}

for (const count of counts) {
  const page = await newPage(browser);
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable", { timeDomain: "threadTicks" });
  await page.goto(`${pathToFileURL(playerFile)}?generated=${count}`);
  await waitFor(() => page.evaluate(() => window.ziggurat?.framesDrawn() > 30), "thirty frames", 120);
  const before = await look(page, session);
  await sleep(1000 * seconds);
  const after = await look(page, session);
  const frames = after.frames - before.frames;
  const each = (name) => (1000 * (after[name] - before[name]) / frames).toFixed(2);
  console.log(`${count} links: ${(frames / seconds).toFixed(1)} frames a second; a frame takes ${each("script")} ms of scripts, `
    + `${each("thread")} ms of the page's thread, ${each("drawing")} ms of the process that draws`);
  await page.context().close();
}
await browser.close();
