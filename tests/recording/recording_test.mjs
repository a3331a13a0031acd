// SPDX-License-Identifier: MIT
// Recordings of real runs, read by an independent reader of MCAP files: all chunks, schemas, indexes and CRCs, and
// hash by hash against --hash-file.
//
// usage: node recording_test.mjs ZIGGURAT SCENE...
import { loadDecompressHandlers } from "./decompress.mjs";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import protobuf from "protobufjs";
import "protobufjs/ext/descriptor/index.js";

const [program, ...scenes] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "recording-"));
const decompressHandlers = await loadDecompressHandlers();
const ticks = 60;

/** Every record in the order of the file; throws at a wrong CRC. */
function stream(bytes) {
  const reader = new McapStreamReader({ includeChunks: true, decompressHandlers, validateCrcs: true });
  reader.append(bytes);
  const records = [];
  for (let record; (record = reader.nextRecord()); ) records.push(record);
  assert.ok(reader.done(), "the file has an end");
  return records;
}

function indexed(bytes) {
  return McapIndexedReader.Initialize({
    readable: {
      size: async () => BigInt(bytes.length),
      read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
    },
    decompressHandlers,
  });
}

/** Fields of repeated bytes below a type or package. Viewers of Foxglove's family refuse types that have one. */
function repeatedBytes(below) {
  const own = (below.fieldsArray ?? []).filter((field) => field.repeated && field.type === "bytes").map((field) => field.fullName);
  return own.concat((below.nestedArray ?? []).flatMap(repeatedBytes));
}

/** Decoders of messages, from the schemas in the file. */
function decoders(reader) {
  const types = new Map();
  for (const channel of reader.channelsById.values()) {
    const schema = reader.schemasById.get(channel.schemaId);
    assert.ok(schema, `${channel.topic} has a schema`);
    assert.equal(channel.messageEncoding, "protobuf");
    assert.equal(schema.encoding, "protobuf");
    const root = protobuf.Root.fromDescriptor(schema.data);
    assert.deepEqual(repeatedBytes(root), [], `${channel.topic} has no repeated bytes`);
    types.set(channel.id, root.lookupType(schema.name));
  }
  return types;
}

const hex = (hash) => BigInt.asUintN(64, BigInt(hash.toString())).toString(16).padStart(16, "0");

async function check(scene, compression) {
  const file = join(folder, "run.mcap"), hashes = join(folder, "hashes");
  execFileSync(program, ["run", scene, `--ticks=${ticks}`, "--quiet", "--record", file, "--hash-file", hashes,
                         "--record-compression", compression], { stdio: ["ignore", "ignore", "inherit"] });
  const bytes = readFileSync(file);
  const records = stream(bytes);
  const reader = await indexed(bytes);

  // What the summary says is what there is.
  const chunks = records.filter((r) => r.type === "Chunk");
  assert.equal(reader.header.profile, "ziggurat");
  assert.equal(reader.chunkIndexes.length, chunks.length);
  for (const chunk of chunks) {
    assert.equal(chunk.compression, compression === "none" ? "" : compression);
    assert.notEqual(chunk.uncompressedCrc, 0);
  }
  assert.notEqual(reader.dataSectionCrc, 0);
  assert.notEqual(reader.footer.summaryCrc, 0);
  const streamed = records.filter((r) => r.type === "Message");
  assert.equal(reader.statistics.messageCount, BigInt(streamed.length));
  const counts = new Map();
  for (const { channelId } of streamed) counts.set(channelId, (counts.get(channelId) ?? 0n) + 1n);
  for (const [id, count] of reader.statistics.channelMessageCounts) assert.equal(counts.get(id) ?? 0n, count);

  // By the indexes: all messages, each decodes, times never fall.
  const types = decoders(reader);
  const inputs = [];
  let read = 0, last = 0n;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const decoded = types.get(message.channelId).decode(message.data);
    assert.ok(message.logTime >= last);
    last = message.logTime;
    read += 1;
    if (reader.channelsById.get(message.channelId).topic === "/inputs") inputs.push(decoded);
  }
  assert.equal(read, streamed.length);

  // Hash by hash.
  const lines = readFileSync(hashes, "utf8").trim().split("\n").map((line) => line.split(" "));
  assert.equal(lines.length, ticks + 1);
  assert.deepEqual(inputs.map((each) => ["hash", String(each.tick ?? 0), hex(each.hash)]), lines);

  // The scene is in it.
  const attachments = [];
  for await (const each of reader.readAttachments({ validateCrcs: true })) attachments.push(each);
  assert.deepEqual(Buffer.from(attachments.find((each) => each.name === basename(scene)).data), readFileSync(scene));
  const metadata = [];
  for await (const each of reader.readMetadata()) metadata.push(each);
  assert.equal(metadata[0].metadata.get("scene"), basename(scene));

  // Seeking.
  let later = 0;
  for await (const message of reader.readMessages({ startTime: last, topics: ["/poses"] })) {
    assert.equal(message.logTime, last);
    later += 1;
  }
  assert.equal(later, 1);
  console.log(`${scene}, ${compression}: ${streamed.length} messages in ${chunks.length} chunks, ${lines.length} hashes`);
}

try {
  for (const scene of scenes) await check(scene, "zstd");
  await check(scenes[0], "lz4");
  await check(scenes[0], "none");
} finally {
  rmSync(folder, { recursive: true });
}
