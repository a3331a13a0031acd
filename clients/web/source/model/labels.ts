// SPDX-License-Identifier: MIT
// Labels and units of series, as those who plot them know them: "base_wheel_fr velocity [rad/s]" of a robot.
import type { Command, Observation, World } from "./messages";
import { metricsTopic } from "./metrics";
import { commanded, jointsOf, observed } from "./readings";
import type { SeriesName } from "./series";

export interface Label {
  of: string; // whose it is: a robot, a link, or the topic
  text: string;
  unit: string; // empty: none, or not known
}

const ofPoses: Record<string, { axes: string[]; text: string; unit: string }> = {
  positions: { axes: ["x", "y", "z"], text: "position", unit: "m" },
  orientations: { axes: ["w", "x", "y", "z"], text: "orientation", unit: "" },
};

/** null: it is not known before a world and a message of the topic are there. */
export function labelOf({ topic, path }: SeriesName, world: World | null, message: unknown): Label | null {
  const robot = /^\/robots\/(.*)\/(observation|command)$/.exec(topic);
  if (robot) return world && message ? ofRobot(world, robot[1], robot[2] === "command", { topic, path }, message) : null;
  const [field, index] = path.split(".");
  if (topic === "/phases") return { of: "tick", text: path, unit: path === "tick" ? "" : path === "timeNs" ? "ns" : "s" };
  if (topic === metricsTopic) return { of: path.slice(0, path.lastIndexOf("/")), text: path.slice(path.lastIndexOf("/") + 1), unit: "" };
  if (topic === "/poses" && index !== undefined) {
    if (!world) return null;
    const poses = ofPoses[field];
    const place = Number(index);
    const link = poses && world.links[Math.floor(place / poses.axes.length)];
    if (poses && link) return { of: link.frame, text: `${poses.text} ${poses.axes[place % poses.axes.length]}`, unit: poses.unit };
    const joint = field === "jointPositions" ? world.joints[place] : undefined;
    if (joint) return { of: world.entities[joint.entity]?.id ?? "", text: `${joint.id} position`, unit: joint.type === 3 ? "m" : "rad" };
  }
  return { of: topic, text: path, unit: "" };
}

function ofRobot(world: World, id: string, isCommand: boolean, { topic, path }: SeriesName, message: unknown): Label {
  const robot = world.robots.find(({ description }) => description.id === id);
  const groups = !robot ? [] : isCommand
    ? commanded(topic, robot.description, message as Command, jointsOf(world, robot.entity))
    : observed(topic, robot.description, message as Observation, jointsOf(world, robot.entity));
  const reading = groups.flatMap(({ readings }) => readings).find(({ series }) => series?.path === path);
  return { of: id, text: reading?.name ?? path, unit: reading?.unit ?? "" };
}

/** With whose it is and the unit, in one line. */
export function longLabel({ of, text, unit }: Label): string { return `${of} ${text}${unit ? ` [${unit}]` : ""}`; }

/** Series with the same key are drawn over each other: those of one unit; without unit, of one field of a kind of topic. */
export function chartOf({ topic, path }: SeriesName, label: Label | null): string {
  if (label && label.unit !== "") return `[${label.unit}]`;
  if (topic === metricsTopic) return `${topic}:${label?.text ?? path}`;
  return `${topic.replace(/^\/robots\/.*\//, "/robots/*/")}:${path.replace(/\.\d+$/, "")}`;
}
