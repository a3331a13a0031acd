// SPDX-License-Identifier: MIT
declare module "lz4js" {
  /** Decompresses a frame. @param most  bytes that come out at most */
  export function decompress(frame: Uint8Array, most?: number): Uint8Array;
  /** A frame. */
  export function compress(bytes: Uint8Array): Uint8Array;
}
