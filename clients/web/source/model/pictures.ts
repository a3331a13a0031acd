// SPDX-License-Identifier: MIT
// Pictures of cameras are files of PNG, which say in their first bytes how large they are.

const signature = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]; // then the size of the header, IHDR, width and height

/** Whether a file is a picture of the camera's size: a small file could take gigabytes when it is decoded. */
export function isPictureOf(file: Uint8Array, { width, height }: { width: number; height: number }): boolean {
  if (file.length < 24 || !signature.every((byte, i) => file[i] === byte)) return false;
  const header = new DataView(file.buffer, file.byteOffset, 24);
  return header.getUint32(12) === 0x49484452 && header.getUint32(16) === width && header.getUint32(20) === height;
}
