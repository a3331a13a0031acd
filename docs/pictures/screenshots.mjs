// Screenshots of the page, in Chromium without a display. usage: node screenshots.mjs FOLDER
import { openBrowser, openPage, Run, liveTick, waitFor } from "../../tests/web/browser.mjs";

const folder = process.argv[2];
const size = { width: 1100, height: 620 };

const shots = [
  { name: "page_world", scene: "scenes/dynamics3d_single_body_test.argos", tick: 4,
    hash: "eye=0.52,-0.69,0.56&at=0,-0.04,0.04&fov=45&theme=light" },
  { name: "page_robot", scene: "scenes/prototype_srocs_system.argos", tick: 40,
    hash: "layers=bodies,tags,lights,magnets,frusta,rays&selected=ROBOT&theme=dark" },
];

const browser = await openBrowser();
for (const { name, scene, tick, hash } of shots) {
  const run = await Run.start(scene);
  const page = await openPage(browser, run.address, hash, size);
  await waitFor(async () => (await liveTick(page)) >= tick, `tick ${tick}`, 120);
  await page.waitForTimeout(2000); // the panels fill
  await page.screenshot({ path: `${folder}/${name}.jpg`, type: "jpeg", quality: 80 });
  console.log(`${folder}/${name}.jpg`);
  await run.stop();
}
await browser.close();
