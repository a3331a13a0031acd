// SPDX-License-Identifier: MIT
// Decodes any message whose schema a channel advertises. Descriptors and wire format are
// @bufbuild/protobuf's, which needs no generated code and no eval(), so that the page runs under a strict
// content security policy. Packed floats become typed arrays at once: poses of thousands of links are
// most of what is decoded.
import {
  createFileRegistry, fromBinary, ScalarType,
  type DescField, type DescMessage, type Registry,
} from "@bufbuild/protobuf";
import { BinaryReader, WireType } from "@bufbuild/protobuf/wire";
import { FileDescriptorSetSchema } from "@bufbuild/protobuf/wkt";
import type { Value } from "./source";

const mostBytes = 128 * 1024 * 1024; // of a message

/** What is wrong with a message, as the end of a sentence that begins with it. */
export class Unreadable extends Error {}

/** What a message says. @throws Unreadable if it is too long, or damaged */
export type Decoder = (bytes: Uint8Array) => Value;

/**
 * @param schema  a FileDescriptorSet
 * @param name  of the type, with its package
 * @throws Error if the schema does not have the type
 */
export function makeDecoder(schema: Uint8Array, name: string): Decoder {
  const registry: Registry = createFileRegistry(fromBinary(FileDescriptorSetSchema, schema));
  const type = registry.getMessage(name);
  if (!type) throw new Error(`the schema has no type ${name}`);
  return (bytes) => {
    if (bytes.length > mostBytes) throw new Unreadable(`has ${bytes.length} bytes; at most ${mostBytes} are read`);
    try {
      return decodeMessage(type, new BinaryReader(bytes), bytes.length);
    } catch {
      throw new Unreadable("is damaged");
    }
  };
}

/** As a value stands in a message by itself. */
function wireOf(scalar: ScalarType): WireType {
  switch (scalar) {
    case ScalarType.DOUBLE: case ScalarType.FIXED64: case ScalarType.SFIXED64: return WireType.Bit64;
    case ScalarType.FLOAT: case ScalarType.FIXED32: case ScalarType.SFIXED32: return WireType.Bit32;
    case ScalarType.STRING: case ScalarType.BYTES: return WireType.LengthDelimited;
    default: return WireType.Varint;
  }
}

/** The same of a field. Whether its numbers stand in a row: isPacked(). Others are unknown, and skipped. */
function fits(field: DescField, wire: WireType): boolean {
  if (field.message || field.fieldKind === "map") return wire === WireType.LengthDelimited;
  return wire === wireOf(field.scalar ?? ScalarType.INT32) || isPacked(field, wire);
}

function isPacked(field: DescField, wire: WireType): boolean {
  return field.fieldKind === "list" && !field.message && wire === WireType.LengthDelimited
      && wireOf(field.scalar ?? ScalarType.INT32) !== WireType.LengthDelimited;
}

const fieldsByType = new WeakMap<DescMessage, Map<number, DescField>>();
function fieldsOf(type: DescMessage): Map<number, DescField> {
  let fields = fieldsByType.get(type);
  if (!fields) fieldsByType.set(type, fields = new Map(type.fields.map((field) => [field.number, field])));
  return fields;
}

type Empty = [string, () => unknown][]; // what absent fields without presence are
const empties = new WeakMap<DescMessage, Empty>();

function emptyOf(type: DescMessage): Empty {
  let empty = empties.get(type);
  if (empty) return empty;
  empty = [];
  for (const field of type.fields) {
    const value = emptyValue(field);
    if (value !== undefined) empty.push([field.localName, value]);
  }
  empties.set(type, empty);
  return empty;
}

function emptyValue(field: DescField): (() => unknown) | undefined {
  if (field.fieldKind === "map") return () => ({});
  if (field.fieldKind === "list") return () => [];
  if (field.fieldKind === "message" || field.oneof || field.proto.proto3Optional) return undefined;
  if (field.fieldKind === "enum") return () => 0;
  switch (field.scalar) {
    case ScalarType.STRING: return () => "";
    case ScalarType.BYTES: return () => new Uint8Array(0);
    case ScalarType.BOOL: return () => false;
    default: return () => 0;
  }
}

function decodeMessage(type: DescMessage, reader: BinaryReader, end: number): Value {
  const fields = fieldsOf(type);
  const value: Value = {};
  for (const [name, make] of emptyOf(type)) value[name] = make();
  while (reader.pos < end) {
    const [number, wire] = reader.tag();
    const field = fields.get(number);
    if (!field || !fits(field, wire)) {
      reader.skip(wire, number);
      continue;
    }
    const name = field.localName;
    if (field.fieldKind === "list") value[name] = readList(field, reader, wire, value[name] as unknown[]);
    else if (field.fieldKind === "map") readEntry(field, reader, value[name] as Value);
    else value[name] = readOne(field, reader);
  }
  if (reader.pos > end) throw new RangeError("a part is longer than what it is in");
  return value;
}

function readOne(field: DescField, reader: BinaryReader): unknown {
  if (field.message && field.fieldKind !== "map") {
    const end = reader.uint32() + reader.pos;
    return decodeMessage(field.message, reader, end);
  }
  return readScalar(field.scalar ?? ScalarType.INT32, reader);
}

function readList(field: DescField, reader: BinaryReader, wire: WireType, list: unknown[]): unknown {
  const scalar = field.scalar ?? (field.enum ? ScalarType.INT32 : undefined);
  if (scalar === undefined || !isPacked(field, wire)) {
    list.push(readOne(field, reader));
    return list;
  }
  if ((scalar === ScalarType.FLOAT || scalar === ScalarType.DOUBLE) && list.length === 0) {
    return readFloats(scalar, reader.bytes());
  }
  const end = reader.uint32() + reader.pos;
  const all = Array.isArray(list) ? list : Array.from(list as ArrayLike<unknown>);
  while (reader.pos < end) all.push(readScalar(scalar, reader));
  return all;
}

/** Little endian on the wire, as in every browser's typed arrays. */
function readFloats(scalar: ScalarType, bytes: Uint8Array): Float32Array | Float64Array {
  const own = bytes.slice().buffer; // aligned
  return scalar === ScalarType.FLOAT ? new Float32Array(own) : new Float64Array(own);
}

function readEntry(field: DescField & { fieldKind: "map" }, reader: BinaryReader, map: Value): void {
  const end = reader.uint32() + reader.pos;
  let key: unknown = "";
  let value: unknown;
  while (reader.pos < end) {
    const [number, wire] = reader.tag();
    if (number === 1 && wire === wireOf(field.mapKey)) {
      key = readScalar(field.mapKey, reader);
    } else if (number === 2 && field.message && wire === WireType.LengthDelimited) {
      const inner = reader.uint32() + reader.pos;
      value = decodeMessage(field.message, reader, inner);
    } else if (number === 2 && !field.message && wire === wireOf(field.scalar ?? ScalarType.INT32)) {
      value = readScalar(field.scalar ?? ScalarType.INT32, reader);
    } else {
      reader.skip(wire, number);
    }
  }
  map[String(key)] = value;
}

/** 64-bit integers become numbers where these are exact. */
function narrow(value: bigint | string): number | bigint {
  const big = BigInt(value);
  const small = Number(big);
  return Number.isSafeInteger(small) ? small : big;
}

function readScalar(scalar: ScalarType, reader: BinaryReader): unknown {
  switch (scalar) {
    case ScalarType.DOUBLE: return reader.double();
    case ScalarType.FLOAT: return reader.float();
    case ScalarType.STRING: return reader.string();
    case ScalarType.BYTES: return reader.bytes();
    case ScalarType.BOOL: return reader.bool();
    case ScalarType.UINT32: return reader.uint32();
    case ScalarType.INT32: return reader.int32();
    case ScalarType.SINT32: return reader.sint32();
    case ScalarType.FIXED32: return reader.fixed32();
    case ScalarType.SFIXED32: return reader.sfixed32();
    case ScalarType.UINT64: return narrow(reader.uint64());
    case ScalarType.INT64: return narrow(reader.int64());
    case ScalarType.SINT64: return narrow(reader.sint64());
    case ScalarType.FIXED64: return narrow(reader.fixed64());
    case ScalarType.SFIXED64: return narrow(reader.sfixed64());
  }
}
