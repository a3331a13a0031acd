// SPDX-License-Identifier: MIT
// Cost of the page in a browser, per frame that it draws: processor time of its own thread, in which scripts run, and of
// the thread and process that do the drawing. Without graphics processor the latter is most, and only the former is what a
// laptop would also have to do. Processor time depends little on what else the machine does.
//
// usage: node bench/page.mjs [links] [LINKS...]   bodies without a server
//        node bench/page.mjs robots [ROBOTS...]   foot-bots that drive, and what the page costs the server
//        node bench/page.mjs jumps [TICKS [PAST]] how long jumps on the time line take
//        node bench/page.mjs memory [MINUTES]     memory of the page and of the server
//
// In the project's folder; ZIGGURAT_BIN is the folder of the programs, whose build has the page, and the packages of tests/web
// (target web_tests).
import { pathToFileURL } from "node:url";
import { newPage, openBrowser, playerFile } from "../tests/web/browser.mjs";
import { measureFrames } from "./page/frames.mjs";
import { measureJumps } from "./page/jumps.mjs";
import { measureMemory } from "./page/memory.mjs";
import { driveRobots } from "./page/robots.mjs";

const screen = { width: 1280, height: 720 };
const mode = /^[a-z]/.test(process.argv[2] ?? "") ? process.argv[2] : "links";
const numbers = process.argv.slice(2).filter((word) => /^\d/.test(word)).map(Number);

async function drawLinks(browser, count) {
  const page = await newPage(browser, screen);
  await page.goto(`${pathToFileURL(playerFile)}?generated=${count}`);
  console.log(`${count} links: ${await measureFrames(page)}`);
  await page.context().close();
}

const modes = {
  links: async (browser) => { for (const count of numbers.length > 0 ? numbers : [500, 5000]) await drawLinks(browser, count); },
  robots: async (browser) => { for (const count of numbers.length > 0 ? numbers : [100, 500, 2000]) await driveRobots(browser, screen, count); },
  jumps: (browser) => measureJumps(browser, screen, numbers[0], numbers[1]),
  memory: (browser) => measureMemory(browser, screen, numbers[0]),
};
if (!modes[mode]) throw new Error(`no measurement is called ${mode}; write one of ${Object.keys(modes).join(", ")}`);
const browser = await openBrowser();
await modes[mode](browser);
await browser.close();
