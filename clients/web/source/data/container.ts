// SPDX-License-Identifier: MIT
// An MCAP file, chunk by chunk: https://mcap.dev/spec. The summary is read by @mcap/core. A file without summary, as a
// run leaves that was killed, is walked through record by record, and read up to the place where it ends. Files are
// input of unknown people: every length is checked against what is there, and no number of the file decides how much
// memory is taken without a limit.
import { crc32 } from "@foxglove/crc";
import { hasMcapPrefix, McapConstants, McapIndexedReader, type IReadable } from "@mcap/core";
import { decompress as decompressZstd } from "fzstd";
import { decompress as decompressLz4 } from "lz4js";

const { Opcode } = McapConstants;
const largestChunk = 256 * 1024 * 1024; // [B] compressed, and decompressed
const mostChunks = 2_000_000;
const mostMessages = 1_000_000; // of a chunk
const mostDefinitions = 64 * 1024 * 1024; // [B] all schemas and channels

export interface Chunk {
  readonly offset: number; // of its record in the file
  readonly length: number; // of its record
  readonly startNs: bigint; // log times of its messages
  readonly endNs: bigint;
  readonly channels: ReadonlySet<number> | null; // of its messages; null: unknown
}
export interface Channel { topic: string; encoding: string; schema: number }
export interface Schema { name: string; encoding: string; data: Uint8Array }
export interface RawMessage { channel: number; timeNs: bigint; data: Uint8Array }

/** A file of the disk. */
export function readable(file: Blob): IReadable {
  return {
    size: () => Promise.resolve(BigInt(file.size)),
    read: async (offset, size) => {
      const [from, to] = [Number(offset), Number(offset + size)];
      if (!(from >= 0 && to >= from && to <= file.size)) throw new Error("it points behind its own end");
      if (to - from > largestChunk) throw new Error(`it has a record of ${to - from} bytes`);
      return new Uint8Array(await file.slice(from, to).arrayBuffer());
    },
  };
}

/** Little-endian numbers and texts, one after the other. @throws RangeError behind the end */
class Bytes {
  private readonly view: DataView;
  at = 0;
  constructor(private readonly bytes: Uint8Array) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }
  get left(): number { return this.bytes.length - this.at; }
  u8(): number { return this.view.getUint8(this.at++); }
  u16(): number { return this.view.getUint16((this.at += 2) - 2, true); }
  u32(): number { return this.view.getUint32((this.at += 4) - 4, true); }
  u64(): bigint { return this.view.getBigUint64((this.at += 8) - 8, true); }
  size(): number { return Number(this.u64()); }
  take(length: number): Uint8Array {
    if (!(length <= this.left)) throw new RangeError("cut off");
    return this.bytes.subarray(this.at, this.at += length);
  }
  text(): string { return new TextDecoder().decode(this.take(this.u32())); }
}

export class Container {
  readonly chunks: Chunk[] = []; // in the order of their times
  readonly channels = new Map<number, Channel>();
  readonly schemas = new Map<number, Schema>();
  /** The file ends in the middle, or has no summary. */
  isCut = false;
  private definitions = 0; // their bytes, as far as they stand outside of the summary

  private constructor(private readonly file: IReadable) {}

  /** @throws Error with the rest of a sentence that begins with the file's name */
  static async open(file: IReadable): Promise<Container> {
    const container = new Container(file);
    const size = Number(await file.size());
    const begin = await file.read(0n, BigInt(Math.min(8, size)));
    if (!hasMcapPrefix(new DataView(begin.buffer, begin.byteOffset, begin.byteLength))) {
      throw new Error("is no recording: it does not begin as an MCAP file does");
    }
    try {
      await container.readSummary(size);
    } catch {
      container.isCut = true;
      await container.walk(size);
    }
    container.chunks.sort((a, b) => (a.startNs < b.startNs ? -1 : a.startNs > b.startNs ? 1 : a.offset - b.offset));
    if (container.chunks.length === 0) throw new Error("has no messages: the run was stopped before its first tick was written");
    return container;
  }

  private async readSummary(size: number): Promise<void> {
    const none = (): never => { throw new Error("not needed here"); };
    const reader = await McapIndexedReader.Initialize({ readable: this.file, decompressHandlers: { zstd: none, lz4: none } });
    for (const index of reader.chunkIndexes) {
      const [offset, length] = [Number(index.chunkStartOffset), Number(index.chunkLength)];
      if (offset + length > size || index.messageEndTime < index.messageStartTime) throw new Error("its index is wrong");
      this.chunks.push({ offset, length, startNs: index.messageStartTime, endNs: index.messageEndTime,
                         channels: index.messageIndexOffsets.size > 0 ? new Set(index.messageIndexOffsets.keys()) : null });
    }
    for (const [id, { topic, messageEncoding, schemaId }] of reader.channelsById) {
      this.channels.set(id, { topic, encoding: messageEncoding, schema: schemaId });
    }
    for (const [id, { name, encoding, data }] of reader.schemasById) this.schemas.set(id, { name, encoding, data });
  }

  /** Finds the chunks one after the other, up to the first that is not whole. */
  private async walk(size: number): Promise<void> {
    this.chunks.length = 0;
    for (let at = 8; at + 9 <= size && this.chunks.length < mostChunks;) {
      const head = new Bytes(await this.file.read(BigInt(at), BigInt(Math.min(9 + 16, size - at))));
      const opcode = head.u8(), length = 9 + head.size();
      if (!(at + length <= size) || opcode === 0) return;
      if (opcode === Opcode.CHUNK && length >= 9 + 16) {
        const startNs = head.u64(), endNs = head.u64();
        if (endNs >= startNs) this.chunks.push({ offset: at, length, startNs, endNs, channels: null });
      } else if (opcode === Opcode.SCHEMA || opcode === Opcode.CHANNEL) {
        this.takeRecord(opcode, new Bytes(await this.file.read(BigInt(at + 9), BigInt(length - 9))));
      }
      at += length;
    }
  }

  private takeRecord(opcode: number, record: Bytes): void {
    const id = record.u16();
    if ((opcode === Opcode.SCHEMA ? this.schemas : this.channels).has(id)) return; // they are the same everywhere
    this.definitions += record.left;
    if (this.definitions > mostDefinitions) throw new Error("its schemas and channels are too large");
    if (opcode === Opcode.SCHEMA) {
      this.schemas.set(id, { name: record.text(), encoding: record.text(), data: record.take(record.u32()).slice() });
    } else {
      const schema = record.u16();
      this.channels.set(id, { topic: record.text(), encoding: record.text(), schema });
    }
  }

  /** All messages of a chunk, in the order of the file. @throws Error if the chunk is damaged */
  async read(chunk: Chunk): Promise<RawMessage[]> {
    const record = new Bytes(await this.file.read(BigInt(chunk.offset), BigInt(chunk.length)));
    if (record.u8() !== Opcode.CHUNK) throw new Error("its index is wrong");
    record.at += 8 + 16; // length, times
    const size = record.size(), crc = record.u32(), compression = record.text();
    if (!(size <= largestChunk)) throw new Error(`a chunk of ${size} bytes is too large`);
    const records = decompress(compression, record.take(record.size()), size);
    if (records.length !== size) throw new Error("a chunk is shorter than it should be");
    if (crc !== 0 && crc32(records) !== crc) throw new Error("the checksum of a chunk is wrong");
    const messages: RawMessage[] = [];
    const all = new Bytes(records);
    while (all.left > 0) {
      const opcode = all.u8();
      const inner = new Bytes(all.take(all.size()));
      if (opcode === Opcode.MESSAGE) {
        const channel = inner.u16();
        inner.at += 4; // its number
        const timeNs = inner.u64();
        inner.at += 8; // when it was published
        if (messages.length === mostMessages) throw new Error(`a chunk has more than ${mostMessages} messages`);
        messages.push({ channel, timeNs, data: inner.take(inner.left) });
      } else if (opcode === Opcode.SCHEMA || opcode === Opcode.CHANNEL) {
        this.takeRecord(opcode, inner);
      }
    }
    return messages;
  }
}

function decompress(name: string, bytes: Uint8Array, size: number): Uint8Array {
  switch (name) {
    case "": return bytes;
    case "zstd": return decompressZstd(bytes, new Uint8Array(size));
    case "lz4": return decompressLz4(bytes, size);
    default: throw new Error(`the compression ${name.slice(0, 20)} is unknown`);
  }
}
