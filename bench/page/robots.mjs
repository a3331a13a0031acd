// SPDX-License-Identifier: MIT
// Foot-bots that drive in a run of the real program at real time: frames of the page, and what the page costs the server. The
// page is opened and closed by turns in one run, so that what else the machine does falls on both. Without graphics processor
// drawing takes the processors, too, so that the wall time of a tick says more about it than about the server; the server's own
// part is its processor time.
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { openPage, Run, waitFor } from "../../tests/web/browser.mjs";
import { measureFrames, seconds, sleep } from "./frames.mjs";

const turns = 3;

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

/** A scene of so many foot-bots in a walled square, six of them on each square metre. */
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

/** A port that is free now. */
async function freePort() {
  const server = createServer().listen(0, "127.0.0.1");
  await new Promise((resolve) => server.once("listening", resolve));
  const { port } = server.address();
  await new Promise((resolve) => server.close(resolve));
  return port;
}

/** Processor time of a process so far [ms]: of the run's thread, and of all its threads. */
function cpuOf(pid) {
  const of = (thread) => Number(readFileSync(`/proc/${pid}/task/${thread}/schedstat`, "utf8").split(" ")[0]) * 1e-6;
  return { run: of(pid), all: readdirSync(`/proc/${pid}/task`).reduce((sum, thread) => sum + of(thread), 0) };
}

/** Times of ticks for some seconds, each [ms]. */
async function measureTicks(pid, status) {
  const tick = async () => Number((await (await fetch(status)).json()).tick);
  const [first, before, begin] = [await tick(), cpuOf(pid), performance.now()];
  await sleep(1000 * seconds);
  const [last, after] = [await tick(), cpuOf(pid)];
  const ticks = last - first;
  return { ticks, run: (after.run - before.run) / ticks, all: (after.all - before.all) / ticks, pace: (performance.now() - begin) / ticks };
}

export async function driveRobots(browser, screen, count) {
  const folder = mkdtempSync(`${tmpdir()}/zb`);
  const scene = `${folder}/robots.argos`;
  writeFileSync(`${folder}/robots.lua`, script);
  writeFileSync(scene, sceneOf(count));
  const port = await freePort();
  const run = await Run.start(scene, "--real-time", "1", "--metrics", `127.0.0.1:${port}`, "--view=127.0.0.1:0");
  const status = `http://127.0.0.1:${port}/status`;
  // The run waits for a viewer at first, and has no status before its first tick.
  await waitFor(async () => Number((await (await fetch(status)).json().catch(() => ({}))).tick) > 10, "ticks");
  const found = { alone: [], seen: [] };
  for (let turn = 0; turn < turns; ++turn) {
    await sleep(2000);
    found.alone.push(await measureTicks(run.process.pid, status));
    const page = await openPage(browser, run.address, "", screen);
    if (turn === 0) console.log(`${count} foot-bots: ${await measureFrames(page)}`);
    await sleep(2000);
    found.seen.push(await measureTicks(run.process.pid, status));
    await page.context().close();
  }
  await run.stop();
  rmSync(folder, { recursive: true });
  const mean = (list, name) => list.reduce((sum, one) => sum + one[name] * one.ticks, 0) / list.reduce((sum, one) => sum + one.ticks, 0);
  for (const [name, what] of [["run", "processor time of the run's thread"], ["all", "processor time of the server"], ["pace", "time until the next"]]) {
    const [alone, seen] = [mean(found.alone, name), mean(found.seen, name)];
    console.log(`  a tick without page and with it, ${what}: ${alone.toFixed(2)} ms, ${seen.toFixed(2)} ms (${(100 * (seen / alone - 1)).toFixed(1)} % more)`);
  }
}
