// SPDX-License-Identifier: MIT
// All copies of a shape as one mesh, each vertex placed and coloured by the row of its copy. Without graphics processor
// an instanced mesh takes about 20 us for each instance, as much as a draw call.
import * as three from "three";

const perRow = 256; // copies in a row of a texture
const mostVertices = 2_000_000;

/** So many copies and more, in whole rows. */
export function roomFor(copies: number): number { return Math.ceil(copies / perRow) * perRow; }

export function canMerge(shape: three.BufferGeometry, copies: number): boolean {
  return shape.getAttribute("position").count * copies <= mostVertices;
}

/** What an instanced mesh has as attributes is read from textures. @param colors  null: they do not matter */
export function readCopies(material: three.Material, matrices: three.DataTexture, colors: three.DataTexture | null): void {
  const before = material.onBeforeCompile;
  material.customProgramCacheKey = () => `merged ${before} ${colors !== null}`; // else all of these materials had one program
  material.onBeforeCompile = (shader, renderer) => {
    before.call(material, shader, renderer);
    shader.uniforms["matrices"] = { value: matrices };
    shader.uniforms["colors"] = { value: colors };
    shader.vertexShader = shader.vertexShader.replace("#include <common>", `#include <common>
      uniform highp sampler2D matrices;
      uniform highp sampler2D colors;
      attribute float copy;
      mat4 matrixOfCopy;
      #define USE_INSTANCING
      #define instanceMatrix matrixOfCopy`).replace("void main() {", `void main() {
        int number = int(copy);
        ivec2 place = ivec2(4 * (number % ${perRow}), number / ${perRow});
        matrixOfCopy = mat4(texelFetch(matrices, place, 0), texelFetch(matrices, place + ivec2(1, 0), 0),
                            texelFetch(matrices, place + ivec2(2, 0), 0), texelFetch(matrices, place + ivec2(3, 0), 0));`)
      .replace("#include <color_vertex>", colors === null ? "" : `#include <color_vertex>
        vColor.rgb = texelFetch(colors, ivec2(number % ${perRow}, number / ${perRow}), 0).rgb;`);
  };
}

function repeated(values: ArrayLike<number>, copies: number): Float32Array {
  const all = new Float32Array(values.length * copies);
  for (let i = 0; i < copies; ++i) all.set(values, i * values.length);
  return all;
}

export function mergedGeometry(shape: three.BufferGeometry, copies: number): three.BufferGeometry {
  const positions = shape.getAttribute("position"), vertices = positions.count;
  const merged = new three.BufferGeometry();
  merged.setAttribute("position", new three.BufferAttribute(repeated(positions.array, copies), 3));
  merged.setAttribute("normal", new three.BufferAttribute(repeated(shape.getAttribute("normal").array, copies), 3));
  const copy = new Float32Array(vertices * copies);
  for (let i = 0; i < copy.length; ++i) copy[i] = Math.floor(i / vertices);
  merged.setAttribute("copy", new three.BufferAttribute(copy, 1));
  const corners = shape.index ? Array.from(shape.index.array) : Array.from({ length: vertices }, (_, i) => i);
  const index = new Uint32Array(corners.length * copies);
  for (let i = 0; i < copies; ++i) {
    for (let k = 0; k < corners.length; ++k) index[i * corners.length + k] = i * vertices + corners[k];
  }
  merged.setIndex(new three.BufferAttribute(index, 1));
  return merged;
}

export class Merged {
  readonly mesh: three.Mesh;
  private readonly matrices: three.DataTexture;
  private readonly colors: three.DataTexture;
  private corners = 0; // of a copy

  /**
   * @param from  has the shape, and matrices with room as of roomFor()
   * @param colors  linear red, green, blue and 1 of as many copies
   */
  constructor(private readonly from: three.InstancedMesh, colors: Float32Array, material: three.MeshLambertMaterial) {
    const array = from.instanceMatrix.array as Float32Array;
    const rows = array.length / 16 / perRow;
    this.matrices = new three.DataTexture(array, 4 * perRow, rows, three.RGBAFormat, three.FloatType);
    this.colors = new three.DataTexture(colors, perRow, rows, three.RGBAFormat, three.FloatType);
    material.vertexColors = true;
    readCopies(material, this.matrices, this.colors);
    this.mesh = new three.Mesh(this.geometry(), material);
    this.mesh.castShadow = this.mesh.receiveShadow = true;
    this.mesh.frustumCulled = false;
    const depth = new three.MeshDepthMaterial({ depthPacking: three.RGBADepthPacking });
    readCopies(depth, this.matrices, null);
    this.mesh.customDepthMaterial = depth;
  }

  private geometry(): three.BufferGeometry {
    const copies = this.from.instanceMatrix.count;
    const geometry = mergedGeometry(this.from.geometry, copies);
    this.corners = geometry.index!.count / copies;
    return geometry;
  }

  /** The shape has changed. */
  shapeChanges(): void {
    this.mesh.geometry.dispose();
    this.mesh.geometry = this.geometry();
  }

  /** Draws the first copies; their matrices and colours have changed. */
  show(copies: number): void {
    this.mesh.visible = copies > 0;
    this.mesh.geometry.setDrawRange(0, copies * this.corners);
    if (copies > 0) this.matrices.needsUpdate = this.colors.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.removeFromParent();
    this.mesh.geometry.dispose();
    this.mesh.customDepthMaterial?.dispose();
    this.matrices.dispose();
    this.colors.dispose();
  }
}
