// SPDX-License-Identifier: MIT
// What the page costs in a browser, per frame that it draws: processor time of its own thread, in which scripts run, and of
// the thread and process that do the drawing. Without graphics processor the latter is most, and only the former is what a
// laptop would also have to do. Processor time depends little on what else the machine does. With `robots`, foot-bots drive
// in a run of the real program at real time, and its ticks are measured with the page and without, in turn. With `jumps`, how
// long jumps on the time line take.
//
// usage: node bench/page.mjs [LINKS...]           in the project's folder; ZIGGURAT_BIN is the folder of the programs, whose
//        node bench/page.mjs robots [ROBOTS...]   build has the page, and the packages of tests/web (target web_tests)
//        node bench/page.mjs jumps [TICKS]
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { pathToFileURL } from "node:url";
import { measureJumps } from "./page/jumps.mjs";
import { newPage, openBrowser, openPage, playerFile, Run, waitFor, ziggurat } from "../tests/web/browser.mjs";

const seconds = 10;
const screen = { width: 1280, height: 720 };
const mode = /^[a-z]/.test(process.argv[2] ?? "") ? process.argv[2] : "links";
const numbers = process.argv.slice(2).filter((word) => /^\d/.test(word)).map(Number);
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

/** What drawing costs for some seconds, as a line. */
async function measure(page, session) {
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

async function sessionOf(page) {
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable", { timeDomain: "threadTicks" });
  return session;
}

async function drawLinks(count) {
  const page = await newPage(browser, screen);
  const session = await sessionOf(page);
  await page.goto(`${pathToFileURL(playerFile)}?generated=${count}`);
  console.log(`${count} links: ${await measure(page, session)}`);
  await page.context().close();
}

// --- foot-bots that drive -----------------------------------------------------------------------------

const script = `-- Drives straight, turns away from what is near, and shows with its LEDs which of these it does.
function init() end
function reset() end
function destroy() end
function step()
  local x, y = 0, 0
  for _, ray in ipairs(robot.proximity) do
    x = x + ray.value * math.cos(ray.angle)
    y = y + ray.value * math.sin(ray.angle)
  end
  if x > 0.02 or math.abs(y) > 0.1 then
    local turn = y > 0 and 8 or -8
    robot.wheels.set_velocity(turn, -turn)
    robot.leds.set_all_colors(230, 159, 0)
  else
    robot.wheels.set_velocity(10, 10)
    robot.leds.set_all_colors(0, 158, 115)
  end
end
`;

/** So many foot-bots in a walled square, six of them on each square metre. */
function sceneOf(count) {
  const side = Math.sqrt(0.16 * count), inside = side / 2 - 0.15;
  const wall = (id, size, x, y) => `<box id="${id}" size="${size},0.2" movable="false"><body position="${x},${y},0"/></box>`;
  return `<argos-configuration>
  <framework><experiment length="0" ticks_per_second="10" random_seed="1"/></framework>
  <controllers><lua_controller id="wander">
    <actuators><differential_steering implementation="default"/><leds implementation="default" medium="leds"/></actuators>
    <sensors><footbot_proximity implementation="default"/></sensors>
    <params script="robots.lua"/>
  </lua_controller></controllers>
  <arena size="${side},${side},1" center="0,0,0.5">
    ${wall("north", `${side},0.1`, 0, side / 2)} ${wall("south", `${side},0.1`, 0, -side / 2)}
    ${wall("east", `0.1,${side}`, side / 2, 0)} ${wall("west", `0.1,${side}`, -side / 2, 0)}
    <distribute>
      <position method="uniform" min="${-inside},${-inside},0" max="${inside},${inside},0"/>
      <orientation method="uniform" min="0,0,0" max="360,0,0"/>
      <entity quantity="${count}" max_trials="1000"><foot-bot id="robot"><controller config="wander"/></foot-bot></entity>
    </distribute>
  </arena>
  <physics_engines><dynamics2d id="plane" iterations="4"/></physics_engines>
  <media><led id="leds"/></media>
</argos-configuration>
`;
}

/** Wall time of a tick: physics and the exchange with controllers [ms]. */
function tickOf(summary) {
  const { ticks, wall_time_s: { physics, exchange } } = JSON.parse(readFileSync(summary, "utf8"));
  return 1000 * (physics + exchange) / ticks;
}

async function driveRobots(count) {
  const folder = mkdtempSync(`${tmpdir()}/zb`);
  const scene = `${folder}/robots.argos`, summary = `${folder}/summary.json`;
  writeFileSync(`${folder}/robots.lua`, script);
  writeFileSync(scene, sceneOf(count));
  const options = ["--real-time", "1", "--summary", summary];
  const alone = spawn(ziggurat, ["run", scene, "--quiet", "--duration", String(2 * seconds), ...options], { stdio: "ignore" });
  await once(alone, "exit");
  const without = tickOf(summary);
  const run = await Run.start(scene, ...options, "--view=127.0.0.1:0");
  const page = await openPage(browser, run.address, "", screen);
  const line = await measure(page, await sessionOf(page));
  await page.context().close();
  await run.stop();
  const seen = tickOf(summary);
  console.log(`${count} foot-bots: ${line}\n  a tick takes ${without.toFixed(2)} ms without page, ${seen.toFixed(2)} ms with it, `
    + `${(100 * (seen / without - 1)).toFixed(1)} % more`);
  rmSync(folder, { recursive: true });
}

const modes = {
  links: async (counts) => { for (const count of counts.length > 0 ? counts : [500, 5000]) await drawLinks(count); },
  robots: async (counts) => { for (const count of counts.length > 0 ? counts : [100, 500, 2000]) await driveRobots(count); },
  jumps: ([ticks]) => measureJumps(browser, screen, ticks),
};
if (!modes[mode]) throw new Error(`no measurement is called ${mode}; write one of ${Object.keys(modes).join(", ")}`);
await modes[mode](numbers);
await browser.close();
