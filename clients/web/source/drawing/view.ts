// SPDX-License-Identifier: MIT
// The picture of one frame: everything that is drawn, layer by layer.
import * as three from "three";
import type { Contacts, Poses, RadioTraffic, Rays, World } from "../model/messages";
import { Motion } from "../model/motion";
import type { Pose, Vector } from "../model/pose";
import type { Frame, Frames } from "../model/timeline";
import { Bodies } from "./bodies";
import { colorOf, type Coloring } from "./colors";
import { Floor } from "./floor";
import { arenaOf, boxOf, firstBox, Settling } from "./framing";
import { Lights } from "./lights";
import { Lines } from "./lines";
import { Labels } from "./labels";
import {
  drawContacts, drawFrusta, drawMagnets, drawMarkers, drawRays, drawRuler, drawSelection, drawTrail, RadioFlashes, typicalSize,
} from "./overlays";
import { Shade } from "./shade";
import { Stage } from "./stage";
import { Tags } from "./tags";
import { originIn, Trails } from "./trails";

/** Layers, with the key that switches each and the topic that it needs. */
export const layers = [
  { name: "bodies", label: "Bodies", key: "1" },
  { name: "shadows", label: "Shadows", key: "2" },
  { name: "tags", label: "Tags", key: "3" },
  { name: "lights", label: "LEDs", key: "4" },
  { name: "magnets", label: "Magnets", key: "5" },
  { name: "frusta", label: "Frusta", key: "6" },
  { name: "rays", label: "Rays", key: "7", topic: "/rays" },
  { name: "radio", label: "Radio", key: "8", topic: "/radio" },
  { name: "contacts", label: "Contacts", key: "9", topic: "/contacts" },
  { name: "trails", label: "Trails", key: "0" },
  { name: "marks", label: "Scale, axes", key: "z" },
  { name: "everyone", label: "Rays, radio of all", key: "x" },
] as const;
export type Layer = (typeof layers)[number]["name"];
/** With more robots than this, what robots do is shown of the selected one only, unless the layer of all is on. */
export const mostRobotsAtOnce = 12;
export const layersAtFirst: Layer[] = ["bodies", "shadows", "tags", "lights", "rays", "radio", "trails", "marks"];

/** Whether two frames of one world look the same, lines aside. */
function isSame(a: Poses, b: Poses): boolean {
  const same = (x: ArrayLike<number>, y: ArrayLike<number>): boolean => {
    if (x.length !== y.length) return false;
    for (let i = 0; i < x.length; ++i) if (x[i] !== y[i]) return false;
    return true;
  };
  return a.tagPayloads.length === 0 && b.tagPayloads.length === 0 && same(a.positions, b.positions)
      && same(a.orientations, b.orientations) && same(a.ledColors, b.ledColors)
      && same(a.directionalLedColors, b.directionalLedColors) && same(a.magnetMoments, b.magnetMoments)
      && same(a.floorPaints ?? [], b.floorPaints ?? []);
}

const longestGap = 100; // frames between two points of a trail
const oneStep = 0.15; // [s], for which a tick of a paused world moves at most
const longestMotion = 2; // [s], of ticks in slow motion
const slowRate = 30; // frames a second without graphics processor: others need the processor, too
const restAfter = 0.4; // [s] without change, the picture is drawn once with all pixels

export class View {
  readonly stage: Stage;
  private readonly bodies: Bodies;
  private readonly floor = new Floor(() => { this.stage.isDirty = true; });
  private readonly tags = new Tags();
  private readonly lights = new Lights();
  private readonly lines = new Lines();
  private readonly inside = new Lines(true); // seen through bodies
  private readonly flashes = new RadioFlashes();
  private readonly labels = new Labels(); // texts that robots drew
  private world: World | null = null;
  private frame: Frame | null = null;
  drawn: Frame | null = null; // of the last picture that was asked for
  private readonly shade = new Shade();
  readonly motion = new Motion();
  private readonly trails = new Trails();
  private seenAt: { id: string; place: Vector } | null = null; // where what is followed was drawn
  private settling = new Settling();
  private framed = ""; // the look that the page has chosen itself
  private reference = 1; // force [N] that has an arrow of this length [m]
  private arrow = 0.1;
  private selected: number[] = []; // links
  private hadLines = false; // the frame before had rays, messages or contacts
  private flashed = -1;
  private hasFramed = false;
  private drawnAt = 0; // [s]
  private drewBefore = false; // at the screen's last frame
  private coloring: Coloring = "scene";
  poses: Poses | null = null; // of the tick; what is drawn may be on its way there
  shown = new Set<Layer>(layersAtFirst);
  trailed: string[] = []; // ids of entities
  ruler: Vector[] = []; // places that were clicked, two at most
  private ruled: Vector[] = []; // the line that is drawn
  followed: string | null = null;

  constructor(canvas: HTMLCanvasElement, keepsLook: boolean) {
    this.stage = new Stage(canvas);
    this.bodies = new Bodies(this.stage.isSlow);
    this.hasFramed = keepsLook;
    this.stage.scene.add(this.floor.group, this.shade.mesh, this.bodies.group, this.tags.group, this.lights.group, this.lines.object,
                         this.inside.object, this.labels.group);
  }

  /** Forgets the world, before that of another source is shown. */
  forget(): void {
    this.world = this.frame = this.drawn = this.poses = null;
    this.trails.clear();
    this.labels.show([], () => null);
    this.motion.forget();
    this.settling = new Settling();
    this.flashed = -1;
    this.hasFramed = false;
  }

  /**
   * Shows a frame; false if nothing in it is known yet.
   * @param seen  where trails begin: all frames that can be read at once
   * @param isPaused  time stands, or goes step by step; @param now  wall time [s]
   */
  show(frame: Frame, selected: number[], seen: Frames | null, isPaused: boolean, now: number): boolean {
    const message = frame.messages.get("/poses");
    const world = frame.world;
    if (!message || !world) return false;
    const poses = message.read<Poses>();
    if (poses.generation !== world.generation) return false;
    const isNewWorld = world !== this.world;
    if (isNewWorld) this.setWorld(world);
    const before = isNewWorld ? null : this.poses;
    const distance = frame.sequence - (this.frame?.sequence ?? frame.sequence);
    const isEarlier = this.frame !== null && frame.timeNs < this.frame.timeNs;
    const isAway = isEarlier || distance < 0 || distance > longestGap; // the user jumped far, or the world began anew
    const isJump = isAway || (isPaused && distance > 1);
    if (isAway) this.trails.clear();
    this.poses = poses;
    this.frame = frame;
    const isAnother = selected.join() !== this.selected.join() || this.trailed.some((id) => !this.trails.has(id));
    this.selected = selected;
    const hasLines = ["/rays", "/radio", "/contacts"].some((topic) => frame.messages.has(topic));
    if (before && !isAnother && isSame(before, poses)) {
      this.stage.isDirty ||= hasLines || this.hadLines;
      this.hadLines = hasLines;
      if (!this.stage.isDirty) this.drawn = frame;
      this.settle(frame);
      return true;
    }
    this.hadLines = hasLines;
    if (before !== poses) this.motion.take(poses, before !== null && !isJump, isPaused ? oneStep : longestMotion, now);
    this.floor.setPoses(poses);
    this.place();
    this.trails.grow(this.trailed, frame, world, poses, seen);
    this.settle(frame);
    return true;
  }

  /** Places what is drawn. */
  private place(): void {
    const { shown } = this.motion;
    if (!shown) return;
    this.stage.shadowsChange();
    this.shade.setPoses(shown);
    this.tags.setPoses(shown);
    this.follow(shown);
    this.stage.isDirty = true;
  }

  /** Chooses what is drawn, for an eye. @param height  of the picture [px], @param isFine  for a picture that stays */
  private choose(poses: Poses, eye: three.PerspectiveCamera, height: number, isFine: boolean): void {
    this.bodies.setPoses(poses, eye, height, isFine);
    this.lights.setPoses(poses, this.bodies.details);
  }

  /** Shows all at first, and once more when it has settled, unless the user has turned the picture meanwhile. */
  private settle(frame: Frame): void {
    if (!this.world || !this.poses || this.settling.isOver) return;
    this.stage.resize();
    if (this.hasFramed && JSON.stringify(this.stage.look) !== this.framed) {
      this.settling.isOver = true;
      return;
    }
    const box = firstBox(this.world, this.poses);
    if (!this.settling.take(box, Number(frame.timeNs) * 1e-9) && this.hasFramed) return;
    this.hasFramed = true;
    this.stage.frame(box);
    this.framed = JSON.stringify(this.stage.look);
  }

  private setWorld(world: World): void {
    this.world = world;
    this.bodies.setWorld(world, this.stage.triangles(false), colorOf(world, this.coloring));
    this.shade.setWorld(world);
    this.floor.setWorld(world);
    this.tags.setWorld(world);
    this.lights.setWorld(world);
    this.stage.setWorld(world);
    const masses = world.links.map((link) => link.mass).filter((mass) => mass > 0).sort((a, b) => a - b);
    this.reference = 9.8 * Math.max(1e-6, masses[Math.floor(masses.length / 2)] ?? 0.1);
    this.arrow = 1.2 * typicalSize(world);
  }

  /** Colours robots by what they are, or by what controls them. */
  setColoring(coloring: Coloring): void {
    this.coloring = coloring;
    if (this.world) this.bodies.paint(colorOf(this.world, coloring));
    this.stage.isDirty = true;
  }

  applyLayers(): void {
    this.bodies.group.visible = this.shown.has("bodies");
    this.tags.group.visible = this.shown.has("tags");
    this.lights.group.visible = this.shown.has("lights");
    this.stage.ground.marks.visible = this.shown.has("marks");
    this.stage.showShadows(this.shown.has("shadows"));
    this.stage.isDirty = true;
  }

  /** Draws if anything changed; called at each frame of the screen. @param now  wall time [s] */
  render(now: number): boolean {
    this.stage.resize();
    const isMoving = this.stage.isDirty || this.flashes.isActive || this.motion.isMoving;
    if (this.stage.isBusy || (this.stage.isSlow && isMoving && now - this.drawnAt < 0.9 / slowRate)) return false;
    if (this.drewBefore) this.stage.noteFrame(now - this.drawnAt);
    if (this.motion.go(now)) this.place();
    const isFine = !isMoving && now - this.drawnAt > restAfter && this.stage.canBeFiner;
    if (isMoving || isFine) {
      if (this.world && this.bodies.setDetail(this.world, this.stage.triangles(isFine))) this.stage.shadowsChange();
      this.stage.aim(isFine);
      if (this.motion.shown) this.choose(this.motion.shown, this.stage.camera, this.stage.height, isFine);
      this.drawLines(now);
      this.stage.render();
      this.drawn = this.frame;
      this.drawnAt = now;
    }
    this.drewBefore = isMoving;
    return isMoving || isFine;
  }

  /** Whether the picture is the last one, drawn as well as it can be, until something changes. */
  get isAtRest(): boolean {
    return !this.stage.isDirty && !this.flashes.isActive && !this.motion.isMoving && !this.stage.canBeFiner && !this.stage.isBusy;
  }

  /** Whether rays and messages of a robot are drawn. @param robot  its number; undefined: none, as of a thing that sends */
  private isShown(robot: number | undefined): boolean {
    if (!this.world || this.world.robots.length <= mostRobotsAtOnce || this.shown.has("everyone")) return true;
    return robot !== undefined && this.selected.includes(this.world.entities[this.world.robots[robot]?.entity]?.firstLink);
  }

  private drawLines(now: number): void {
    const { lines, inside, frame, world } = this;
    const poses = this.motion.shown;
    lines.clear();
    inside.clear();
    if (frame && world && poses) {
      if (this.selected.length > 0) drawSelection(world, poses, this.selected, lines);
      if (this.shown.has("magnets")) drawMagnets(world, poses, this.arrow, inside);
      if (this.shown.has("frusta")) drawFrusta(world, poses, lines);
      const rays = this.shown.has("rays") ? frame.messages.get("/rays")?.read<Rays>() : undefined;
      if (rays) drawRays(rays, (robot) => this.isShown(robot), lines);
      const originOf = (robot: number): Pose | null => {
        const entity = world.entities[world.robots[robot]?.entity];
        return entity ? originIn(poses, entity) : null;
      };
      if (rays?.markers) drawMarkers(rays.markers, originOf, lines);
      this.labels.show(rays?.markers ?? [], originOf);
      const contacts = frame.messages.get("/contacts");
      if (contacts && this.shown.has("contacts")) drawContacts(contacts.read<Contacts>(), this.reference, this.arrow, lines);
      const radio = frame.messages.get("/radio");
      if (radio && this.shown.has("radio") && this.flashed !== frame.sequence) {
        this.flashed = frame.sequence;
        this.flashes.add(world, poses, radio.read<RadioTraffic>(), (robot) => this.isShown(robot), now);
      }
      if (this.shown.has("trails")) {
        for (const points of this.trails.values()) drawTrail(points, 0xff9d2e, lines);
      }
    }
    if (this.ruled.length === 2) drawRuler(this.ruled[0], this.ruled[1], inside);
    this.flashes.draw(now, lines);
    lines.commit();
    inside.commit();
  }

  /** Draws the world without lines and decorations from another camera; pixels are linear light, rows from the bottom. */
  renderFrom(eye: three.PerspectiveCamera, target: three.WebGLRenderTarget, pixels: Uint8Array): void {
    const { renderer, scene } = this.stage;
    const hidden = [this.lines.object, this.inside.object, this.labels.group, this.bodies.decorations, this.stage.ground.marks];
    for (const object of hidden) object.visible = false;
    if (this.poses) this.choose(this.poses, eye, target.height, true);
    renderer.setRenderTarget(target);
    renderer.render(scene, eye);
    renderer.readRenderTargetPixels(target, 0, 0, target.width, target.height, pixels);
    renderer.setRenderTarget(null);
    for (const object of hidden) object.visible = true;
    this.stage.ground.marks.visible = this.shown.has("marks");
    if (this.motion.shown) this.choose(this.motion.shown, this.stage.camera, this.stage.height, this.stage.isFine);
  }

  /** X_WE of an entity's origin at the frame that is shown. */
  originOf(entity: number): Pose | null {
    const found = this.world?.entities[entity];
    return found && this.poses ? originIn(this.poses, found) : null;
  }

  private indexOf(id: string): number {
    return this.world?.entities.findIndex((entity) => entity.id === id && !entity.removed) ?? -1;
  }

  private follow({ positions }: Poses): void {
    const id = this.followed;
    const entity = id === null ? undefined : this.world?.entities[this.indexOf(id)];
    if (id === null || !entity) {
      this.seenAt = null;
      return;
    }
    const place = [0, 1, 2].map((i) => positions[3 * entity.referenceLink + i]) as Vector;
    const before = this.seenAt?.id === id ? this.seenAt.place : place;
    this.seenAt = { id, place };
    this.stage.shift(place.map((value, i) => value - before[i]) as Vector);
  }

  /** Looks at the entity with that id, or at all that moves. */
  frameAll(id?: string): void {
    if (!this.world || !this.poses) return;
    const box = boxOf(this.world, this.poses, (entity) => {
      const { movable, removed, robot, id: name } = this.world!.entities[entity];
      return !removed && (id === undefined ? movable || robot !== undefined : name === id);
    });
    this.stage.frame(box ?? arenaOf(this.world));
  }

  /** Above an entity, as it is drawn; null: it is not there. */
  above(id: string): Vector | null {
    const index = this.indexOf(id), shown = this.motion.shown;
    if (index < 0 || !shown) return null;
    const k = 3 * this.world!.entities[index].referenceLink;
    const { positions } = shown;
    const place: Vector = [positions[k], positions[k + 1], positions[k + 2] + this.bodies.heightOf(index)];
    return place.every(Number.isFinite) ? place : null;
  }

  /** Where a point is on the canvas [px]; null: outside. */
  onScreen(point: Vector): [number, number] | null {
    const at = new three.Vector3(...point).project(this.stage.camera);
    if (Math.abs(at.x) > 1 || Math.abs(at.y) > 1 || Math.abs(at.z) > 1) return null;
    const { clientWidth, clientHeight } = this.stage.canvas;
    return [(at.x + 1) / 2 * clientWidth, (1 - at.y) / 2 * clientHeight];
  }

  /** Draws a line between two points; none: no line. */
  showRuler(points: Vector[]): void {
    this.stage.isDirty ||= points.join() !== this.ruled.join();
    this.ruled = points;
  }

  /** A place was clicked with the ruler: its begin, its end, or that of the next one. */
  measure(point: Vector): void { this.ruler = this.ruler.length === 1 ? [this.ruler[0], point] : [point]; }

  /** The link under a place of the canvas (-1 to 1 each, y up). */
  pick(x: number, y: number): { link: number; point: three.Vector3 } | null {
    const ray = new three.Raycaster();
    ray.setFromCamera(new three.Vector2(x, y), this.stage.camera);
    return this.bodies.pick(ray);
  }

  /** Where the ray through a place of the canvas meets the plane z = height. */
  onPlane(x: number, y: number, height: number): three.Vector3 | null {
    const ray = new three.Raycaster();
    ray.setFromCamera(new three.Vector2(x, y), this.stage.camera);
    return ray.ray.intersectPlane(new three.Plane(new three.Vector3(0, 0, 1), -height), new three.Vector3());
  }
}
