# SPDX-License-Identifier: MIT
"""Judges a construction run by its trace and readings: final places of blocks, depths of overlaps, drift of
joints, kinetic energies.

All is computed from the poses in the trace and the shapes in the scene, independently of the server.
"""

import csv
import dataclasses
import json
import math

import geometry

BLOCK = 0.055  # [m]


@dataclasses.dataclass
class Limits:
    aside: float = 0.006      # upper block's centre from the lower one's, in x and in y [m]
    height: float = 0.002     # error of the step from block to block, nominally 55 mm [m]
    still: float = 0.0005     # greatest movement of a block while it should rest [m]
    rest: float = 10.0        # how long it must rest [s]
    depth: float = 0.001      # deepest interpenetration at any tick [m]
    drift: float = 0.0005     # of joints [m]
    energy: float = 0.02      # kinetic energy of any link from tick to tick [J]


@dataclasses.dataclass
class Verdict:
    faults: list
    aside: float = math.nan   # [m]
    height: float = math.nan  # error of the step [m]
    moved: float = math.nan   # during the rest [m]
    depth: float = 0.0        # [m]
    drift: float = 0.0        # [m]
    energy: float = 0.0       # [J]

    @property
    def good(self):
        return not self.faults


def read_trace(path):
    """[(time, {(entity, link): Pose})] in the order of ticks; origins have the link ''. What did not move from tick
    to tick is the same object."""
    ticks, latest = [], {}
    with open(path, newline="") as file:
        rows = csv.reader(file)
        next(rows)
        last = None
        for tick, time, entity, link, *numbers in rows:
            if tick != last:
                ticks.append((float(time), {}))
                last = tick
            key, texts, pose = latest.get((entity, link), ((entity, link), None, None))
            if texts != numbers:
                x, y, z, w, i, j, k = map(float, numbers)
                pose = geometry.Pose((x, y, z), (w, i, j, k))
                latest[key] = key, numbers, pose
            ticks[-1][1][key] = pose
    return ticks


def at_rest(before, now):
    """Whether nothing at all moved from tick to tick."""
    return all(before[key] is pose for key, pose in now.items())


def judge_motion(ticks, scene, limits, verdict):
    """Depths, drifts and energies over all ticks."""
    joints = geometry.Joints(scene, ticks[0][1])
    deepest = (0.0, "")
    for number, (time, poses) in enumerate(ticks):
        before = ticks[number - 1][1] if number else None
        if before and at_rest(before, poses):
            continue
        depth, names = geometry.deepest_overlap(scene, poses, before)
        if depth > deepest[0]:
            deepest = depth, f"{names} at {time:g} s"
        drift, joint = joints.drift(poses, before)
        if drift > verdict.drift:
            verdict.drift = drift
            if drift > limits.drift:
                verdict.faults.append(f"joint {joint} drifted {1000 * drift:.2f} mm at {time:g} s")
        if before:
            energy, link = geometry.fastest(scene, before, poses, time - ticks[number - 1][0])
            if energy > verdict.energy:
                verdict.energy = energy
                if energy > limits.energy:
                    verdict.faults.append(f"{link} moved with {1000 * energy:.1f} mJ at {time:g} s")
    verdict.depth = deepest[0]
    if deepest[0] > limits.depth:
        verdict.faults.append(f"{1000 * deepest[0]:.2f} mm deep: {deepest[1]}")


def away(scene, poses):
    """Whether no end effector is near a block."""
    return all(math.dist(poses[entity, "end_effector"].position[:2], poses[key].position[:2]) > 0.06
               for entity in scene.robots for key in scene.blocks)


def judge_rest(ticks, scene, limits, verdict):
    """After the robots have left, all blocks rest for at least ten seconds."""
    end, last = ticks[-1]
    verdict.moved = 0.0
    for time, poses in reversed(ticks):
        if not away(scene, poses):
            break
        since = time
        for key in scene.blocks:
            verdict.moved = max(verdict.moved, math.dist(poses[key].position, last[key].position))
    else:
        since = 0.0
    if not away(scene, last):
        verdict.faults.append("a robot still stands over a block")
    elif end - since < limits.rest:
        verdict.faults.append(f"the robot was away for {end - since:.1f} s only")
    if verdict.moved > limits.still:
        verdict.faults.append(f"a block moved {1000 * verdict.moved:.2f} mm at the end")


def stands_on(lower, upper, limits, verdict):
    """Checks by their poses that the upper block stands on the lower one."""
    (lx, ly, lz), (ux, uy, uz) = geometry.centre(lower), geometry.centre(upper)
    aside, height = max(abs(ux - lx), abs(uy - ly)), uz - lz - BLOCK
    verdict.aside = max(verdict.aside, aside) if verdict.aside >= 0 else aside
    verdict.height = height if not abs(verdict.height) > abs(height) else verdict.height
    if aside > limits.aside:
        verdict.faults.append(f"upper block {1000 * aside:.1f} mm aside")
    if abs(height) > limits.height:
        verdict.faults.append(f"upper block {1000 * (uz - lz):.1f} mm above the lower one")


def judge_stack(ticks, scene, limits, verdict):
    """One of the two blocks stands on the other."""
    last = ticks[-1][1]
    lower, upper = sorted((last[key] for key in scene.blocks), key=lambda pose: pose.position[2])
    stands_on(lower, upper, limits, verdict)


def judge_staircase(ticks, scene, limits, verdict):
    """Six blocks form columns of one, two and three blocks, in this order, side by side in a row."""
    last = ticks[-1][1]
    columns = []
    for pose in sorted((last[key] for key in scene.blocks), key=lambda pose: pose.position[2]):
        near = [column for column in columns
                if math.dist(column[-1].position[:2], pose.position[:2]) < BLOCK / 2]
        if near:
            near[0].append(pose)
        else:
            columns.append([pose])
    columns.sort(key=len)
    heights = [len(column) for column in columns]
    if heights != [1, 2, 3]:
        verdict.faults.append(f"columns of {heights} blocks")
        return
    for column in columns:
        if abs(column[0].position[2]) > limits.height:
            verdict.faults.append("the lowest block of a column does not stand on the floor")
        for lower, upper in zip(column, column[1:]):
            stands_on(lower, upper, limits, verdict)
    for one, next_one in zip(columns, columns[1:]):
        pitch = math.dist(one[0].position[:2], next_one[0].position[:2])
        if not 0.06 < pitch < 0.1:
            verdict.faults.append(f"columns {1000 * pitch:.0f} mm apart")
    ends = math.dist(columns[0][0].position[:2], columns[2][0].position[:2])
    if ends < 0.13:
        verdict.faults.append("the columns are not in a row")


def judge_devices(readings_file, scene, verdict):
    """The last commands: electromagnets off, and a carried block is red."""
    last = {}
    with open(readings_file) as file:
        for line in file.readlines()[-len(scene.robots) - len(scene.blocks):]:
            record = json.loads(line)
            last[record["robot"]] = record
    for entity in scene.robots:
        if any(current != -1 for current in last[entity]["command"]["magnet_currents"].values()):
            verdict.faults.append("the electromagnets are on at the end")
    red = [entity for entity, _ in scene.blocks
           if all(color == {"red": 255, "green": 0, "blue": 0}
                  for color in last[entity]["observation"]["directional_led_colors"])]
    if len(red) != 1:
        verdict.faults.append(f"{len(red)} blocks are red")


def judge(scene_file, trace_file, readings_file, limits=Limits()):
    """The verdict on a run of the stacking scene."""
    scene = geometry.read_scene(scene_file)
    ticks = read_trace(trace_file)
    verdict = Verdict([])
    judge_stack(ticks, scene, limits, verdict)
    judge_rest(ticks, scene, limits, verdict)
    judge_motion(ticks, scene, limits, verdict)
    judge_devices(readings_file, scene, verdict)
    return verdict


def judge_stairs(scene_file, trace_file, _, limits=Limits()):
    """The verdict on a run of the staircase."""
    scene = geometry.read_scene(scene_file)
    ticks = read_trace(trace_file)
    verdict = Verdict([])
    judge_staircase(ticks, scene, limits, verdict)
    judge_rest(ticks, scene, limits, verdict)
    judge_motion(ticks, scene, limits, verdict)
    return verdict
