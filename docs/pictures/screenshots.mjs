// SPDX-License-Identifier: MIT
// Screenshots of the page, in Chromium without a display.
//
// usage: node screenshots.mjs FOLDER          those of the documents
//        node screenshots.mjs FOLDER survey [SCENE...]   six scenes in three sizes, dark and light
//
// ZIGGURAT_BIN is the folder of the programs. Without Chromium it ends with exit code 77.
import { mkdirSync } from "node:fs";
import { openBrowser, openPage, Run, liveTick, shownTick, waitFor } from "../../tests/web/browser.mjs";

const [folder, kind, ...only] = process.argv.slice(2);
if (!folder || (kind && kind !== "survey")) {
  console.error("usage: node screenshots.mjs FOLDER [survey [SCENE...]]");
  process.exit(1);
}
mkdirSync(folder, { recursive: true });

/**
 * Each run ends at `tick`, whose state stays; `speed`: simulated seconds per second until then, 0: as fast as it goes.
 * `hash` is the view, as in the page's address.
 */
const ofDocuments = [
  { name: "page_world", scene: "scenes/construction/staircase.argos", tick: 1875, speed: 20,
    hash: "layers=bodies,shadows,tags,lights,radio,trails,marks&theme=light&tab=log" },
  { name: "page_robot", scene: "scenes/prototype_srocs_system.argos", tick: 60, speed: 1,
    hash: "layers=bodies,shadows,tags,lights,magnets,frusta,rays,marks&selected=robot0&tab=camera&theme=dark" },
].map((shot) => ({ ...shot, sizes: [[1180, 660]], themes: [""] }));

const wheel = (side) => `plot=${encodeURIComponent(`/robots/vehicle/observation:jointReadings.${side}`)}`;
const ofSurvey = [
  { name: "drop", scene: "scenes/drop.argos", tick: 40, hash: "" },
  { name: "vehicle", scene: "scenes/vehicle.argos", tick: 60,
    hash: `selected=vehicle&trail=vehicle&tab=plots&${wheel(0)}&${wheel(1)}&plot=${encodeURIComponent("/poses:positions.12")}` },
  { name: "pyramid", scene: "scenes/construction/pyramid.argos", tick: 700, hash: "tab=log" },
  { name: "foraging", scene: "scenes/experiments/foraging.argos", tick: 300, hash: "selected=forager0&tab=devices" },
  { name: "kilobots", scene: "scenes/kilobots.argos", tick: 100, hash: "tab=controllers" },
  { name: "cameras", scene: "scenes/cameras.argos", tick: 20, hash: "selected=fb&tab=camera&layers=bodies,shadows,tags,lights,frusta,rays,marks" },
].map((shot) => ({ ...shot, speed: 20, sizes: [[1280, 720], [1920, 1080], [390, 844]], themes: ["dark", "light"] }));

const browser = await openBrowser();

async function shoot(page, path) {
  await waitFor(() => page.evaluate(() => window.ziggurat.view.isAtRest), "picture at rest", 120);
  await page.waitForTimeout(1000); // the panels fill
  await page.screenshot({ path, animations: "disabled" });
  if (page.problems.length > 0) throw new Error(`the page had trouble: ${page.problems.join("; ")}`);
  console.log(path);
}

/** A page that has seen the run from its start, at its last tick. */
async function pageAtEnd({ scene, tick, speed, hash }, [width, height], theme) {
  const run = await Run.start(scene, `--ticks=${tick}`, `--real-time=${speed}`);
  try {
    const page = await openPage(browser, run.address, theme ? `${hash}&theme=${theme}` : hash, { width, height });
    await waitFor(async () => (await liveTick(page)) === tick, `tick ${tick}`, 300);
    await waitFor(async () => (await shownTick(page)) === tick, "newest tick");
    return { run, page };
  } catch (error) {
    await run.stop();
    throw error;
  }
}

for (const shot of kind === "survey" ? ofSurvey.filter(({ name }) => only.length === 0 || only.includes(name)) : ofDocuments) {
  for (const size of shot.sizes) {
    const { run, page } = await pageAtEnd(shot, size, shot.themes[0]);
    try {
      for (const theme of shot.themes) {
        const isOther = theme !== "" && (await page.evaluate(() => document.documentElement.dataset.theme)) !== theme;
        if (isOther) await page.keyboard.press("l");
        await shoot(page, `${folder}/${shot.name}${kind ? `_${size[0]}_${theme}` : ""}.png`);
      }
      await page.context().close();
    } finally {
      await run.stop();
    }
  }
}
await browser.close();
