// SPDX-License-Identifier: MIT
// Recordings that @mcap/core writes: whole ones, cut ones, damaged ones.
import assert from "node:assert/strict";
import { test } from "node:test";
import { McapWriter, type IReadable } from "@mcap/core";
import { compress } from "lz4js";
import type { Status } from "../source/data/source";
import { Chunks } from "../source/model/chunks";
import { Collisions } from "../source/model/collisions";
import type { Contacts, World } from "../source/model/messages";
import { Playback } from "../source/model/playback";
import { Recorded } from "../source/model/recorded";
import { Series } from "../source/model/series";
import { encode, repeated, schema } from "./encode";

const tickNs = 100_000_000;

class Memory {
  private parts: Uint8Array[] = [];
  private size = 0;
  write(bytes: Uint8Array): Promise<unknown> {
    this.parts.push(bytes.slice());
    this.size += bytes.length;
    return Promise.resolve();
  }
  position(): bigint { return BigInt(this.size); }
  get bytes(): Uint8Array { return new Uint8Array(Buffer.concat(this.parts)); }
}

const mount = { link: 0, position: [0, 0, 0], orientation: [1, 0, 0, 0] };
function world(change: Record<string, unknown> = {}): Uint8Array {
  return encode("ziggurat.v1.World", {
    generation: 1n, scene: "a.argos", tickNs: BigInt(tickNs), arenaSize: [1, 1, 1], arenaCenter: [0, 0, 0.5],
    entities: [{ id: "<img src=x onerror=alert(1)>", kind: 1, movable: true, linkCount: 1, originPosition: [0, 0, 0], originOrientation: [1, 0, 0, 0] }],
    links: [{ id: "", collides: true, shape: { case: "box", value: { size: [0.1, 0.1, 0.1] } } }],
    leds: [{ id: "led", mount }], ...change });
}

/** A recording in which a box rises by 1 mm a tick, from 1 s on. */
async function write(ticks: number, firstWorld = world(), chunkSize = 4096,
                     more: [topic: string, tick: number, data: Uint8Array][] = []): Promise<Uint8Array> {
  const memory = new Memory();
  const writer = new McapWriter({ writable: memory, chunkSize,
    compressChunk: (data) => ({ compression: "lz4", compressedData: new Uint8Array(compress(data)) }) });
  await writer.start({ profile: "ziggurat", library: "test" });
  const channels = new Map<string, number>();
  for (const [topic, type] of [["/world", "World"], ["/poses", "Poses"], ["/contacts", "Contacts"]]) {
    const schemaId = await writer.registerSchema({ name: `ziggurat.v1.${type}`, encoding: "protobuf", data: schema });
    channels.set(topic, await writer.registerChannel({ schemaId, topic, messageEncoding: "protobuf", metadata: new Map() }));
  }
  const logId = await writer.registerSchema({ name: "foxglove.Log", encoding: "protobuf", data: schema });
  channels.set("/log", await writer.registerChannel({ schemaId: logId, topic: "/log", messageEncoding: "protobuf", metadata: new Map() }));
  let sequence = 0;
  const put = async (topic: string, tick: number, data: Uint8Array): Promise<void> => {
    const logTime = BigInt(1_000_000_000 + tick * tickNs);
    await writer.addMessage({ channelId: channels.get(topic)!, sequence: sequence++, logTime, publishTime: logTime, data });
  };
  await put("/world", 0, firstWorld);
  for (let tick = 0; tick <= ticks; ++tick) {
    await put("/poses", tick, encode("ziggurat.v1.Poses", { tick: BigInt(10 + tick), generation: 1n,
      positions: [0, 0, 0.001 * tick], orientations: [1, 0, 0, 0], ledColors: [0xff0000] }));
    for (const [topic, at, data] of more) if (at === tick) await put(topic, tick, data);
    if (tick === 5) await put("/log", tick, encode("foxglove.Log", { level: 4, name: "robot", message: "<b>lost</b>" }));
  }
  await writer.end();
  return memory.bytes;
}

function open(bytes: Uint8Array, count: (read: number) => void = () => undefined): Promise<Recorded> {
  const file: IReadable = {
    size: () => Promise.resolve(BigInt(bytes.length)),
    read: (offset, size) => {
      if (offset + size > BigInt(bytes.length)) return Promise.reject(new Error("it points behind its own end"));
      count(Number(size));
      return Promise.resolve(bytes.slice(Number(offset), Number(offset + size)));
    },
  };
  return Recorded.open(file, "run.mcap");
}

class Heard {
  lines: string[] = [];
  notices: string[] = [];
  list: string[] = [];
  status(_: Status): void { /* it is open */ }
  topics(topics: string[]): void { this.list = topics; }
  message(): void { assert.fail("a recording sends no messages"); }
  parameter(): void { /* it has none */ }
  notice(_: string, text: string): void { this.notices.push(text); }
  logged({ message }: { message: string }, sequence: number): void { this.lines.push(`${sequence} ${message}`); }
}

async function until<T>(look: () => T | null | undefined | false): Promise<T> {
  for (let i = 0; i < 2000; ++i) {
    const found = look();
    if (found) return found;
    await new Promise((resolve) => setTimeout(resolve, 2));
  }
  assert.fail("it never came");
}

test("all frames of a recording, its log and its plots", async () => {
  const recorded = await open(await write(300));
  const heard = new Heard();
  assert.equal(recorded.last, 300);
  assert.equal(recorded.seconds.toFixed(1), "30.0");
  recorded.start(heard);
  for (const sequence of [0, 300, 7, 150, 149]) {
    const frame = await until(() => recorded.at(sequence));
    assert.equal(frame.sequence, sequence);
    assert.equal(frame.tick, 10 + sequence);
    assert.equal(frame.world?.scene, "a.argos");
    const { positions } = frame.messages.get("/poses")!.read<{ positions: Float32Array }>();
    assert.ok(Math.abs(positions[2] - 0.001 * sequence) < 1e-6);
  }
  await until(() => recorded.marks.length > 0);
  assert.deepEqual(recorded.marks, [{ sequence: 5, kind: "error", text: "robot: <b>lost</b>" }]);
  assert.deepEqual(heard.lines, ["5 <b>lost</b>"]);
  assert.deepEqual(heard.list, ["/contacts", "/log", "/poses", "/world"]);
  const series = new Series({ topic: "/poses", path: "positions.2" });
  recorded.fill(series);
  await until(() => series.values.length === 301);
  assert.ok(Math.abs((series.values[300] ?? 0) - 0.3) < 1e-6);
  assert.deepEqual(heard.notices, []);
  recorded.close();
});

test("a place in a large recording is found without reading the rest", async () => {
  const bytes = await write(20_000, world(), 16_384);
  let read = 0;
  const recorded = await open(bytes, (size) => { read += size; });
  const begin = process.cpuUsage(); // other programs run beside
  const frame = await until(() => recorded.at(15_000));
  const used = process.cpuUsage(begin);
  const took = (used.user + used.system) / 1000;
  assert.equal(frame.tick, 15_010);
  assert.ok(read < bytes.length / 2, `${read} of ${bytes.length} bytes were read`);
  assert.ok(took < 200, `${took.toFixed(0)} ms`);
});

test("while a place is being read, the nearest one that is there is known; memory has its bound", async () => {
  const recorded = await open(await write(20_000, world(), 16_384));
  assert.equal(recorded.nearest(500), null); // nothing is there yet
  await until(() => recorded.at(2_000));
  assert.equal(recorded.at(15_000), null);
  const near = recorded.nearest(15_000)!;
  assert.ok(near.sequence >= 2_000 && near.sequence < 3_000 && near.tick === near.sequence + 10, `${near.sequence}`);
  await until(() => recorded.at(15_000));
  assert.equal(recorded.nearest(15_000)?.sequence, 15_000);

  const chunks = new Chunks(recorded.container, (timeNs) => Number(timeNs - 1_000_000_000n) / tickNs, 100_000);
  const here = (): number => chunks.parts.filter(({ state }) => state === "here").length;
  for (const part of chunks.parts) {
    chunks.use(part);
    chunks.keep(part, await recorded.container.read(part.chunk));
    chunks.trim(() => undefined);
  }
  assert.ok(here() >= 1 && here() < 5, `${here()} of ${chunks.parts.length} chunks`);
  assert.equal(chunks.nearest(0), chunks.parts.find(({ state }) => state === "here")?.sequences[0]);
  assert.ok(!chunks.hasRoomFor(chunks.parts[0]));
});

const damaged = new Uint8Array([8]); // the number is missing

test("damaged messages are told with topic and time, and the rest is shown", async () => {
  const recorded = await open(await write(60, world(), 4096, [["/log", 20, damaged], ["/world", 40, damaged], ["/contacts", 50, damaged]]));
  const heard = new Heard();
  recorded.start(heard);
  for (const sequence of [60, 20, 40, 50]) assert.equal((await until(() => recorded.at(sequence))).tick, 10 + sequence);
  await until(() => heard.notices.length === 3);
  const told = (text: RegExp): void => assert.ok(heard.notices.some((notice) => text.test(notice)), `${text}: ${heard.notices.join("\n")}`);
  told(/^run.mcap: \/log at 2.00 s is damaged. It is left out.$/);
  told(/\/world at 4.00 s is damaged/);
  told(/\/contacts at 5.00 s is damaged/);
  assert.ok(!recorded.at(20)?.messages.has("/log") && recorded.at(20)?.messages.has("/poses"));
  await until(() => heard.lines.length === 1);
  assert.deepEqual(heard.notices.length, 3); // each once
  recorded.close();
});

test("a first world that is damaged: the next one is shown, or the file is refused", async () => {
  await assert.rejects(open(await write(5, damaged)), /^Error: run.mcap can't be read: its \/world at 0.00 s is damaged/);
  const recorded = await open(await write(5, damaged, 4096, [["/world", 1, world()]]));
  recorded.start(new Heard());
  assert.equal((await until(() => recorded.at(3))).tick, 13);
  recorded.close();
});

/** A file with one chunk, not compressed, of such records. */
function fileOf(records: Uint8Array): Uint8Array {
  const head = new DataView(new ArrayBuffer(9 + 40));
  head.setUint8(0, 6); // a chunk
  head.setBigUint64(1, BigInt(40 + records.length), true);
  head.setBigUint64(9, 0n, true);
  head.setBigUint64(17, 1n, true); // times
  head.setBigUint64(25, BigInt(records.length), true);
  head.setBigUint64(41, BigInt(records.length), true);
  return new Uint8Array(Buffer.concat([Buffer.from("\x89MCAP0\r\n", "latin1"), new Uint8Array(head.buffer), records]));
}

test("a chunk of very many messages, and schemas of very many bytes, are refused", async () => {
  const empty = new Uint8Array(31);
  empty.set([5, 22]);
  await assert.rejects(open(fileOf(repeated(empty, 31 * 1_000_001))), /a chunk has more than 1000000 messages/);
  const schemas = Array.from({ length: 17 }, (_, id) => {
    const record = new DataView(new ArrayBuffer(9 + 14 + 4e6));
    record.setUint8(0, 3);
    record.setBigUint64(1, BigInt(14 + 4e6), true);
    record.setUint16(9, id, true);
    record.setUint32(19, 4e6, true);
    return new Uint8Array(record.buffer);
  });
  await assert.rejects(open(fileOf(new Uint8Array(Buffer.concat(schemas)))), /its schemas and channels are too large/);
});

test("a recording that was cut off is shown up to there, and the user is told", async () => {
  const whole = await write(300);
  const { chunks } = (await open(whole)).container;
  const recorded = await open(whole.slice(0, chunks[chunks.length >> 1].offset + 100));
  assert.ok(recorded.isCut);
  assert.ok(recorded.last > 45 && recorded.last < 290, `${recorded.last}`);
  const heard = new Heard();
  recorded.start(heard);
  assert.equal((await until(() => recorded.at(40))).tick, 50);
  assert.match(heard.notices[0], /cut off after .* s/);
  recorded.close();
});

test("a file that is no recording gives one sentence", async () => {
  const cases: [Uint8Array, RegExp][] = [
    [new Uint8Array(0), /is no recording/],
    [new TextEncoder().encode("hello, world: this is a text"), /is no recording/],
    [(await write(3)).slice(0, 40), /has no messages/],
    [await write(3, world({ links: [{ id: "", entity: 7 }] })), /entity 7 does not exist/],
    [await write(3, world({ leds: [{ id: "led", mount: { ...mount, link: 4_000_000_000 } }] })), /link 4000000000 does not exist/],
    [await write(3, world({ tickNs: 0n })), /its world has no tick/],
  ];
  for (const [bytes, sentence] of cases) await assert.rejects(open(bytes), sentence);
});

test("flipped bits: an error in words, or frames, and never anything else", async () => {
  const whole = await write(60);
  let refused = 0, told = 0;
  for (let i = 0; i < 150; ++i) {
    const bytes = whole.slice();
    bytes[(i * 7919) % bytes.length] ^= 1 << (i % 8);
    const heard = new Heard();
    let recorded: Recorded;
    try {
      recorded = await open(bytes);
    } catch (error) {
      assert.match((error as Error).message, /^run.mcap (is|has|can't)/);
      ++refused;
      continue;
    }
    recorded.start(heard);
    recorded.close();
    for (const sequence of [0, Math.floor(recorded.last / 2), recorded.last]) {
      recorded.at(sequence);
      await new Promise((resolve) => setTimeout(resolve, 0));
    }
    if (heard.notices.length > 0) ++told;
  }
  assert.ok(refused > 0 && told > 0, `${refused} refused, ${told} told`);
});

test("playing takes simulated time, and waits for what is being read", () => {
  let isThere = false;
  const frames = { length: 101, first: 0, last: 100, newest: null, marks: [], message: () => null, stepNs: () => tickNs,
                   at: (sequence: number) => (isThere || sequence < 10 ? { sequence } as never : null) };
  const playback = new Playback();
  assert.equal(playback.advance(1, 0, frames), 0); // it stands
  playback.start();
  playback.speed = 2;
  let at = playback.advance(10, 0, frames);
  for (let now = 10.1; now < 10.65; now += 0.1) at = playback.advance(now, at, frames);
  assert.equal(at, 9); // the next one is being read: 12 would be right in time
  isThere = true;
  at = playback.advance(10.7, at, frames);
  at = playback.advance(10.8, at, frames);
  assert.ok(at >= 12 && at <= 13, `${at}`);
});

test("collisions are pairs that begin to touch, not the floor and not what rests", () => {
  const world = { links: [{ entity: 0 }, { entity: 0 }, { entity: 1 }], entities: [{ id: "a" }, { id: "b" }] } as unknown as World;
  const touching = (...links: number[]): Contacts => ({ tick: 0, links, points: [], normals: [], forces: [] });
  const collisions = new Collisions();
  assert.equal(collisions.take(touching(0, -1), 0, world), "");
  assert.equal(collisions.take(touching(0, 1), 1e8, world), "");
  assert.equal(collisions.take(touching(1, 2), 2e8, world), "collision: a and b");
  assert.equal(collisions.take(touching(2, 0), 3e8, world), "");
  assert.equal(collisions.take(touching(), 6e8, world), "");
  assert.equal(collisions.take(touching(2, 0), 7e8, world), ""); // it bounced
  assert.equal(collisions.take(touching(2, 0), 13e8, world), ""); // a fast world sends few ticks: nobody saw them apart
  assert.equal(collisions.take(touching(), 14e8, world), "");
  assert.equal(collisions.take(touching(2, 0), 20e8, world), "collision: a and b");
  assert.equal(new Collisions().take(touching(2, 0), 0, world), ""); // it touched before the page looked
});
