// All copies of a shape as one mesh, each vertex placed by the matrix of its copy. Without graphics processor
// an instanced mesh takes about 20 us for each instance, as much as a draw call.
import * as three from "three";

const perRow = 256; // matrices in a row of the texture
const mostVertices = 2_000_000;

/** So many matrices and more, in whole rows. */
export function roomFor(copies: number): number { return Math.ceil(copies / perRow) * perRow; }

export function canMerge(shape: three.BufferGeometry, copies: number): boolean {
  return shape.getAttribute("position").count * copies <= mostVertices;
}

/** What an instanced mesh has as an attribute is read from the texture `matrices`. */
export function readMatrices(material: three.Material, matrices: three.DataTexture): void {
  const before = material.onBeforeCompile;
  material.customProgramCacheKey = () => `merged ${before}`; // else all of these materials had one program
  material.onBeforeCompile = (shader, renderer) => {
    before.call(material, shader, renderer);
    shader.uniforms["matrices"] = { value: matrices };
    shader.vertexShader = shader.vertexShader.replace("#include <common>", `#include <common>
      uniform highp sampler2D matrices;
      attribute float copy;
      mat4 matrixOfCopy;
      #define USE_INSTANCING
      #define instanceMatrix matrixOfCopy`).replace("void main() {", `void main() {
        ivec2 place = ivec2(4 * (int(copy) % ${perRow}), int(copy) / ${perRow});
        matrixOfCopy = mat4(texelFetch(matrices, place, 0), texelFetch(matrices, place + ivec2(1, 0), 0),
                            texelFetch(matrices, place + ivec2(2, 0), 0), texelFetch(matrices, place + ivec2(3, 0), 0));`);
  };
}

function repeated(values: ArrayLike<number>, copies: number): Float32Array {
  const all = new Float32Array(values.length * copies);
  for (let i = 0; i < copies; ++i) all.set(values, i * values.length);
  return all;
}

/** @param colors  linear red, green and blue of each copy */
export function mergedGeometry(shape: three.BufferGeometry, copies: number, colors: ArrayLike<number>): three.BufferGeometry {
  const positions = shape.getAttribute("position"), vertices = positions.count;
  const merged = new three.BufferGeometry();
  merged.setAttribute("position", new three.BufferAttribute(repeated(positions.array, copies), 3));
  merged.setAttribute("normal", new three.BufferAttribute(repeated(shape.getAttribute("normal").array, copies), 3));
  const copy = new Float32Array(vertices * copies), color = new Float32Array(3 * copy.length);
  for (let i = 0; i < copy.length; ++i) {
    copy[i] = Math.floor(i / vertices);
    for (let k = 0; k < 3; ++k) color[3 * i + k] = colors[3 * copy[i] + k];
  }
  merged.setAttribute("copy", new three.BufferAttribute(copy, 1));
  merged.setAttribute("color", new three.BufferAttribute(color, 3));
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

  /** @param from  has the shape, the colours, and room for matrices as of roomFor() */
  constructor(private readonly from: three.InstancedMesh, material: three.MeshLambertMaterial) {
    const array = from.instanceMatrix.array as Float32Array;
    this.matrices = new three.DataTexture(array, 4 * perRow, array.length / 16 / perRow, three.RGBAFormat, three.FloatType);
    material.vertexColors = true;
    readMatrices(material, this.matrices);
    this.mesh = new three.Mesh(this.geometry(), material);
    this.mesh.castShadow = this.mesh.receiveShadow = true;
    this.mesh.frustumCulled = false;
    const depth = new three.MeshDepthMaterial({ depthPacking: three.RGBADepthPacking });
    readMatrices(depth, this.matrices);
    this.mesh.customDepthMaterial = depth;
  }

  private geometry(): three.BufferGeometry {
    return mergedGeometry(this.from.geometry, this.from.count, this.from.instanceColor!.array);
  }

  /** The shape has changed. */
  shapeChanges(): void {
    this.mesh.geometry.dispose();
    this.mesh.geometry = this.geometry();
  }

  /** The matrices have changed. */
  matricesChange(): void { this.matrices.needsUpdate = true; }

  dispose(): void {
    this.mesh.removeFromParent();
    this.mesh.geometry.dispose();
    this.mesh.customDepthMaterial?.dispose();
    this.matrices.dispose();
  }
}
