// SPDX-License-Identifier: MIT
// Cost of viewers: CPU time of the run's thread per tick without and with one that subscribes to what
// the page does, and memory of ten that never read. In one run a viewer subscribes and unsubscribes by turns of some
// seconds, so that what else the machine does falls on both kinds, and each turn is compared with its neighbours.
//
// With --instructions instead: what the run's thread executes in TICKS ticks without and with a viewer, counted by valgrind's
// callgrind, which other programs do not change.
//
// usage: node view.mjs ZIGGURAT SCENE [TURNS [SECONDS]]    in a folder with the packages of tests/view (npm ci)
//        node view.mjs --instructions ZIGGURAT SCENE [TICKS]
import foxglove from "@foxglove/ws-protocol";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import WebSocket from "ws";

const counts = process.argv[2] === "--instructions";
const [program, scene, turns = counts ? 400 : 20, seconds = 2] = process.argv.slice(counts ? 3 : 2);
const protocol = foxglove.FoxgloveClient.SUPPORTED_SUBPROTOCOL;
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
/** Topics that the page subscribes at first, in a world with few robots and links. */
const page = /^\/(world|poses|log|barrier|phases|rays|radio|contacts|robots\/[^/]+\/(observation|command))$/;
const all = /./;

function start(...options) { return launch([program], ...options); }
function launch(command, ...options) {
  const [first, ...more] = [...command, "run", scene, "--quiet", "--view=127.0.0.1:0", ...options];
  const child = spawn(first, more);
  return new Promise((resolve) => child.stderr.on("data", (data) => {
    const found = /ws:\/\/\S+/.exec(data);
    if (found) resolve({ child, url: found[0] });
  }));
}
/** CPU time of the main thread [ns], and resident memory of the process [KiB]. */
const cpu = ({ pid }) => Number(readFileSync(`/proc/${pid}/task/${pid}/schedstat`, "utf8").split(" ")[0]);
const memory = ({ pid }) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]);

/** @param topics  an expression of those to subscribe to */
async function connect(url, topics, reads) {
  const ws = new WebSocket(url, [protocol]);
  ws.on("error", () => {});
  const channels = new Map();
  const viewer = { ws, phase: "", heard: () => {} };
  ws.on("message", (data, isBinary) => {
    if (isBinary) return data[0] === 1 ? viewer.heard(data.subarray(13)) : undefined;
    const message = JSON.parse(data);
    if (message.op === "advertise") message.channels.forEach((c) => channels.set(c.topic, c.id));
    for (const { name, value } of message.parameters ?? []) if (name === "phase") viewer.phase = value;
  });
  await new Promise((resolve) => ws.on("open", resolve));
  while (channels.size === 0) await sleep(5);
  const send = viewer.send = (message) => ws.send(JSON.stringify(message));
  const matching = (wanted) => [...channels].filter(([topic]) => wanted.test(topic)).map(([, id]) => ({ id, channelId: id }));
  viewer.subscribe = (wanted) => send({ op: "subscribe", subscriptions: matching(wanted) });
  viewer.unsubscribe = (wanted) => send({ op: "unsubscribe", subscriptionIds: matching(wanted).map(({ id }) => id) });
  if (topics) viewer.subscribe(topics);
  if (!reads) setTimeout(() => ws._socket.pause(), 50);
  return viewer;
}

/** The tick of a Barrier: field 1 of its field 1. */
function tickOf(data) {
  let at = 1;
  while (data[at++] & 128); // length of the status
  if (data[at++] !== 8) return 0;
  let tick = 0;
  for (let shift = 0; ; shift += 7) {
    tick += (data[at] & 127) * 2 ** shift;
    if (!(data[at++] & 128)) return tick;
  }
}

/** Mean and its standard error. */
function estimate(list) {
  const mean = list.reduce((sum, value) => sum + value, 0) / list.length;
  return [mean, Math.sqrt(list.reduce((sum, value) => sum + (value - mean) ** 2, 0) / (list.length - 1) / list.length)];
}

/** Time that a viewer of these topics adds to a tick, at so many times real time. */
async function measure(factor, topics, name) {
  const { child, url } = await start("--duration=0", `--real-time=${factor}`);
  const watcher = await connect(url, /^\/barrier$/, true); // each 250 ms, in both kinds of turns
  const viewer = await connect(url, null, true);
  const moment = () => new Promise((resolve) => {
    watcher.heard = (data) => resolve({ tick: tickOf(data), used: cpu(child) });
  });
  const turn = async () => {
    await sleep(200); // what was begun before is over
    const begin = await moment();
    await sleep(1000 * seconds);
    const end = await moment();
    return (end.used - begin.used) / 1000 / (end.tick - begin.tick);
  };
  await sleep(1000);
  const without = [await turn()], shares = [];
  for (let i = 0; i < turns; ++i) {
    viewer.subscribe(topics);
    const shown = await turn();
    viewer.unsubscribe(topics);
    without.push(await turn());
    shares.push(100 * (2 * shown / (without.at(-1) + without.at(-2)) - 1));
  }
  child.kill("SIGKILL");
  const [share, error] = estimate(shares);
  console.log(`${name}, at ${factor} times real time: a tick takes ${estimate(without)[0].toFixed(0)} us of CPU time without `
    + `viewer, with one ${share.toFixed(1)} % more (standard error ${error.toFixed(1)} %, ${turns} turns)`);
}

/**
 * What callgrind counts on the main thread in a run of TICKS ticks; cycles are its estimate, 10 for each miss of the first cache
 * and 100 for each of the last. The world waits for the subscription.
 */
async function count(topics) {
  const folder = mkdtempSync(`${tmpdir()}/zw`), file = `${folder}/counts`;
  const { child, url } = await launch(["valgrind", "--tool=callgrind", "--separate-threads=yes", "--cache-sim=yes",
    "--collect-systime=yes", `--callgrind-out-file=${file}`, program], `--ticks=${turns}`, "--real-time=1000000");
  const viewer = await connect(url, null, true);
  viewer.send({ op: "subscribeParameterUpdates", parameterNames: ["phase"] });
  viewer.send({ op: "setParameters", parameters: [{ name: "frames_per_second", value: 1000 }] });
  viewer.subscribe(topics);
  while (viewer.phase !== "over") await sleep(100);
  child.kill("SIGINT");
  await once(child, "exit");
  const text = readFileSync(`${file}-01`, "utf8");
  rmSync(folder, { recursive: true });
  const words = (name) => new RegExp(`^${name}: (.*)$`, "m").exec(text)[1].split(" ");
  const totals = words("totals").map(Number);
  const of = Object.fromEntries(words("events").map((name, i) => [name, totals[i]]));
  return { instructions: of.Ir, "system calls": of.sysCount,
           cycles: of.Ir + 10 * (of.I1mr + of.D1mr + of.D1mw) + 100 * (of.ILmr + of.DLmr + of.DLmw) };
}

if (counts) {
  const without = await count(/^\/log$/);
  for (const [name, topics] of [["the page's", page], ["all", all]]) {
    const shown = await count(topics);
    const told = Object.entries(without).map(([what, before]) =>
      `${Math.round(before / turns)} ${what} a tick without viewer, ${(100 * (shown[what] / before - 1)).toFixed(2)} % more with one`);
    console.log(`${name} topics: ${told.join("; ")}`);
  }
  process.exit(0);
}

for (const factor of [10, 1e6]) {
  await measure(factor, page, "the page's topics");
  await measure(factor, all, "all topics");
}

const { child, url } = await start("--duration=0", "--real-time=20");
await connect(url, page, true);
await sleep(2000);
const before = memory(child);
const sleepers = [];
for (let i = 0; i < 10; ++i) sleepers.push(await connect(url.replace(/\?.*/, ""), all, false));
for (let second = 0; second <= 30; second += 10) {
  console.log(`ten viewers that never read, after ${second} s: ${memory(child) - before} KiB more than before`);
  await sleep(10_000);
}
child.kill("SIGKILL");
process.exit(0);
