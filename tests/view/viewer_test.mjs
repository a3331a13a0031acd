// SPDX-License-Identifier: MIT
// The live server, seen by an independent client of the Foxglove WebSocket protocol.
//
// usage: node viewer_test.mjs ZIGGURAT
import foxglove from "@foxglove/ws-protocol";
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, writeFileSync } from "node:fs";
import http from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import WebSocket from "ws";

const { FoxgloveClient } = foxglove;
const program = process.argv[2];
const protocol = FoxgloveClient.SUPPORTED_SUBPROTOCOL;
const hang = 60_000; // [ms]: more than any event takes, on a busy machine too
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

const scene = join(mkdtempSync(join(tmpdir(), "view-")), "blocks.argos");
writeFileSync(scene, `<argos><framework><experiment ticks_per_second="10" random_seed="1"/></framework>
<controllers/><arena size="9,9,9"><box id="crate" size="0.2,0.2,0.2" movable="true" mass="1">
<body position="0,0,1"/></box></arena><physics_engines><dynamics3d id="d" iterations="4"><floor/>
<gravity g="9.8"/></dynamics3d></physics_engines><media/></argos>`);

/** Starts the program and waits for its address. */
async function start(...options) {
  return startCommand("run", "--duration=0", ...options);
}
async function startCommand(command, ...options) {
  const child = spawn(program, [command, scene, "--quiet", ...options]);
  let text = "";
  const address = await new Promise((resolve, reject) => {
    child.on("exit", (code) => reject(new Error(`it ended with ${code}: ${text}`)));
    child.stderr.on("data", (data) => {
      text += data;
      const found = /ws:\/\/(\S+)\/\?token=(\S+)/.exec(text);
      if (found) resolve({ host: found[1], token: found[2] });
    });
  });
  return { child, ...address };
}

/** A viewer that knows the channels and services. */
async function connect({ host, token }) {
  const client = new FoxgloveClient({ ws: new WebSocket(`ws://${host}/?token=${token ?? ""}`.replace(/\?token=$/, ""), [protocol]) });
  const viewer = { client, channels: new Map(), services: new Map(), failures: [], statuses: [], call: 1 };
  client.on("advertise", (list) => list.forEach((c) => viewer.channels.set(c.topic, c)));
  client.on("unadvertise", (ids) => {
    for (const [topic, c] of viewer.channels) if (ids.includes(c.id)) viewer.channels.delete(topic);
  });
  client.on("advertiseServices", (list) => list.forEach((s) => viewer.services.set(s.name, s)));
  client.on("status", (status) => viewer.statuses.push(status.message));
  viewer.info = await once(client, "serverInfo");
  // What may steer is told the services too, in a message of its own.
  await until(() => viewer.channels.size > 0 && (!token || viewer.services.size > 0), "channels and services");
  return viewer;
}

function once(client, event, accept = () => true) {
  return new Promise((resolve, reject) => {
    const timer = setTimeout(() => reject(new Error(`no ${event} within ${hang} ms`)), hang);
    const listener = (value) => {
      if (!accept(value)) return;
      clearTimeout(timer);
      client.off(event, listener);
      resolve(value);
    };
    client.on(event, listener);
  });
}

async function until(holds, what = holds) {
  const end = Date.now() + hang;
  while (!(await holds())) {
    if (Date.now() > end) assert.fail(`not within ${hang} ms: ${what}`);
    await sleep(20);
  }
}

function subscribe(viewer, topic) {
  return viewer.client.subscribe(viewer.channels.get(topic).id);
}

/** The answer of a service, or an error with its sentence. */
function call(viewer, name, request = {}) {
  const service = viewer.services.get(name);
  const callId = viewer.call++;
  const answer = Promise.race([
    once(viewer.client, "serviceCallResponse", (r) => r.callId === callId).then((r) =>
      JSON.parse(new TextDecoder().decode(r.data))),
    once(viewer.client, "serviceCallFailure", (r) => r.callId === callId).then((r) => {
      throw new Error(r.message);
    }),
  ]);
  const data = new TextEncoder().encode(JSON.stringify(request));
  viewer.client.sendServiceCallRequest({
    serviceId: service?.id ?? 1 /* not offered: of /pause */, callId, encoding: "json",
    data: new DataView(data.buffer, data.byteOffset, data.byteLength),
  });
  return answer;
}

/** The first varint field with this number, of a message without groups. */
function varint(data, field) {
  let at = 0;
  const read = () => {
    let value = 0n, shift = 0n;
    for (;;) {
      const byte = BigInt(data.getUint8(at++));
      value |= (byte & 127n) << shift;
      if (byte < 128n) return value;
      shift += 7n;
    }
  };
  while (at < data.byteLength) {
    const key = Number(read());
    if ((key & 7) === 0) {
      const value = read();
      if (key >> 3 === field) return Number(value);
    } else if ((key & 7) === 2) {
      const length = Number(read());
      at += length;
    } else at += (key & 7) === 1 ? 8 : 4;
  }
  return 0;
}
/** The z coordinate of the first link in Poses. */
function height(data) {
  const bytes = new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
  for (let at = 0; at + 14 < bytes.length; ++at) {
    if (bytes[at] === 0x22) return data.getFloat32(at + 2 + 8, true);
  }
  return NaN;
}

function status(url, headers = {}) {
  return new Promise((resolve, reject) => {
    http.get(url, { headers }, (r) => resolve(r.resume().statusCode)).on("error", reject);
  });
}

/** How the server answers a handshake: "open", or the status of its refusal. */
function handshake(url, headers = {}, protocols = [protocol]) {
  return new Promise((resolve) => {
    const ws = new WebSocket(url, protocols, { headers });
    ws.on("open", () => { resolve("open"); ws.close(); });
    ws.on("unexpected-response", (request, response) => {
      resolve(response.statusCode);
      request.destroy();
    });
    ws.on("error", () => resolve("error"));
  });
}

const tests = {
  async a_viewer_sees_and_steers(server) {
    const viewer = await connect(server);
    assert.equal(viewer.info.name, "ziggurat");
    assert.equal(viewer.info.metadata.may_steer, "true");
    for (const topic of ["/world", "/poses", "/tf", "/scene", "/barrier", "/log"]) {
      assert.ok(viewer.channels.has(topic), topic);
    }
    let tick = -1, z = NaN, world, frames = 0;
    const worldId = subscribe(viewer, "/world"), posesId = subscribe(viewer, "/poses");
    viewer.client.on("message", ({ subscriptionId, data }) => {
      if (subscriptionId === worldId) world = data;
      if (subscriptionId === posesId) { tick = varint(data, 1); z = height(data); ++frames; }
    });
    await until(() => world && frames > 5, "world and poses");
    assert.ok(z < 1, "it falls");

    const paused = await call(viewer, "/pause");
    await until(() => tick === paused.tick, "the last tick is shown");
    await sleep(400); // elapsed time is the subject
    assert.equal(tick, paused.tick, "a paused world stands");
    assert.equal((await call(viewer, "/step")).tick, paused.tick + 1);
    await until(() => tick === paused.tick + 1, "the step is shown");
    await call(viewer, "/move", { entity: "crate", position: [0, 0, 3] });
    await until(() => Math.abs(z - 3) < 1e-6, "a move is shown while the world is paused");
    await assert.rejects(call(viewer, "/move", { entity: "ghost", position: [0, 0, 3] }), /no entity 'ghost'/);
    await assert.rejects(call(viewer, "/move", { entity: "crate", position: "up" }), /position/);

    const before = varint(world, 1);
    const xml = '<box id="late" size="0.1,0.1,0.1" movable="true" mass="1"><body position="1,0,0"/></box>';
    await call(viewer, "/spawn", { xml });
    await until(() => varint(world, 1) === before + 1, "a new world is sent");
    await assert.rejects(call(viewer, "/spawn", { xml }), /late/);
    await call(viewer, "/remove", { entity: "late" });
    await until(() => varint(world, 1) === before + 2);
    await call(viewer, "/speed", { factor: 1000 });
    await call(viewer, "/resume");
    const from = tick;
    await until(() => tick > from + 3000, "ticks that would take five minutes");
    assert.equal((await call(viewer, "/reset", { seed: 5 })).tick, 0);
    await until(() => varint(world, 4) !== 0 && varint(world, 1) === before + 3, "the world began anew");
    viewer.client.close();
  },

  async parameters_are_read_and_set(server) {
    const viewer = await connect(server);
    viewer.client.getParameters([], "all");
    const all = await once(viewer.client, "parameterValues", (v) => v.id === "all");
    assert.deepEqual(all.parameters.map((p) => p.name).sort(),
      ["draw_frusta", "draw_labels", "frames_per_second", "phase", "real_time_factor"]);
    viewer.client.setParameters([{ name: "real_time_factor", value: 1 }], "set");
    const set = await once(viewer.client, "parameterValues", (v) => v.id === "set");
    assert.equal(set.parameters[0].value, 1);
    viewer.client.setParameters([{ name: "frames_per_second", value: 1e9 }], "bad");
    const bad = await once(viewer.client, "parameterValues", (v) => v.id === "bad");
    assert.equal(bad.parameters[0].value, 60);
    assert.match(viewer.statuses.join(), /1 to 1000/);
    viewer.client.close();
  },

  async without_token_a_viewer_only_looks(server) {
    const viewer = await connect({ host: server.host });
    assert.equal(viewer.info.metadata.may_steer, "false");
    await assert.rejects(call(viewer, "/pause"), /token/);
    assert.equal(viewer.services.size, 0);
    viewer.client.setParameters([{ name: "real_time_factor", value: 100 }], "x");
    const values = await once(viewer.client, "parameterValues", (v) => v.id === "x");
    assert.equal(values.parameters[0].value, 1);
    viewer.client.close();
  },

  async host_origin_and_token_decide({ host, token }) {
    const port = host.split(":")[1];
    assert.equal(await status(`http://${host}/`), 200);
    assert.equal(await status(`http://${host}/`, { Host: "localhost:" + port }), 200);
    assert.equal(await status(`http://${host}/`, { Host: "evil.example:" + port }), 403);
    assert.equal(await status(`http://${host}/%2e%2e/secret`), 404);
    const url = `ws://${host}/`;
    assert.equal(await handshake(url), "open");
    assert.equal(await handshake(url, { Origin: `http://${host}` }), "open");
    assert.equal(await handshake(url, { Origin: "https://evil.example" }), 403);
    assert.equal(await handshake(url, { Origin: "null" }), 403);
    assert.equal(await handshake(`${url}?token=${token}`, { Origin: "https://app.foxglove.dev" }), "open");
    assert.equal(await handshake(`${url}?token=wrong`), 403);
    assert.equal(await handshake(`${url}?token=${token}`, { Host: "evil.example" }), 403);
    assert.equal(await handshake(url, {}, ["chat"]), 400);
    assert.equal(await handshake(`ws://${host}/elsewhere`), 404);
  },

  async garbage_harms_no_other(server) {
    const good = await connect(server);
    subscribe(good, "/poses");
    let seed = 1;
    const random = () => (seed = (seed * 48271) % 2147483647);
    let sent = 0;
    for (let connection = 0; connection < 20; ++connection) {
      const ws = new WebSocket(`ws://${server.host}/?token=${server.token}`, [protocol]);
      ws.on("error", () => {});
      await new Promise((resolve) => ws.on("open", resolve));
      for (let i = 0; i < 50; ++i, ++sent) {
        const bytes = Buffer.from(Array.from({ length: random() % 200 }, () => random() & 255));
        const text = '{"op":"subscribe","subscriptions":[{"id":' + "9".repeat(random() % 40) + "[".repeat(random() % 90);
        if (i % 3 === 0) bytes[0] = 2;
        i % 2 ? ws.send(bytes) : ws.send(text);
      }
      ws.on("message", () => {});
      await sleep(5); // some are read, some are not
      ws.terminate();
    }
    assert.equal(sent, 1000);
    const large = new WebSocket(`ws://${server.host}/?token=${server.token}`, [protocol]);
    const closed = new Promise((resolve) => large.on("close", resolve));
    large.on("error", () => {});
    await new Promise((resolve) => large.on("open", resolve));
    large.send(Buffer.alloc(3 << 20));
    await closed;
    await once(good.client, "message");
    good.client.close();
  },

  async five_hundred_connections(server) {
    const all = Array.from({ length: 500 }, () => {
      const ws = new WebSocket(`ws://${server.host}/`, [protocol]);
      ws.on("error", () => {});
      return ws;
    });
    const count = () => all.filter((ws) => ws.readyState === WebSocket.OPEN).length;
    await until(() => all.every((ws) => ws.readyState !== WebSocket.CONNECTING), "an answer to each");
    const open = count();
    assert.ok(open > 0 && open <= 64, `${open} of them are open`);
    const ends = all.map((ws) => ws.readyState === WebSocket.CLOSED || new Promise((resolve) => ws.on("close", resolve)));
    all.forEach((ws) => ws.terminate());
    await Promise.all(ends);
    const viewer = await connect(server);
    subscribe(viewer, "/poses");
    await once(viewer.client, "message");
    viewer.client.close();
  },

  async viewers_that_never_read_hold_up_nothing(server) {
    const viewer = await connect(server);
    await call(viewer, "/speed", { factor: 100 });
    const sleepers = [];
    for (let i = 0; i < 10; ++i) {
      const ws = new WebSocket(`ws://${server.host}/`, [protocol]);
      await new Promise((resolve) => ws.on("open", resolve));
      const subscriptions = ["/world", "/poses", "/tf", "/scene"].map((topic, id) =>
        ({ id, channelId: viewer.channels.get(topic).id }));
      ws.send(JSON.stringify({ op: "subscribe", subscriptions }));
      ws._socket.pause();
      sleepers.push(ws);
    }
    let frames = 0;
    subscribe(viewer, "/poses");
    viewer.client.on("message", () => ++frames);
    await until(() => frames > 60, "frames beside the sleepers");
    sleepers.forEach((ws) => ws.terminate());
    viewer.client.close();
  },

  async the_world_waits_for_the_first_viewer_but_not_forever() {
    const first = async (server, after) => {
      await sleep(after);
      const viewer = await connect(server);
      subscribe(viewer, "/poses");
      const tick = varint((await once(viewer.client, "message")).data, 1);
      viewer.client.close();
      server.child.kill("SIGKILL");
      return tick;
    };
    const [early, late] = await Promise.all([start("--view=127.0.0.1:0"), start("--view=127.0.0.1:0")]);
    [early, late].forEach(({ child }) => child.removeAllListeners("exit"));
    const ticks = await Promise.all([first(early, 500), first(late, 9000)]);
    assert.equal(ticks[0], 0, "10 ticks per second, and none before the first viewer");
    assert.ok(ticks[1] > 0, "after 5 seconds it begins");
  },

  async serve_shows_its_run_too() {
    const server = await startCommand("serve", "--duration=0", "--view=127.0.0.1:0", "--endpoint=tcp://127.0.0.1:*");
    server.child.removeAllListeners("exit");
    const viewer = await connect(server);
    subscribe(viewer, "/world");
    await once(viewer.client, "message");
    viewer.client.close();
    server.child.kill("SIGKILL");
  },

  async a_run_that_is_over_says_that_it_cannot_be_reset() {
    const server = await startCommand("run", "--ticks=2", "--view=127.0.0.1:0");
    server.child.removeAllListeners("exit");
    const viewer = await connect(server);
    viewer.client.subscribeParameterUpdates(["phase"]);
    subscribe(viewer, "/poses");
    await once(viewer.client, "parameterValues", ({ parameters }) => parameters.some((p) => p.value === "over"));
    await assert.rejects(call(viewer, "/reset"), /start the program again/);
    await assert.rejects(call(viewer, "/pause"), /The run is over/);
    viewer.client.close();
    server.child.kill("SIGKILL");
  },

  async shutdown_ends_the_run(server) {
    const viewer = await connect(server);
    const ended = new Promise((resolve) => server.child.on("exit", resolve));
    await call(viewer, "/shutdown").catch(() => {});
    assert.equal(await Promise.race([ended, sleep(hang).then(() => "still running")]), 130);
  },
};

const server = await start("--view=127.0.0.1:0");
server.child.removeAllListeners("exit");
let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  try {
    await test(server);
    console.log(`ok ${name}`);
  } catch (error) {
    ++failed;
    console.log(`FAILED ${name}: ${error.stack}`);
  }
}
server.child.kill("SIGKILL");
process.exit(failed ? 1 : 0);
