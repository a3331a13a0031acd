// SPDX-License-Identifier: MIT
// Coloured line segments that change at every frame, in one draw call.
import * as three from "three";

export class Lines {
  readonly object: three.LineSegments;
  private positions = new Float32Array(6 * 256);
  private colors = new Float32Array(8 * 256);
  private count = 0;

  constructor(isOnTop = false) {
    const material = new three.LineBasicMaterial({ vertexColors: true, transparent: true, depthTest: !isOnTop });
    this.object = new three.LineSegments(new three.BufferGeometry(), material);
    this.object.frustumCulled = false;
    this.attach();
  }

  private attach(): void {
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(this.positions, 3).setUsage(three.DynamicDrawUsage));
    geometry.setAttribute("color", new three.BufferAttribute(this.colors, 4).setUsage(three.DynamicDrawUsage));
    this.object.geometry.dispose();
    this.object.geometry = geometry;
  }

  clear(): void { this.count = 0; }

  /**
   * A segment [m]. @param color  0xRRGGBB, @param opacity  0 to 1 at both ends
   * @param atA, atB  where the three coordinates begin
   */
  add(a: ArrayLike<number>, b: ArrayLike<number>, color: number, opacity = 1, opacityAtEnd = opacity, atA = 0, atB = 0): void {
    if (6 * (this.count + 1) > this.positions.length) this.grow();
    const p = 6 * this.count, c = 8 * this.count;
    for (let i = 0; i < 3; ++i) {
      this.positions[p + i] = a[atA + i];
      this.positions[p + 3 + i] = b[atB + i];
      const part = ((color >> (16 - 8 * i)) & 255) / 255;
      this.colors[c + i] = this.colors[c + 4 + i] = part * part; // about linear light
    }
    this.colors[c + 3] = opacity;
    this.colors[c + 7] = opacityAtEnd;
    ++this.count;
  }

  private grow(): void {
    const { positions, colors } = this;
    this.positions = new Float32Array(2 * positions.length);
    this.colors = new Float32Array(2 * colors.length);
    this.positions.set(positions);
    this.colors.set(colors);
    this.attach();
  }

  /** An arrow: a shaft and four barbs. */
  arrow(a: three.Vector3, way: three.Vector3, color: number, opacity = 1): void {
    const end = a.clone().add(way);
    this.add(a.toArray(), end.toArray(), color, opacity);
    const side = new three.Vector3(way.y, -way.x, 0);
    if (side.lengthSq() < 1e-6 * way.lengthSq()) side.set(1, 0, 0);
    side.setLength(0.1 * way.length());
    const other = side.clone().cross(way).setLength(side.length());
    for (const barb of [side, other, side.clone().negate(), other.clone().negate()]) {
      this.add(end.toArray(), end.clone().addScaledVector(way, -0.25).add(barb).toArray(), color, opacity);
    }
  }

  commit(): void {
    this.object.geometry.setDrawRange(0, 2 * this.count);
    for (const name of ["position", "color"]) this.object.geometry.getAttribute(name).needsUpdate = true;
  }
}
