// SPDX-License-Identifier: MIT
// A world that is made in the page, without a server: to measure drawing, and for tests of the page. Boxes,
// cylinders and spheres move up and down in waves on a grid: `?generated=500` in the address.
import type { Listener, Message, Source, Value } from "./source";

class Made implements Message {
  readonly bytes: number;
  constructor(readonly topic: string, readonly timeNs: bigint, private readonly value: Value, bytes: number) {
    this.bytes = bytes;
  }
  read<T = Value>(): T { return this.value as T; }
}

const tickNs = 20_000_000;
const colors = [0xd3a469, 0x5e9aa0, 0xc9ccd1];

export function makeWorld(count: number): Value {
  const side = Math.ceil(Math.sqrt(count));
  const links = [], entities = [];
  for (let i = 0; i < count; ++i) {
    const shape = [{ box: { size: [0.06, 0.06, 0.06] } }, { cylinder: { radius: 0.03, height: 0.06 } },
                   { sphere: { radius: 0.03 } }][i % 3];
    links.push({ id: "", entity: i, frame: `e${i}`, color: colors[i % 3], collides: true, mass: 0.1, ...shape });
    entities.push({ id: `e${i}`, kind: 1 + i % 3, movable: true, removed: false, model: "", firstLink: i, linkCount: 1,
                    referenceLink: i, originPosition: [0, 0, 0], originOrientation: [1, 0, 0, 0] });
  }
  const none: never[] = [];
  return {
    generation: 1, scene: "generated", sceneHash: "0".repeat(16), seed: 1, tickNs, ticksPerSecond: 50, lastTick: 0,
    arenaSize: [side * 0.1, side * 0.1, 1], arenaCenter: [0, 0, 0.5], hasFloor: true, floorTile: 0.1,
    entities, links, hulls: none, joints: none, robots: none, cameras: none, leds: none, directionalLeds: none,
    tags: none, magnets: none, radios: none, proximitySensors: none, rangeAndBearing: none, models: none,
    controllers: none, tagPatterns: none,
  };
}

export function makePoses(count: number, tick: number): Value {
  const side = Math.ceil(Math.sqrt(count));
  const positions = new Float32Array(3 * count), orientations = new Float32Array(4 * count);
  for (let i = 0; i < count; ++i) {
    const [x, y] = [(i % side - (side - 1) / 2) * 0.1, (Math.floor(i / side) - (side - 1) / 2) * 0.1];
    positions.set([x, y, 0.05 * (1 + Math.sin(tick * 0.1 + 8 * x + 5 * y))], 3 * i);
    const half = 0.02 * tick + i;
    orientations.set([Math.cos(half), 0, 0, Math.sin(half)], 4 * i);
  }
  return { tick, timeNs: tick * tickNs, generation: 1, positions, orientations, jointPositions: [], ledColors: [],
           directionalLedColors: [], tagPayloads: [], magnetCurrents: [], magnetMoments: [] };
}

export class GeneratedSource implements Source {
  readonly isLive = false;
  readonly name = "generated";
  private timer = 0;

  constructor(private readonly count: number) {}

  start(listener: Listener): void {
    listener.status({ phase: "open", text: "", mayControl: false, session: "generated" });
    listener.topics(["/poses", "/world"]);
    listener.message(new Made("/world", 0n, makeWorld(this.count), 100 * this.count));
    let tick = 0;
    const step = (): void => {
      listener.message(new Made("/poses", BigInt(tick * tickNs), makePoses(this.count, tick), 28 * this.count));
      ++tick;
      this.timer = requestAnimationFrame(step); // one for each frame of the screen
    };
    step();
  }

  want(): void { /* all of it, always */ }
  call(): Promise<Value> { return Promise.reject(new Error("a generated world has no server to ask")); }
  setParameter(): void { /* it has none */ }
  close(): void { cancelAnimationFrame(this.timer); }
}
