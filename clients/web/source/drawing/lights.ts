// SPDX-License-Identifier: MIT
// LEDs: discs that glow in their colour, all in one call and seen from far; directional ones also as cones of light.
import * as three from "three";
import { Kind, type Led, type Poses, type World } from "../model/messages";
import { packed, place } from "../model/pose";
import { Detail } from "./detail";
import { writeMatrix } from "./matrix";

const radius = 0.004; // [m]
const glowRadius = 6; // of the glow, in radii of the disc
const nearer = 0.15; // one that stands for a robot is drawn so much nearer, so that the robot does not hide it [m]
const leastPixels = 2.5; // of a disc that is lit
const longestCone = 0.02; // [m]
const widestCone = 0.9; // half-angle [rad]: wider ones would hide what they shine on
const unlit = new three.Color(0x3a3d42);

// A point has room for the glow; one that is off is as large as its disc. Very far ones share a pixel.
const vertexShader = `
  attribute vec4 color;  // its last is 0 if it is off, 1 if it is lit, 2 if it is a lamp or stands for all of a robot that is far
  uniform float pixels;  // of a metre at a depth of one metre
  uniform float least;
  varying vec4 vColor;
  varying float vPart;  // of the point, that is the disc
  void main() {
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    gl_Position = projectionMatrix * seen;
    float disc = 2.0 * ${radius} * pixels / -seen.z;
    float core = color.a > 1.5 ? max(4.0 * disc, 1.4 * least) : color.a > 0.5 ? max(disc, least) : disc;
    if (color.a > 1.5) gl_Position = projectionMatrix * vec4(seen.xyz * max(1.0 + ${nearer} / seen.z, 0.5), 1.0);
    float whole = color.a > 0.5 ? max(${glowRadius}.0 * disc, 1.6 * core) : disc;
    vColor = vec4(color.rgb, min(color.a, 1.0)); vPart = core / whole;
    gl_PointSize = whole;
    if (whole < 0.7) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  }`;
// Colours that are multiplied by their opacity: the disc hides, the glow adds.
const fragmentShader = `
  varying vec4 vColor;
  varying float vPart;
  void main() {
    float r = 2.0 * length(gl_PointCoord - 0.5);
    if (r > 1.0) discard;
    float core = smoothstep(1.0, 0.7, r / vPart);
    float glow = (1.0 - r) * (1.0 - r) * 0.75 * vColor.a;
    vec3 light = mix(vColor.rgb, vec3(1.0), 0.35 * vColor.a * smoothstep(0.8, 0.0, r / vPart));
    gl_FragColor = vec4(light * core + vColor.rgb * glow * (1.0 - core), max(core, 0.4 * glow));
    #include <colorspace_fragment>
  }`;

export class Lights {
  readonly group = new three.Group();
  private cones: three.InstancedMesh | null = null;
  private readonly points: three.Points<three.BufferGeometry, three.ShaderMaterial>;
  private positions = new Float32Array(0);
  private colors = new Float32Array(0);
  private world: World | null = null;
  private mounts = new Float64Array(0); // of LEDs, then of directional ones
  private readonly pose = new Float64Array(7);
  private readonly color = new three.Color();

  constructor() {
    const material = new three.ShaderMaterial({
      vertexShader, fragmentShader, uniforms: { pixels: { value: 1 }, least: { value: leastPixels } },
      transparent: true, depthWrite: false, blending: three.CustomBlending, blendSrc: three.OneFactor,
      blendDst: three.OneMinusSrcAlphaFactor });
    this.points = new three.Points(new three.BufferGeometry(), material);
    this.points.frustumCulled = false;
    this.points.onBeforeRender = (renderer, _, camera) => {
      const target = renderer.getRenderTarget();
      const height = target ? target.height : renderer.domElement.height;
      material.uniforms["pixels"].value = 0.5 * height * camera.projectionMatrix.elements[5];
      material.uniforms["least"].value = leastPixels * (target ? 1 : renderer.getPixelRatio());
    };
  }

  setWorld(world: World): void {
    this.world = world;
    this.group.clear();
    this.cones?.dispose();
    this.cones = null;
    const count = world.leds.length + world.directionalLeds.length;
    this.mounts = packed([...world.leds, ...world.directionalLeds].map(({ mount }) => mount));
    if (count === 0) return;
    this.positions = new Float32Array(3 * count);
    this.colors = new Float32Array(4 * count);
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(this.positions, 3).setUsage(three.DynamicDrawUsage));
    geometry.setAttribute("color", new three.BufferAttribute(this.colors, 4).setUsage(three.DynamicDrawUsage));
    this.points.geometry.dispose();
    this.points.geometry = geometry;
    this.group.add(this.points);
    if (world.directionalLeds.length > 0) {
      const cone = new three.ConeGeometry(1, 1, 32, 1, true).rotateX(-Math.PI / 2).translate(0, 0, 0.5);
      this.cones = new three.InstancedMesh(cone, new three.MeshBasicMaterial(
        { transparent: true, opacity: 0.12, side: three.DoubleSide, depthWrite: false }), world.directionalLeds.length);
      this.cones.frustumCulled = false;
      this.group.add(this.cones);
    }
  }

  /**
   * Of robots that are far, LEDs of one colour are one point; those that are off are not seen.
   * @param details  of entities, as Bodies has them
   */
  setPoses(poses: Poses, details: Uint8Array): void {
    const { world, cones, points, pose, color } = this;
    if (!world || this.mounts.length === 0) return;
    let count = 0, entityBefore = -1, colorBefore = -1;
    world.leds.forEach((led, i) => {
      const rgb = poses.ledColors[i] ?? 0, detail = details[led.entity];
      if (detail === Detail.none) return;
      const isFar = detail === Detail.box;
      if (isFar && (rgb === 0 || (led.entity === entityBefore && rgb === colorBefore))) return;
      entityBefore = led.entity;
      colorBefore = rgb;
      this.place(led, i, rgb, poses, count++, isFar || world.entities[led.entity].kind === Kind.light ? 2 : 1);
    });
    world.directionalLeds.forEach((led, i) => {
      const rgb = poses.directionalLedColors[i] ?? 0, isThere = details[led.entity] !== Detail.none;
      if (isThere) this.place(led, world.leds.length + i, rgb, poses, count++, 1);
      const length = rgb !== 0 && isThere ? longestCone : 0;
      const wide = length * Math.tan(Math.min(led.observableAngle, widestCone));
      writeMatrix(cones!.instanceMatrix.array, 16 * i, pose, wide, wide, length);
      cones!.setColorAt(i, color.set(rgb));
    });
    if (cones) {
      cones.instanceMatrix.needsUpdate = true;
      if (cones.instanceColor) cones.instanceColor.needsUpdate = true;
    }
    points.geometry.setDrawRange(0, count);
    points.visible = count > 0;
    for (const name of ["position", "color"]) {
      const attribute = points.geometry.getAttribute(name) as three.BufferAttribute;
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, count * attribute.itemSize);
      attribute.needsUpdate = true;
    }
  }

  /** Places an LED as the point `at`, and leaves its pose in `pose`. */
  private place({ mount }: Led, index: number, rgb: number, poses: Poses, at: number, lit: number): void {
    const { pose, color, positions, colors } = this;
    place(pose, poses.positions, poses.orientations, mount.link, this.mounts, 7 * index);
    const { r, g, b } = rgb === 0 ? unlit : color.set(rgb);
    const p = 3 * at, c = 4 * at;
    positions[p] = pose[0]; positions[p + 1] = pose[1]; positions[p + 2] = pose[2];
    colors[c] = r; colors[c + 1] = g; colors[c + 2] = b; colors[c + 3] = rgb === 0 ? 0 : lit;
  }
}
