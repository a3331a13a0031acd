# SPDX-License-Identifier: MIT
"""Judges what several robots built, by the trace alone: every block in its place relative to the structure's
own frame, at rest, and nothing deep or fast on the way."""

import dataclasses
import math

import geometry
import judge

PITCH = 0.078  # distance of columns [m]

# Height of each column by its place in columns from the seed, in the seed's frame, for each rule table.
STRUCTURES = {
    "rules_cross": {(0, 0): 2, (1, 0): 1, (0, 1): 1, (-1, 0): 1, (0, -1): 1},
    "rules_stairs": {(0, 0): 3, (1, 0): 2, (2, 0): 1},
    "rules_pyramid": {(i, j): 3 - abs(i) - abs(j) for i in (-1, 0, 1) for j in (-1, 0, 1)},
}


@dataclasses.dataclass
class Limits(judge.Limits):
    aside: float = 0.004             # of a block from its place, horizontally [m]
    turn: float = math.radians(3)    # about z from the structure's axes


def yaw(pose):
    return math.atan2(pose.column(0)[1], pose.column(0)[0])


def nearest_turn(angle):
    """The same angle within an eighth of a turn of 0, modulo a quarter: blocks have four equal sides."""
    return (angle + math.pi / 4) % (math.pi / 2) - math.pi / 4


def fit(pairs):
    """(x, y, angle) of the rigid motion that moves the first points of the pairs next to the second."""
    count = len(pairs)
    px, py, qx, qy = (sum(pair[k][n] for pair in pairs) / count for k in (0, 1) for n in (0, 1))
    along = sum((p[0] - px) * (q[0] - qx) + (p[1] - py) * (q[1] - qy) for p, q in pairs)
    across = sum((p[0] - px) * (q[1] - qy) - (p[1] - py) * (q[0] - qx) for p, q in pairs)
    angle = math.atan2(across, along) if count > 1 else 0.0
    c, s = math.cos(angle), math.sin(angle)
    return qx - c * px + s * py, qy - s * px - c * py, angle


def places_of(heights):
    """{(i, j, level)} of all blocks."""
    return {(i, j, level) for (i, j), height in heights.items() for level in range(height)}


def judge_places(poses, heights, limits, verdict):
    """poses: of all blocks at the end, the seed's first. Each place has one block, near enough."""
    seed = poses[0]
    c, s = math.cos(yaw(seed)), math.sin(yaw(seed))
    ox, oy, oz = geometry.centre(seed)
    found = {}
    for pose in poses:
        x, y, z = geometry.centre(pose)
        dx, dy = x - ox, y - oy
        place = (round((c * dx + s * dy) / PITCH), round((-s * dx + c * dy) / PITCH),
                 round((z - oz) / judge.BLOCK))
        found.setdefault(place, []).append(pose)
    wanted = places_of(heights)
    if set(found) != wanted:
        verdict.faults.append(f"missing {sorted(wanted - set(found))}, "
                              f"not in its place {sorted(set(found) - wanted)}")
    placed = [(place, pose) for place, here in sorted(found.items()) for pose in here if place in wanted]
    if len(placed) > len({place for place, _ in placed}):
        verdict.faults.append("two blocks in one place")
    x, y, angle = fit([((PITCH * place[0], PITCH * place[1]), geometry.centre(pose)[:2])
                       for place, pose in placed])
    c, s = math.cos(angle), math.sin(angle)
    verdict.aside, verdict.height, verdict.turn = 0.0, 0.0, 0.0
    for place, pose in placed:
        px, py = PITCH * place[0], PITCH * place[1]
        bx, by, bz = geometry.centre(pose)
        aside = math.dist((x + c * px - s * py, y + s * px + c * py), (bx, by))
        height = bz - judge.BLOCK * (place[2] + 0.5)
        turn = nearest_turn(yaw(pose) - angle)
        verdict.aside = max(verdict.aside, aside)
        verdict.height = max(verdict.height, abs(height))
        verdict.turn = max(verdict.turn, abs(turn))
        if aside > limits.aside:
            verdict.faults.append(f"the block at {place} is {1000 * aside:.1f} mm off")
        if abs(height) > limits.height or pose.column(2)[2] < math.cos(math.radians(2)):
            verdict.faults.append(f"the block at {place} is {1000 * height:+.1f} mm high or tilted")
        if abs(turn) > limits.turn:
            verdict.faults.append(f"the block at {place} is turned by {math.degrees(turn):.1f} degrees")


def judge_robots(ticks, scene, limits, verdict):
    """Depth of overlaps between robots; cylinders count as the boxes around them."""
    links = {entity: [(key, link) for key, link in scene.links.items() if key[0] == entity]
             for entity in scene.robots}
    for time, poses in ticks:
        for n, one in enumerate(scene.robots):
            for other in scene.robots[:n]:
                if math.dist(poses[one, ""].position, poses[other, ""].position) > 0.3:
                    continue
                depth = max(geometry.box_overlap(a, poses[ka], b, poses[kb])
                            for ka, a in links[one] for kb, b in links[other])
                if depth > verdict.depth:
                    verdict.depth = depth
                    if depth > limits.depth:
                        verdict.faults.append(
                            f"{1000 * depth:.2f} mm deep: {one} and {other} at {time:g} s")


def finished_at(ticks):
    """The time from which on the blocks are where they are at the end, within 1 mm [s]."""
    last = ticks[-1][1]
    blocks = [key for key in last if key[0].startswith("block") and key[1] == ""]
    for time, poses in reversed(ticks):
        if any(math.dist(poses[key].position, last[key].position) > 0.001 for key in blocks):
            return time
    return 0.0


def judge_structure(scene_file, trace_file, table, limits=Limits()):
    """The verdict on a run of a scene with a rule table; its `turn` is the greatest angle [rad], `finished`
    the time when the last block was in place [s]."""
    scene = geometry.read_scene(scene_file)
    ticks = judge.read_trace(trace_file)
    verdict = judge.Verdict([])
    last = ticks[-1][1]
    judge_places([last[key] for key in scene.blocks], STRUCTURES[table], limits, verdict)
    judge.judge_rest(ticks, scene, limits, verdict)
    judge.judge_motion(ticks, scene, limits, verdict)
    judge_robots(ticks, scene, limits, verdict)
    verdict.finished = finished_at(ticks)
    return verdict
