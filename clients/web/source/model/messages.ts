// SPDX-License-Identifier: MIT
// The decoded messages of topics that the page draws: protocol/ziggurat/v1/channels.proto and
// protocol.proto have their meaning and units. Topics that are only listed and plotted need no type.

export type Floats = ArrayLike<number>;

export enum Kind {
  unspecified, box, cylinder, sphere, prototype, footBot, ePuck, light, eyeBot, spiri, miniQuadrotor,
  kilobot, piPuck, builderbot, khepera,
}

export interface Entity {
  id: string; kind: Kind; movable: boolean; removed: boolean; model: string;
  firstLink: number; linkCount: number; referenceLink: number;
  originPosition: Floats; originOrientation: Floats; robot?: number;
}
export interface Box { size: Floats }
export interface Cylinder { radius: number; height: number }
export interface Sphere { radius: number }
export interface Link {
  id: string; entity: number; frame: string; color: number; collides: boolean; mass: number;
  box?: Box; cylinder?: Cylinder; sphere?: Sphere; capsule?: Cylinder; hull?: number;
}
export interface Hull { vertices: Floats; triangles: Floats }
export enum JointType { unspecified, fixed, spherical, prismatic, revolute }
export interface Joint {
  id: string; entity: number; type: JointType; parent: number; child: number;
  position: Floats; axis: Floats; lower?: number; upper?: number;
}
export interface Mount { link: number; position: Floats; orientation: Floats }
export interface Camera {
  id: string; robot: number; mount: Mount; near: number; far: number; focalLength: Floats;
  principalPoint: Floats; width: number; height: number; detectsLeds: boolean;
  detectsDirectionalLeds: boolean; detectsTags: boolean; image: boolean;
}
export interface Led { id: string; entity: number; mount: Mount; observableAngle: number }
export interface Tag {
  id: string; entity: number; mount: Mount; sideLength: number; observableAngle: number; payload: Uint8Array;
}
export interface Magnet {
  id: string; entity: number; mount: Mount; box?: Box; cylinder?: Cylinder; sphere?: Sphere;
}
export interface Radio { id: string; robot: number; mount: Mount; range: number; sends: boolean; receives: boolean }
export interface Proximity { robot: number; mount: Mount; direction: Floats; range: number }
export interface RangeAndBearing { entity: number; robot?: number; mount: Mount; range: number }

export interface Described { id: string }
export interface Description {
  id: string; controller: string; params: { name: string; value: string }[]; script: string;
  jointSensors: { id: string; mode: number }[]; jointActuators: { id: string; mode: number }[];
  radios: { id: string; range: number; sends: boolean; receives: boolean }[];
  leds: Described[]; directionalLeds: Described[]; tags: Described[]; magnets: Described[];
  proximitySensors: { range: number; angle?: number; direction: Floats }[];
  rangeAndBearing?: { range: number; dataSize: number; sends: boolean; receives: boolean };
  positioning: boolean; battery: boolean;
  cameras: { id: string; detectsLeds: boolean; detectsDirectionalLeds: boolean; detectsTags: boolean; image: boolean }[];
  wheels?: { axleLength: number; drives: boolean; measures: boolean };
  turret?: { drives: boolean; measures: boolean };
  imus: Described[]; contactSensors: Described[]; deviceKinds?: DeviceKind[]; // since protocol 1.5
}
export interface DeviceField { name: string; unit: string }
/** A kind of device that describes itself. */
export interface DeviceKind {
  name: string; readings: DeviceField[]; commands: DeviceField[]; mostRows: number; devices: Described[];
}
export interface Robot { entity: number; description: Description }

export interface World {
  generation: number; scene: string; sceneHash: string; seed: number | bigint; tickNs: number;
  ticksPerSecond: number; lastTick: number; arenaSize: Floats; arenaCenter: Floats; hasFloor: boolean;
  floorTile: number;
  entities: Entity[]; links: Link[]; hulls: Hull[]; joints: Joint[]; robots: Robot[]; cameras: Camera[];
  leds: Led[]; directionalLeds: Led[]; tags: Tag[]; magnets: Magnet[]; radios: Radio[];
  proximitySensors: Proximity[]; rangeAndBearing: RangeAndBearing[];
  models: { id: string; kind: Kind }[]; controllers: string[]; tagPatterns: number[];
  floorPicture?: Uint8Array;
}

export interface Poses {
  tick: number; timeNs: number; generation: number; positions: Floats; orientations: Floats;
  jointPositions: Floats; ledColors: Floats; directionalLedColors: Floats;
  tagPayloads: { tag: number; payload: Uint8Array }[]; magnetCurrents: Floats; magnetMoments: Floats;
  floorPaints?: Floats;
}

/** Drawn by a robot, in the frame of its origin: an arrow has `to`, a ring `radius`, a text `text`. */
export interface Marker { robot: number; at: Floats; to: Floats; radius: number; text: string; color: number }
export interface Rays {
  tick: number; kinds: Floats; robots: Floats; segments: Floats; hits: ArrayLike<boolean>;
  markers?: Marker[]; // since protocol 1.5
}
export interface Light { color: number; u: number; v: number }
export interface SeenTag { tag: number; payload: Uint8Array; u: number; v: number; corners: Floats }
export interface SeenByCamera { camera: number; leds: Light[]; directionalLeds: Light[]; tags: SeenTag[] }
export interface Detections { tick: number; cameras: SeenByCamera[] }
export interface RadioTraffic {
  tick: number;
  messages: { sender: number; receiver: number; payload: Uint8Array }[];
  packets: { sender: number; receiver: number; data: Uint8Array; range: number }[];
}
export interface Contacts { tick: number; links: Floats; points: Floats; normals: Floats; forces: Floats }
export interface Latency { p50: number; p99: number; max: number }
export interface Session {
  client: string; role: number; state: number; robots: string[]; tick: number; wallWaitingS: number;
  wallLastMessageS: number; wallLatency?: Latency; misses: number;
}
export interface Barrier {
  status?: {
    tick: number; phase: number; sessions: Session[]; freeRobots: string[]; goneRobots: string[];
    budget: { phase: string; wall?: Latency }[]; wallUptimeS: number;
  };
  histograms: { controller: string; least: number; growth: number; counts: Floats; missedTicks: number }[];
}
export interface Phases { tick: number; encode: number; wait: number; forces: number; magnetism: number;
  contacts: number; solve: number; integrate: number; sensing: number; recording: number; pacing: number }
export interface Log { level: number; message: string; name: string }

export interface Observation {
  tick: number; jointReadings: Floats; radioMessages: { radio: number; payload: Uint8Array }[];
  proximity: Floats;
  rangeAndBearing: { range: number; horizontalBearing: number; verticalBearing: number; data: Uint8Array }[];
  positioning: Floats; batteries: Floats; ledCounts: Floats; directionalLedCounts: Floats; tagCounts: Floats;
  wheels: Floats; turretRotations: Floats; imus: Floats; contactSensors: Floats;
  deviceReadings: Floats; deviceRows: Floats; deviceRowValues: Floats;
}
export interface Command {
  tick: number; jointTargets: Floats; radioMessages: { radio: number; payload: Uint8Array }[];
  ledColors: Floats; directionalLedColors: Floats; tagPayloads?: Uint8Array[]; magnetCurrents: Floats;
  rangeAndBearingData: Uint8Array; wheelVelocities: Floats; turretModes: Floats; turretRotations: Floats;
  turretSpeeds: Floats; deviceCommands: Floats;
}

/** Whether it is a robot that comes as it is. */
export function isRobot(kind: Kind): boolean {
  return kind === Kind.footBot || kind === Kind.ePuck || kind > Kind.light;
}

/** Why an entity is a robot of its own look, and what to call it. */
export function kindName(kind: Kind): string {
  return ["?", "box", "cylinder", "sphere", "prototype", "foot-bot", "e-puck", "light", "eye-bot", "spiri",
    "mini-quadrotor", "kilobot", "pipuck", "builderbot", "kheperaiv"][kind] ?? "?";
}
