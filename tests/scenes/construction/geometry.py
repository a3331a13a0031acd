# SPDX-License-Identifier: MIT
"""Shapes and poses of a construction scene: depth of overlaps, drift of joints."""

import dataclasses
import functools
import itertools
import math
import pathlib
import xml.etree.ElementTree as ElementTree


class Pose:
    """Pose of a link: the position of its bottom centre [m] and its rotation (w, x, y, z)."""

    __slots__ = ("position", "quaternion", "_rows")

    def __init__(self, position, quaternion):
        self.position, self.quaternion, self._rows = position, quaternion, None

    @property
    def rows(self):
        if self._rows is None:
            w, x, y, z = self.quaternion
            self._rows = (
                (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
                (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
                (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))
        return self._rows

    def column(self, i):
        return tuple(row[i] for row in self.rows)

    def apply(self, point):
        return tuple(p + dot(row, point) for p, row in zip(self.position, self.rows))

    def to_local(self, point):
        """Coordinates of a world point in this frame [m]."""
        away = tuple(a - b for a, b in zip(point, self.position))
        return tuple(dot(self.column(i), away) for i in range(3))


@dataclasses.dataclass
class Link:
    kind: str          # box, cylinder, sphere
    half: tuple        # half extents [m]; of a cylinder radius, radius, height / 2
    mass: float        # [kg]

    @functools.cached_property
    def reach(self):
        """From the middle to the farthest corner [m]."""
        return math.hypot(*self.half)


@dataclasses.dataclass
class Scene:
    links: dict        # (entity, link): Link
    joints: list       # (entity, id, type, parent, child, frame in parent, frame in child)
    blocks: list       # (entity, link) of the blocks' bodies
    robots: list       # entities with an end effector


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def vector(text):
    return tuple(float(part) for part in text.split(","))


def centre(pose, half_height=0.0275):
    """The centre of a block, or of another link with that half height [m]."""
    return pose.apply((0, 0, half_height))


# --- the scene ------------------------------------------------------------------------------------


def shape(link):
    kind = link.get("geometry")
    mass = float(link.get("mass"))
    if kind == "box":
        return Link(kind, tuple(side / 2 for side in vector(link.get("size"))), mass)
    radius = float(link.get("radius"))
    height = float(link.get("height")) / 2 if kind == "cylinder" else radius
    return Link(kind, (radius, radius, height), mass)


def prototypes(path, root):
    """(prototype, definition) of each prototype in the file; the definition is itself or its model."""
    models = {}
    for include in root.iter("include"):
        included = ElementTree.parse(pathlib.Path(path).parent / include.get("file")).getroot()
        for element in [included, *included.iter("prototype")]:
            if element.get("id"):
                models.setdefault(element.get("id"), element)
    for element in root.find("arena").iter("prototype"):
        yield element, models.get(element.get("model"), element)


def read_scene(path):
    root = ElementTree.parse(path).getroot()
    scene = Scene({}, [], [], [])
    for element, model in prototypes(path, root):
        entity = element.get("id")
        for link in model.find("links"):
            scene.links[entity, link.get("id")] = shape(link)
        for joint in model.find("joints"):
            parent, child = joint.find("parent"), joint.find("child")
            scene.joints.append((entity, joint.get("id"), joint.get("type"), parent.get("link"),
                                 child.get("link"), vector(parent.get("position", "0,0,0")),
                                 vector(child.get("position", "0,0,0"))))
        if (entity, "end_effector") in scene.links:
            scene.robots.append(entity)
        else:
            scene.blocks.append((entity, "base"))
    return scene


# --- overlaps -------------------------------------------------------------------------------------


def below_floor(link, pose):
    """Depth of a link's lowest point below z = 0 [m]; negative above."""
    middle = pose.apply((0, 0, link.half[2]))
    row = pose.rows[2]
    if link.kind == "box":
        reach = sum(abs(row[i]) * link.half[i] for i in range(3))
    elif link.kind == "cylinder":
        reach = math.hypot(row[0], row[1]) * link.half[0] + abs(row[2]) * link.half[2]
    else:
        reach = link.half[0]
    return reach - middle[2]


def box_overlap(a, pose_a, b, pose_b):
    """Smallest overlap of two boxes over the fifteen axes [m]; negative if they are apart."""
    between = tuple(q - p for p, q in zip(pose_a.apply((0, 0, a.half[2])),
                                          pose_b.apply((0, 0, b.half[2]))))
    axes_a = [pose_a.column(i) for i in range(3)]
    axes_b = [pose_b.column(i) for i in range(3)]
    least = math.inf
    for axis in itertools.chain(axes_a, axes_b,
                                (cross(p, q) for p in axes_a for q in axes_b)):
        length = math.sqrt(dot(axis, axis))
        if length < 1e-6:
            continue
        reach = (sum(abs(dot(axis, axes_a[i])) * a.half[i] for i in range(3)) +
                 sum(abs(dot(axis, axes_b[i])) * b.half[i] for i in range(3)))
        least = min(least, (reach - abs(dot(axis, between))) / length)
        if least < 0:
            return least
    return least


def deepest_overlap(scene, poses, before=None):
    """(depth, names) of the deepest overlap with the floor or of two entities' links. Cylinders
    count against other links as the boxes around them; spheres are inside their blocks. before: the
    poses of the tick before; what is at the same place as then is left out."""
    deepest, names = 0.0, ""
    solid = [(key, link) for key, link in scene.links.items() if link.kind != "sphere"]
    moved = {key for key, _ in solid if not before or before[key] is not poses[key]}
    for key, link in solid:
        depth = below_floor(link, poses[key]) if key in moved else 0.0
        if depth > deepest:
            deepest, names = depth, f"{'.'.join(key)} in the floor"
    middles = {key: centre(poses[key], link.half[2]) for key, link in solid}
    blocks = set(scene.blocks)
    for block in scene.blocks:
        link, pose, middle = scene.links[block], poses[block], middles[block]
        for key, other in solid:
            if block not in moved and key not in moved or key[0] == block[0] or key in blocks and key < block:
                continue
            if math.dist(middle, middles[key]) > link.reach + other.reach:
                continue
            depth = box_overlap(link, pose, other, poses[key])
            if depth > deepest:
                deepest, names = depth, f"{'.'.join(block)} and {'.'.join(key)}"
    return deepest, names


# --- joints and motion ----------------------------------------------------------------------------


class Joints:
    """Drift of joints: how far the two ends of each come apart. Ends of a prismatic joint may move along
    the parent's z axis."""

    def __init__(self, scene, start):
        self.joints = scene.joints
        self.start = {(entity, joint): start[entity, parent].to_local(start[entity, child].apply(at))
                      for entity, joint, _, parent, child, _, at in scene.joints}

    def drift(self, poses, before=None):
        most, name = 0.0, ""
        for entity, joint, kind, parent, child, _, at in self.joints:
            if before and before[entity, child] is poses[entity, child]:
                continue
            now = poses[entity, parent].to_local(poses[entity, child].apply(at))
            apart = [a - b for a, b in zip(now, self.start[entity, joint])]
            if kind == "prismatic":
                apart[2] = 0
            if math.dist((0, 0, 0), apart) > most:
                most, name = math.dist((0, 0, 0), apart), f"{entity}.{joint}"
        return most, name


def fastest(scene, before, now, seconds):
    """(kinetic energy [J], name) of the link with the greatest one between two ticks."""
    most, name = 0.0, ""
    for key, link in scene.links.items():
        if link.kind == "sphere" or key not in now or before[key] is now[key]:
            continue
        speed = math.dist(centre(before[key], link.half[2]),
                          centre(now[key], link.half[2])) / seconds
        energy = link.mass * speed * speed / 2
        if energy > most:
            most, name = energy, ".".join(key)
    return most, name
