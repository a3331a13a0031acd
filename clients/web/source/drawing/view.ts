// The picture of one frame: everything that is drawn, layer by layer.
import * as three from "three";
import type { Contacts, Entity, Poses, RadioTraffic, Rays, World } from "../model/messages";
import { compose, poseAt, type Pose, type Vector } from "../model/pose";
import type { Frame, Frames } from "../model/timeline";
import { Bodies } from "./bodies";
import { Floor } from "./floor";
import { Lights } from "./lights";
import { Lines } from "./lines";
import { Labels } from "./labels";
import {
  drawContacts, drawFrusta, drawMagnets, drawMarkers, drawRays, drawSelection, drawTrail, RadioFlashes, typicalSize,
} from "./overlays";
import { Stage } from "./stage";
import { Tags } from "./tags";

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
] as const;
export type Layer = (typeof layers)[number]["name"];
export const layersAtFirst: Layer[] = ["bodies", "shadows", "tags", "lights", "rays", "radio", "trails"];

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

/** X_WE of an entity's origin. */
function originIn({ positions, orientations }: Poses, entity: Entity): Pose {
  return compose(poseAt(positions, orientations, entity.referenceLink),
                 { position: entity.originPosition, orientation: entity.originOrientation });
}

const longestGap = 100; // frames between two points of a trail
const longestTrail = 1500; // points
const mostRead = 60_000; // poses of links, for the trail of what has been
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
  private trails = new Map<string, Vector[]>();
  private reference = 1; // force [N] that has an arrow of this length [m]
  private arrow = 0.1;
  private selected: number[] = []; // links
  private hadLines = false; // the frame before had rays, messages or contacts
  private flashed = -1;
  private hasFramed = false;
  private drawnAt = 0; // [s]
  private drewBefore = false; // at the screen's last frame
  poses: Poses | null = null;
  shown = new Set<Layer>(layersAtFirst);
  trailed: string[] = []; // ids of entities
  followed: string | null = null;

  constructor(canvas: HTMLCanvasElement, keepsLook: boolean) {
    this.stage = new Stage(canvas);
    this.bodies = new Bodies(this.stage.isSlow);
    this.hasFramed = keepsLook;
    this.stage.scene.add(this.floor.group, this.bodies.group, this.tags.group, this.lights.group, this.lines.object,
                         this.inside.object, this.labels.group);
  }

  /** Forgets the world, before that of another source is shown. */
  forget(): void {
    this.world = this.frame = this.poses = null;
    this.trails.clear();
    this.flashed = -1;
    this.hasFramed = false;
  }

  /**
   * Shows a frame; false if nothing in it is known yet.
   * @param seen  where trails begin: all frames that can be read at once
   */
  show(frame: Frame, selected: number[], seen: Frames | null): boolean {
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
    if (isEarlier || distance < 0 || distance > longestGap) this.trails.clear(); // the user jumped, or the world began anew
    this.poses = poses;
    this.frame = frame;
    const isAnother = selected.join() !== this.selected.join() || this.trailed.some((id) => !this.trails.has(id));
    this.selected = selected;
    const hasLines = ["/rays", "/radio", "/contacts"].some((topic) => frame.messages.has(topic));
    if (before && !isAnother && isSame(before, poses)) {
      this.stage.isDirty ||= hasLines || this.hadLines;
      this.hadLines = hasLines;
      return true;
    }
    this.hadLines = hasLines;
    this.bodies.setPoses(poses);
    this.stage.shadowsChange();
    this.floor.setPoses(poses);
    this.tags.setPoses(poses);
    this.lights.setPoses(poses);
    this.follow(before);
    this.growTrails(frame, seen);
    if (!this.hasFramed) {
      this.hasFramed = true;
      this.frameAll();
    }
    this.stage.isDirty = true;
    return true;
  }

  private setWorld(world: World): void {
    this.world = world;
    this.bodies.setWorld(world, this.stage.triangles(false));
    this.floor.setWorld(world);
    this.tags.setWorld(world);
    this.lights.setWorld(world);
    this.stage.setWorld(world);
    const masses = world.links.map((link) => link.mass).filter((mass) => mass > 0).sort((a, b) => a - b);
    this.reference = 9.8 * Math.max(1e-6, masses[Math.floor(masses.length / 2)] ?? 0.1);
    this.arrow = 1.2 * typicalSize(world);
  }

  applyLayers(): void {
    this.bodies.group.visible = this.shown.has("bodies");
    this.tags.group.visible = this.shown.has("tags");
    this.lights.group.visible = this.shown.has("lights");
    this.stage.showShadows(this.shown.has("shadows"));
    this.stage.isDirty = true;
  }

  /** Draws if anything changed; called at each frame of the screen. @param now  wall time [s] */
  render(now: number): boolean {
    this.stage.resize();
    const isMoving = this.stage.isDirty || this.flashes.isActive;
    const isFine = !isMoving && now - this.drawnAt > restAfter && this.stage.canBeFiner;
    if (isMoving || isFine) {
      if (this.world && this.bodies.setDetail(this.world, this.stage.triangles(isFine))) this.stage.shadowsChange();
      this.drawLines(now);
      this.stage.render(isFine);
      // Consecutive frames only: the time between them includes what the graphics processor does.
      if (isMoving && this.drewBefore) this.stage.noteFrame(now - this.drawnAt);
      this.drawnAt = now;
    }
    this.drewBefore = isMoving;
    return isMoving || isFine;
  }

  /** Whether the picture is the last one, drawn as well as it can be, until something changes. */
  get isAtRest(): boolean { return !this.stage.isDirty && !this.flashes.isActive && !this.stage.canBeFiner; }

  private drawLines(now: number): void {
    const { lines, inside, frame, world, poses } = this;
    lines.clear();
    inside.clear();
    if (frame && world && poses) {
      if (this.selected.length > 0) drawSelection(world, poses, this.selected, lines);
      if (this.shown.has("magnets")) drawMagnets(world, poses, this.arrow, inside);
      if (this.shown.has("frusta")) drawFrusta(world, poses, lines);
      const rays = this.shown.has("rays") ? frame.messages.get("/rays")?.read<Rays>() : undefined;
      const originOf = (robot: number): Pose | null => this.originOf(world.robots[robot]?.entity ?? -1);
      if (rays) drawRays(rays, lines);
      if (rays?.markers) drawMarkers(rays.markers, originOf, lines);
      this.labels.show(rays?.markers ?? [], originOf);
      const contacts = frame.messages.get("/contacts");
      if (contacts && this.shown.has("contacts")) drawContacts(contacts.read<Contacts>(), this.reference, this.arrow, lines);
      const radio = frame.messages.get("/radio");
      if (radio && this.shown.has("radio") && this.flashed !== frame.sequence) {
        this.flashed = frame.sequence;
        this.flashes.add(world, poses, radio.read<RadioTraffic>(), now);
      }
      if (this.shown.has("trails")) {
        for (const points of this.trails.values()) drawTrail(points, 0xff9d2e, lines);
      }
    }
    this.flashes.draw(now, lines);
    lines.commit();
    inside.commit();
  }

  /** Draws the world without lines and decorations from another camera; pixels are linear light, rows from the bottom. */
  renderFrom(eye: three.Camera, target: three.WebGLRenderTarget, pixels: Uint8Array): void {
    const { renderer, scene } = this.stage;
    const hidden = [this.lines.object, this.inside.object, this.labels.group, this.bodies.decorations];
    for (const object of hidden) object.visible = false;
    renderer.setRenderTarget(target);
    renderer.render(scene, eye);
    renderer.readRenderTargetPixels(target, 0, 0, target.width, target.height, pixels);
    renderer.setRenderTarget(null);
    for (const object of hidden) object.visible = true;
  }

  /** X_WE of an entity's origin at the frame that is shown. */
  originOf(entity: number): Pose | null {
    const found = this.world?.entities[entity];
    return found && this.poses ? originIn(this.poses, found) : null;
  }

  private indexOf(id: string): number {
    return this.world?.entities.findIndex((entity) => entity.id === id && !entity.removed) ?? -1;
  }

  private follow(before: Poses | null): void {
    const entity = this.followed === null ? undefined : this.world?.entities[this.indexOf(this.followed)];
    if (!entity || !before || !this.poses || before.generation !== this.poses.generation) return;
    const k = 3 * entity.referenceLink;
    const [a, b] = [before.positions, this.poses.positions];
    this.stage.shift([b[k] - a[k], b[k + 1] - a[k + 1], b[k + 2] - a[k + 2]]);
  }

  private growTrails(frame: Frame, seen: Frames | null): void {
    for (const id of [...this.trails.keys()]) if (!this.trailed.includes(id)) this.trails.delete(id);
    for (const id of this.trailed) {
      const points = this.trails.get(id) ?? (seen ? this.trailBefore(id, frame, seen) : []);
      this.trails.set(id, points);
      this.addTo(points, this.originOf(this.indexOf(id)));
    }
  }

  private addTo(points: Vector[], origin: Pose | null): void {
    if (!origin?.position.every(Number.isFinite)) return;
    const [x, y, z] = origin.position;
    const last = points[points.length - 1];
    if (!last || Math.hypot(x - last[0], y - last[1], z + 0.002 - last[2]) > 0.001) points.push([x, y, z + 0.002]);
    if (points.length > longestTrail) points.shift();
  }

  /** Where an entity was before a frame. */
  private trailBefore(id: string, frame: Frame, seen: Frames): Vector[] {
    const reads = Math.min(Math.max(mostRead / (this.world?.links.length || 1), 20), 500);
    const first = Math.max(seen.first, frame.sequence - longestTrail);
    const step = Math.max(1, Math.ceil((frame.sequence - first) / reads));
    const origins: Pose[] = [];
    let later = frame;
    for (let s = frame.sequence - step; s >= first; s -= step) {
      const earlier = seen.at(s);
      const message = earlier?.messages.get("/poses");
      if (!earlier?.world || !message) continue;
      const entity = earlier.world.entities.find((one) => one.id === id && !one.removed);
      if (!entity || earlier.timeNs >= later.timeNs) break; // it was not there yet, or the world began anew
      origins.push(originIn(message.read<Poses>(), entity));
      later = earlier;
    }
    const points: Vector[] = [];
    for (const origin of origins.reverse()) this.addTo(points, origin);
    return points;
  }

  /** Looks at the entity with that id, or at all that moves. */
  frameAll(id?: string): void {
    if (!this.world || !this.poses) return;
    const low: Vector = [Infinity, Infinity, Infinity], high: Vector = [-Infinity, -Infinity, -Infinity];
    const isWanted = (entity: number): boolean => {
      const { movable, removed, robot, id: name } = this.world!.entities[entity];
      return !removed && (id === undefined ? movable || robot !== undefined : name === id);
    };
    this.world.links.forEach((link, index) => {
      if (!isWanted(link.entity)) return;
      for (let i = 0; i < 3; ++i) {
        const value = this.poses!.positions[3 * index + i];
        low[i] = Math.min(low[i], value - 0.05);
        high[i] = Math.max(high[i], value + 0.05);
      }
    });
    if (low[0] > high[0]) {
      const [x, y] = [this.world.arenaSize[0] / 2 || 1, this.world.arenaSize[1] / 2 || 1];
      this.stage.frame([-x, -y, 0], [x, y, 0.2]);
    } else {
      this.stage.frame(low, high);
    }
  }

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
