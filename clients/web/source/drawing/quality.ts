// How finely the picture is drawn. It adapts to the machine: where drawing is slow, as without a graphics
// processor, it takes fewer pixels and harder shadows before it drops frames.
import * as three from "three";

interface Level { pixels: number; shadowSize: number; shadows: three.ShadowMapType | null }

/** From best to fastest; pixels are drawn ones per pixel of the screen, along each side. */
export const levels: Level[] = [
  { pixels: 2, shadowSize: 2048, shadows: three.PCFSoftShadowMap },
  { pixels: 1, shadowSize: 2048, shadows: three.PCFSoftShadowMap },
  { pixels: 1, shadowSize: 1024, shadows: three.BasicShadowMap },
  { pixels: 0.7, shadowSize: 1024, shadows: three.BasicShadowMap },
  { pixels: 0.5, shadowSize: 512, shadows: three.BasicShadowMap },
  { pixels: 0.5, shadowSize: 512, shadows: null },
];
const slow = 0.05, quick = 0.012; // [s] a frame
const patience = 12; // frames

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
    if (++this.count < patience) return false;
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

/** Pieces around a round shape, with so many shapes in the world. */
export function roundness(count: number): number {
  return count > 2000 ? 12 : count > 300 ? 20 : 36;
}
