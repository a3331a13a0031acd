// What viewers cost: CPU time of the run's thread per tick without and with one that subscribes to what
// the page does, and memory of ten that never read. The kinds of runs are done by turns, so that what else the
// machine does falls on all of them.
//
// usage: node view.mjs ZIGGURAT SCENE TICKS [TURNS]    in a folder with the packages of tests/view (npm ci)
import foxglove from "@foxglove/ws-protocol";
import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";
import WebSocket from "ws";

const [program, scene, ticks, turns = 5] = process.argv.slice(2);
const protocol = foxglove.FoxgloveClient.SUPPORTED_SUBPROTOCOL;
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const page = ["/world", "/poses", "/detections", "/radio", "/contacts", "/barrier", "/phases", "/log"];

function start(...options) {
  const child = spawn(program, ["run", scene, "--quiet", "--view=127.0.0.1:0", ...options]);
  return new Promise((resolve) => child.stderr.on("data", (data) => {
    const found = /ws:\/\/\S+/.exec(data);
    if (found) resolve({ child, url: found[0] });
  }));
}
/** CPU time of the main thread [ns], and resident memory of the process [KiB]. */
const cpu = ({ pid }) => Number(readFileSync(`/proc/${pid}/task/${pid}/schedstat`, "utf8").split(" ")[0]);
const memory = ({ pid }) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]);

async function connect(url, topics, reads) {
  const ws = new WebSocket(url, [protocol]);
  ws.on("error", () => {});
  const channels = new Map();
  let phase = "", tick = -1;
  ws.on("message", (data, isBinary) => {
    if (isBinary) return;
    const message = JSON.parse(data);
    if (message.op === "advertise") message.channels.forEach((c) => channels.set(c.topic, c.id));
    if (message.op === "parameterValues") for (const p of message.parameters) if (p.name === "phase") phase = p.value;
  });
  await new Promise((resolve) => ws.on("open", resolve));
  while (channels.size === 0) await sleep(5);
  const send = (message) => ws.send(JSON.stringify(message));
  send({ op: "subscribeParameterUpdates", parameterNames: ["phase"] });
  send({ op: "getParameters", parameterNames: ["phase"] });
  const all = topics ?? [...channels.keys()];
  send({ op: "subscribe", subscriptions: all.map((topic, id) => ({ id, channelId: channels.get(topic) })) });
  if (!reads) setTimeout(() => ws._socket.pause(), 50);
  return { ws, over: () => phase === "over" };
}

/** CPU time per tick of a whole run [us]. The watcher of its end subscribes to /log only. */
async function measure(factor, topics) {
  const { child, url } = await start(`--ticks=${ticks}`, `--real-time=${factor}`);
  const viewer = await connect(url, topics, true);
  const before = cpu(child);
  while (!viewer.over()) await sleep(20);
  const used = (cpu(child) - before) / 1000 / Number(ticks);
  child.kill("SIGKILL");
  return used;
}

const median = (list) => list.toSorted((a, b) => a - b)[Math.floor(list.length / 2)];
for (const factor of [10, 1e6]) {
  const without = [], page_ = [], each = [];
  for (let i = 0; i < turns; ++i) {
    without.push(await measure(factor, ["/log"]));
    page_.push(await measure(factor, page));
    each.push(await measure(factor, null));
  }
  const share = (list) => `${median(list).toFixed(0)} us (` +
    `${((median(list.map((used, i) => used / without[i])) - 1) * 100).toFixed(1)} % in the median of the turns)`;
  console.log(`factor ${factor}: a tick takes ${median(without).toFixed(0)} us of CPU time without pictures of it, ` +
              `${share(page_)} with the page's topics, ${share(each)} with all topics`);
}

const { child, url } = await start("--duration=0", "--real-time=20");
const first = await connect(url, page, true);
await sleep(2000);
const before = memory(child);
const sleepers = [];
for (let i = 0; i < 10; ++i) sleepers.push(await connect(url.replace(/\?.*/, ""), null, false));
for (let second = 0; second <= 30; second += 10) {
  console.log(`ten viewers that never read, after ${second} s: ${memory(child) - before} KiB more than before`);
  await sleep(10_000);
}
child.kill("SIGKILL");
process.exit(0);
