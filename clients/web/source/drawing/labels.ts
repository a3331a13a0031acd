// SPDX-License-Identifier: MIT
// Texts that robots drew: sprites of one size on the screen, kept by what they say.
import * as three from "three";
import type { Marker } from "../model/messages";
import { transform, type Pose } from "../model/pose";

const mostLabels = 500; // of one frame
const height = 0.035; // of the screen's

export class Labels {
  readonly group = new three.Group();
  private readonly materials = new Map<string, { material: three.SpriteMaterial; ratio: number }>();

  /** @param originOf  X_WE of a robot's origin */
  show(markers: Marker[], originOf: (robot: number) => Pose | null): void {
    const texts = markers.filter((marker) => marker.text !== "").slice(0, mostLabels);
    while (this.group.children.length > texts.length) this.group.remove(this.group.children.at(-1)!);
    if (texts.length === 0 || this.materials.size > 2 * mostLabels) this.forget();
    texts.forEach(({ robot, at, text, color }, i) => {
      const origin = originOf(robot);
      let sprite = this.group.children[i] as three.Sprite | undefined;
      if (!sprite) this.group.add(sprite = new three.Sprite());
      sprite.visible = origin !== null;
      if (!origin) return;
      const { material, ratio } = this.materialOf(text, color);
      sprite.material = material;
      sprite.scale.set(height * ratio, height, 1);
      sprite.position.set(...transform(origin, [at[0], at[1], at[2]]));
    });
  }

  private materialOf(text: string, color: number): { material: three.SpriteMaterial; ratio: number } {
    const key = `${color} ${text}`;
    let made = this.materials.get(key);
    if (!made) {
      const canvas = document.createElement("canvas");
      const size = 48; // [px]
      const font = `${0.75 * size}px sans-serif`;
      const context = canvas.getContext("2d")!;
      context.font = font;
      canvas.width = Math.min(2048, Math.ceil(context.measureText(text).width) + 8);
      canvas.height = size;
      context.font = font; // a new size forgets it
      context.textBaseline = "middle";
      context.fillStyle = `#${(color & 0xffffff).toString(16).padStart(6, "0")}`;
      context.fillText(text, 4, size / 2);
      const map = new three.CanvasTexture(canvas);
      map.colorSpace = three.SRGBColorSpace;
      made = {
        material: new three.SpriteMaterial({ map, sizeAttenuation: false, depthTest: false }),
        ratio: canvas.width / size,
      };
      this.materials.set(key, made);
    }
    return made;
  }

  private forget(): void {
    for (const { material } of this.materials.values()) {
      material.map?.dispose();
      material.dispose();
    }
    this.materials.clear();
  }
}
