// SPDX-License-Identifier: MIT
// Detail of a link by its size on the screen: all of its parts, its round shapes with few sides, or a box.

export const enum Detail { box, plain, whole, none = 255 }

/** Sizes on the screen from which on a link has more than a box, and all there is of it [px]. */
export interface Thresholds { plain: number; whole: number }

export const ofProcessor: Thresholds = { plain: 12, whole: 56 };
export const ofGraphicsProcessor: Thresholds = { plain: 5, whole: 24 };
export const ofPictureAtRest: Thresholds = { plain: 4, whole: 14 };

/**
 * The size of a sphere on the screen [px].
 * @param depth  of its centre before the camera [m], @param scale  pixels of a metre at a depth of one metre
 */
export function sizeOnScreen(radius: number, depth: number, scale: number): number {
  return depth > radius ? 2 * radius * scale / depth : Infinity;
}

export function detailOf(pixels: number, { plain, whole }: Thresholds): Detail {
  return pixels >= whole ? Detail.whole : pixels >= plain ? Detail.plain : Detail.box;
}

/** What a camera sees: planes of a frustum in world coordinates, four numbers each, with normals that look inwards. */
export function isInside(planes: Float64Array, x: number, y: number, z: number, radius: number): boolean {
  for (let i = 0; i < planes.length; i += 4) {
    if (planes[i] * x + planes[i + 1] * y + planes[i + 2] * z + planes[i + 3] < -radius) return false;
  }
  return true;
}
