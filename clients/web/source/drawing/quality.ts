// SPDX-License-Identifier: MIT
// How finely the picture is drawn. It adapts to the machine: where drawing is slow, as without a graphics
// processor, it takes fewer pixels and harder shadows before it drops frames.
import * as three from "three";

interface Level {
  pixels: number; // drawn ones per pixel of the screen, along each side
  shadowSize: number; // of the shadow map, along each side
  shadows: three.ShadowMapType | null;
  triangles: number; // of all round shapes, about: processors take a microsecond or two for each
}

/** From best to fastest. */
export const levels: Level[] = [
  { pixels: 2, shadowSize: 2048, shadows: three.PCFSoftShadowMap, triangles: 1_000_000 },
  { pixels: 1, shadowSize: 2048, shadows: three.PCFSoftShadowMap, triangles: 1_000_000 },
  { pixels: 1, shadowSize: 1024, shadows: three.BasicShadowMap, triangles: 30_000 },
  { pixels: 0.7, shadowSize: 1024, shadows: three.BasicShadowMap, triangles: 30_000 },
  { pixels: 0.5, shadowSize: 512, shadows: three.BasicShadowMap, triangles: 30_000 },
  { pixels: 0.5, shadowSize: 1024, shadows: null, triangles: 10_000 },
];
const slow = 0.035, quick = 0.012; // [s] a frame
const patience = 12; // frames
const longestPatience = 1.5; // [s]

/** Whether frames are drawn by the processor. */
export function isSoftware(context: WebGLRenderingContext | WebGL2RenderingContext): boolean {
  const names = context.getExtension("WEBGL_debug_renderer_info");
  const name = names ? String(context.getParameter(names.UNMASKED_RENDERER_WEBGL)) : "";
  return /swiftshader|llvmpipe|softpipe|software/i.test(name);
}

/** Decides the level by how long frames take. */
export class Quality {
  private seconds = 0;
  private count = 0;
  private rises = 0;

  constructor(public level: number, private readonly best = 0) {}

  /** Notes a frame; true if the level changed. */
  note(seconds: number): boolean {
    this.seconds += Math.min(seconds, 1);
    if (++this.count < patience && this.seconds < longestPatience) return false;
    const mean = this.seconds / this.count;
    this.seconds = this.count = 0;
    if (mean > slow && this.level < levels.length - 1) {
      ++this.level;
      return true;
    }
    if (mean < quick && this.level > this.best && this.rises < 2) {
      ++this.rises; // so that it does not swing forever
      --this.level;
      return true;
    }
    return false;
  }
}

/** Pieces around a round shape: as many as give no more than so many triangles with so many shapes. */
export function roundness(shapes: number, triangles: number): number {
  const pieces = [36, 28, 20, 16, 12, 8];
  // A ball of n pieces has n * n triangles, a cylinder 4 n.
  return pieces.find((n) => shapes * n * n <= triangles) ?? 6;
}
