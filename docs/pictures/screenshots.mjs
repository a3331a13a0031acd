// Screenshots of the page, in Chromium without a display. usage: node screenshots.mjs FOLDER
//
// ZIGGURAT_BIN is the folder of the programs. Without Chromium it ends with exit code 77.
import { openBrowser, openPage, Run, liveTick, shownTick, waitFor } from "../../tests/web/browser.mjs";

const folder = process.argv[2];
if (!folder) {
  console.error("usage: node screenshots.mjs FOLDER");
  process.exit(1);
}
const size = { width: 1180, height: 660 };

/** Each run ends at `tick`, whose state stays; `speed`: simulated seconds per second until then. */
const shots = [
  { name: "page_world", scene: "scenes/construction/staircase.argos", tick: 1875, speed: 20,
    hash: "layers=bodies,shadows,tags,lights,radio,trails&theme=light&tab=log" },
  { name: "page_robot", scene: "scenes/prototype_srocs_system.argos", tick: 60, speed: 1,
    hash: "layers=bodies,shadows,tags,lights,magnets,frusta,rays&selected=robot0&tab=camera&theme=dark" },
];

const browser = await openBrowser();
for (const { name, scene, tick, speed, hash } of shots) {
  const run = await Run.start(scene, `--ticks=${tick}`, `--real-time=${speed}`);
  try {
    const page = await openPage(browser, run.address, hash, size);
    await waitFor(async () => (await liveTick(page)) === tick, `tick ${tick}`, 300);
    await waitFor(async () => (await shownTick(page)) === tick, "newest tick");
    await waitFor(() => page.evaluate(() => window.ziggurat.view.isAtRest), "picture at rest", 120);
    await page.waitForTimeout(1000); // the panels fill
    await page.screenshot({ path: `${folder}/${name}.png`, animations: "disabled" });
    if (page.problems.length > 0) throw new Error(`the page had trouble: ${page.problems.join("; ")}`);
    console.log(`${folder}/${name}.png`);
  } finally {
    await run.stop();
  }
}
await browser.close();
