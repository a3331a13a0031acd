// SPDX-License-Identifier: MIT
// Compression of chunks, by other libraries than the server's.
import lz4 from "@foxglove/wasm-lz4";
import zstd from "@foxglove/wasm-zstd";

export async function loadDecompressHandlers() {
  await Promise.all([zstd.isLoaded, lz4.isLoaded]);
  return {
    zstd: (bytes, size) => new Uint8Array(zstd.decompress(bytes, Number(size))),
    lz4: (bytes, size) => new Uint8Array(lz4(bytes, Number(size))),
  };
}
