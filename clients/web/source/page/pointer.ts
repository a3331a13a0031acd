// SPDX-License-Identifier: MIT
// Mouse and touch in the picture: a click selects, and with the tool "move" a drag moves an entity.
import type { Vector } from "../model/pose";
import type { App } from "./app";

interface Grab { id: string; offset: Vector; start: Vector; height: number; place: Vector; sent: number }

const sendEvery = 80; // [ms]
const clickRadius = 5; // [px]

export class Pointer {
  private down: { x: number; y: number } | null = null;
  private grab: Grab | null = null;
  private isSending = false;

  constructor(private readonly app: App, private readonly canvas: HTMLCanvasElement,
              onPlace: (x: number, y: number, z: number) => void) {
    canvas.addEventListener("pointerdown", (event) => this.press(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event), { capture: true });
    canvas.addEventListener("pointerup", (event) => this.release(event), { capture: true });
    canvas.addEventListener("dblclick", (event) => {
      const id = this.entityAt(event)?.id;
      if (id !== undefined) app.look(id);
    });
    canvas.addEventListener("contextmenu", (event) => {
      event.preventDefault();
      if (!event.shiftKey) return;
      const point = app.view.pick(...this.at(event))?.point ?? app.view.onPlane(...this.at(event), 0);
      if (point) onPlace(point.x, point.y, point.z + 0.01);
    });
  }

  /** Place in the canvas, -1 to 1 each, y up. */
  private at(event: MouseEvent): [number, number] {
    const box = this.canvas.getBoundingClientRect();
    return [2 * (event.clientX - box.left) / box.width - 1, 1 - 2 * (event.clientY - box.top) / box.height];
  }

  private entityAt(event: MouseEvent): { id: string; movable: boolean; index: number; point: Vector } | null {
    const { world, view } = this.app;
    const hit = view.pick(...this.at(event));
    if (!hit || !world) return null;
    const index = world.links[hit.link].entity;
    const { id, movable, robot } = world.entities[index];
    return { id, movable: movable || robot !== undefined, index, point: hit.point.toArray() };
  }

  private press(event: PointerEvent): void {
    this.down = { x: event.clientX, y: event.clientY };
    const { app } = this;
    if (app.tool !== "move" || event.button !== 0) return;
    const found = this.entityAt(event);
    const origin = found && app.view.originOf(found.index);
    if (!found || !origin) return;
    event.stopImmediatePropagation(); // the camera stays
    if (app.pinned !== null || !app.connection.mayControl) {
      return app.notice("warning", app.pinned !== null ? "This is the past: jump to live to move things."
                                                       : "To move things, open the address with the token.");
    }
    app.select(found.id);
    this.canvas.setPointerCapture(event.pointerId);
    const offset = origin.position.map((value, i) => value - found.point[i]) as Vector;
    this.grab = { id: found.id, offset, start: origin.position, height: found.point[2], place: origin.position, sent: 0 };
  }

  private move(event: PointerEvent): void {
    const { grab, app } = this;
    if (!grab || !this.down) return;
    event.stopImmediatePropagation();
    if (event.shiftKey) {
      const distance = Math.hypot(...app.view.stage.look.eye.map((value, i) => value - app.view.stage.look.at[i]));
      grab.place = [grab.place[0], grab.place[1], grab.start[2] + (this.down.y - event.clientY) * distance / this.canvas.clientHeight];
    } else {
      const point = app.view.onPlane(...this.at(event), grab.height);
      if (!point) return;
      grab.place = [point.x + grab.offset[0], point.y + grab.offset[1], grab.place[2]];
    }
    if (performance.now() - grab.sent > sendEvery) this.send(grab);
  }

  /** One request at a time; the last place is sent on release. */
  private send(grab: Grab, isLast = false): void {
    if (this.isSending && !isLast) return;
    this.isSending = true;
    grab.sent = performance.now();
    void this.app.call("/move", { entity: grab.id, position: grab.place, may_overlap: true }).finally(() => { this.isSending = false; });
  }

  private measure(event: PointerEvent): void {
    const point = this.app.view.pick(...this.at(event))?.point ?? this.app.view.onPlane(...this.at(event), 0);
    if (point) this.app.view.measure(point.toArray());
  }

  private release(event: PointerEvent): void {
    const { down, grab } = this;
    this.down = this.grab = null;
    const isClick = down !== null && Math.hypot(event.clientX - down.x, event.clientY - down.y) < clickRadius;
    if (grab) {
      event.stopImmediatePropagation();
      if (!isClick) this.send(grab, true);
      return;
    }
    if (isClick && event.button === 0 && this.app.tool === "ruler") return this.measure(event);
    if (isClick && event.button === 0) this.app.select(this.entityAt(event)?.id ?? null);
  }
}
