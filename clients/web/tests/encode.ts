// SPDX-License-Identifier: MIT
// Encodes messages by the schemas that the server advertises, for tests.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { create, createFileRegistry, fromBinary, toBinary } from "@bufbuild/protobuf";
import { FileDescriptorSetSchema } from "@bufbuild/protobuf/wkt";

const path = process.env["ZIGGURAT_SCHEMAS"];
if (!path) throw new Error("ZIGGURAT_SCHEMAS names no file; run ctest -R web/unit");
export const schema = new Uint8Array(readFileSync(path));
const registry = createFileRegistry(fromBinary(FileDescriptorSetSchema, schema));

export function encode(name: string, value: Record<string, unknown>): Uint8Array {
  const type = registry.getMessage(name);
  assert.ok(type, name);
  return toBinary(type, create(type, value));
}

/** A part again and again, as often as it fits into so many bytes. */
export function repeated(part: Uint8Array, bytes: number): Uint8Array {
  const all = new Uint8Array(Math.floor(bytes / part.length) * part.length);
  all.set(part);
  for (let filled = part.length; filled < all.length; filled *= 2) all.copyWithin(filled, 0, filled);
  return all;
}
