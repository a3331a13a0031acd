// What decoding a message would take, found out before it is decoded: two bytes of anyone's file can become a thousand of
// memory. The bounds are those of the server's commands (server/recording/decoding.h).
import { ScalarType, type DescField, type DescMessage } from "@bufbuild/protobuf";
import { BinaryReader, WireType } from "@bufbuild/protobuf/wire";

const mebibyte = 1024 * 1024;
const entryMessage = 2 << 3 | WireType.LengthDelimited; // the value of an entry of a map
const mostLevels = 100; // of messages in messages
const place = 16; // of a value in an object or a list that grows [bytes]
const view = 240; // of an array of bytes or numbers, beside what is in it

/** The most that a message may have [bytes]: encoded, and decoded. */
export interface Bound { readonly bytes: number; readonly memory: number }
const ofWorlds: Bound = { bytes: 128 * mebibyte, memory: 1024 * mebibyte };
const ofInputs: Bound = { bytes: 32 * mebibyte, memory: 256 * mebibyte };
const ofOthers: Bound = { bytes: 64 * mebibyte, memory: 256 * mebibyte };
export const ofSchemas: Bound = { bytes: mebibyte, memory: 64 * mebibyte };
export const ofAllWorlds = 2048 * mebibyte; // those of a recording that are known [bytes], decoded

export function boundOf(type: string): Bound {
  if (type === "ziggurat.v1.World" || type === "foxglove.SceneUpdate") return ofWorlds;
  return type === "ziggurat.v1.Inputs" || type === "ziggurat.v1.ExactState" ? ofInputs : ofOthers;
}

/** What is wrong with a message, as the end of a sentence that begins with it. */
export class Unreadable extends Error {}

/**
 * The memory that a message will take [bytes].
 * @throws Unreadable if it is beyond the bound, or damaged
 */
export function weigh(bytes: Uint8Array, type: DescMessage, most: Bound): number {
  if (bytes.length > most.bytes) {
    throw new Unreadable(`has ${bytes.length} bytes; at most ${most.bytes} are read, and no run writes as many`);
  }
  let memory = Infinity;
  try {
    memory = new Weighing(bytes, most.memory).sum(type);
  } catch {
    throw new Unreadable("is damaged");
  }
  if (!(memory <= most.memory)) {
    throw new Unreadable(`has parts that take more than ${most.memory / mebibyte} MiB of memory, which none of a run does`);
  }
  return memory;
}

/** As a value stands in a message by itself. */
export function wireOf(scalar: ScalarType): WireType {
  switch (scalar) {
    case ScalarType.DOUBLE: case ScalarType.FIXED64: case ScalarType.SFIXED64: return WireType.Bit64;
    case ScalarType.FLOAT: case ScalarType.FIXED32: case ScalarType.SFIXED32: return WireType.Bit32;
    case ScalarType.STRING: case ScalarType.BYTES: return WireType.LengthDelimited;
    default: return WireType.Varint;
  }
}

/** The same of a field. Whether its numbers stand in a row: isPacked(). Others are unknown, and skipped. */
export function fits(field: DescField, wire: WireType): boolean {
  if (field.message || field.fieldKind === "map") return wire === WireType.LengthDelimited;
  return wire === wireOf(field.scalar ?? ScalarType.INT32) || isPacked(field, wire);
}

export function isPacked(field: DescField, wire: WireType): boolean {
  return field.fieldKind === "list" && !field.message && wire === WireType.LengthDelimited
      && wireOf(field.scalar ?? ScalarType.INT32) !== WireType.LengthDelimited;
}

const isLarge = (scalar: ScalarType): boolean => [ScalarType.INT64, ScalarType.UINT64, ScalarType.SINT64, ScalarType.FIXED64,
                                                  ScalarType.SFIXED64].includes(scalar);
/** Of a number beside its place: a large one has memory of its own. */
function ofNumber(scalar: ScalarType): number { return isLarge(scalar) ? 32 : scalar === ScalarType.DOUBLE ? 16 : 0; }

const empties = new WeakMap<DescMessage, number>();
/** Memory of a message without any field [bytes]. */
function ofEmpty(type: DescMessage): number {
  let memory = empties.get(type);
  if (memory === undefined) {
    memory = 64;
    for (const field of type.fields) memory += ofEmptyField(field);
    empties.set(type, memory);
  }
  return memory;
}

function ofEmptyField(field: DescField): number {
  if (field.fieldKind === "list") return place + 32;
  if (field.fieldKind === "map") return place + 64;
  if (field.fieldKind === "message") return 0; // counted when it comes
  const scalar = field.scalar ?? ScalarType.INT32;
  return place + (scalar === ScalarType.BYTES ? view : 8 + ofNumber(scalar));
}

class Weighing {
  private readonly reader: BinaryReader;
  private memory = 0;

  constructor(private readonly bytes: Uint8Array, private readonly most: number) { this.reader = new BinaryReader(bytes); }

  /** Infinity: more than the most, or with parts that no message of ours has. */
  sum(type: DescMessage): number {
    this.memory += ofEmpty(type);
    this.add(type, this.bytes.length, mostLevels);
    return this.memory <= this.most ? this.memory : Infinity;
  }

  private add(type: DescMessage, end: number, levels: number): void {
    const { reader } = this;
    const fields = fieldsOf(type);
    if (levels === 0) this.memory = Infinity;
    while (reader.pos < end && this.memory <= this.most) {
      const tag = this.varint();
      const wire = tag & 7;
      if (wire === WireType.StartGroup || wire === WireType.EndGroup) return void (this.memory = Infinity);
      if (tag >>> 3 === 0 || wire > WireType.Bit32) throw new RangeError("no field");
      const field = fields.get(tag >>> 3);
      if (!field || !fits(field, wire)) this.skip(wire);
      else if (wire !== WireType.LengthDelimited) this.number(field, wire);
      else this.content(field, levels);
      if (reader.pos > end) throw new RangeError("a part is longer than what it is in");
    }
  }

  private varint(): number {
    const { reader } = this;
    const first = this.bytes[reader.pos];
    if (!(first < 0x80)) return reader.uint32();
    ++reader.pos;
    return first;
  }

  private skip(wire: WireType): void {
    const { reader } = this;
    if (wire === WireType.LengthDelimited) {
      const length = this.varint();
      reader.pos += length;
    } else if (wire === WireType.Bit64) {
      reader.pos += 8;
    } else if (wire === WireType.Bit32) {
      reader.pos += 4;
    } else {
      while (this.bytes[reader.pos++] >= 0x80) { /* the next */ }
    }
  }

  private number(field: DescField, wire: WireType): void {
    this.skip(wire);
    this.memory += field.fieldKind === "list" ? place + ofNumber(field.scalar ?? ScalarType.INT32) : isAlwaysThere(field) ? 0 : place;
  }

  private content(field: DescField, levels: number): void {
    const { reader } = this;
    const length = this.varint();
    const end = reader.pos + length;
    if (end > this.bytes.length) throw new RangeError("cut off");
    if (field.fieldKind === "map") {
      this.memory += 6 * place + 2 * length;
      this.entry(field, end, levels - 1);
    } else if (field.message) {
      this.memory += place + ofEmpty(field.message);
      this.add(field.message, end, levels - 1);
    } else {
      this.memory += place + this.inside(field, length);
    }
    if (this.memory <= this.most) reader.pos = end;
  }

  /** Of a map. */
  private entry(field: DescField, end: number, levels: number): void {
    const { reader } = this;
    while (reader.pos < end && this.memory <= this.most) {
      const tag = this.varint();
      if (tag !== entryMessage || !field.message) {
        this.skip(tag & 7);
        continue;
      }
      const length = this.varint();
      const inner = reader.pos + length;
      if (inner > end) throw new RangeError("cut off");
      this.memory += place + ofEmpty(field.message);
      this.add(field.message, inner, levels - 1);
    }
  }

  /** Of text, bytes, or numbers in a row. */
  private inside(field: DescField, length: number): number {
    const scalar = field.scalar ?? ScalarType.INT32;
    if (scalar === ScalarType.STRING) return 40 + 2 * length;
    if (scalar === ScalarType.BYTES) return view;
    const each = place + (isLarge(scalar) ? ofNumber(scalar) : 0);
    const wire = wireOf(scalar);
    if (wire !== WireType.Varint) return view + each * length / (wire === WireType.Bit64 ? 8 : 4);
    let count = 0;
    for (let i = this.reader.pos, end = i + length; i < end; ++i) if (this.bytes[i] < 0x80) ++count;
    return each * count;
  }
}

function isAlwaysThere(field: DescField): boolean { return !field.oneof && !field.proto.proto3Optional; }

const fieldsByType = new WeakMap<DescMessage, Map<number, DescField>>();
export function fieldsOf(type: DescMessage): Map<number, DescField> {
  let fields = fieldsByType.get(type);
  if (!fields) fieldsByType.set(type, fields = new Map(type.fields.map((field) => [field.number, field])));
  return fields;
}
