// SPDX-License-Identifier: MIT
// The sky: a gradient from the horizon to the zenith, drawn last, where nothing else is.
import * as three from "three";

const vertexShader = `
  uniform vec3 middle;
  varying vec3 vWay;
  void main() {
    vec4 far = inverse(projectionMatrix * viewMatrix) * vec4(position.xy, 1.0, 1.0);
    vWay = far.xyz / far.w - middle;
    gl_Position = vec4(position.xy, 1.0, 1.0);
  }`;
const fragmentShader = `
  uniform vec3 horizon, zenith;
  varying vec3 vWay;
  void main() {
    float up = clamp(normalize(vWay).z, 0.0, 1.0);
    gl_FragColor = vec4(mix(horizon, zenith, sqrt(up)), 1.0);
    #include <colorspace_fragment>
  }`;

export class Sky {
  readonly mesh: three.Mesh<three.BufferGeometry, three.ShaderMaterial>;

  constructor() {
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    const uniforms = { middle: { value: new three.Vector3() }, horizon: { value: new three.Color() }, zenith: { value: new three.Color() } };
    this.mesh = new three.Mesh(geometry, new three.ShaderMaterial({ vertexShader, fragmentShader, uniforms, depthWrite: false }));
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 2; // after the opaque rest
    this.mesh.onBeforeRender = (_renderer, _scene, camera) => {
      uniforms.middle.value.setFromMatrixPosition(camera.matrixWorld);
      this.mesh.material.uniformsNeedUpdate = true;
    };
  }

  /** @param horizon, zenith  sRGB */
  setColors(horizon: number, zenith: number): void {
    this.mesh.material.uniforms["horizon"].value.set(horizon);
    this.mesh.material.uniforms["zenith"].value.set(zenith);
  }
}
