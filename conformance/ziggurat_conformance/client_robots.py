# SPDX-License-Identifier: MIT
"""Robots that the kit plays to a client, and what they read."""

from typing import Iterable

from .rules.observation import PER_ROBOT
from .server_scene import IDLE_SCRIPT

_JOINT = {"id": "hinge", "mode": "POSITION"}
_MOTOR = {"id": "hinge", "mode": "VELOCITY", "max_impulse": 0.01}


def robot(id: str) -> dict:
    """An arm as our scene has it."""
    return {
        "id": id, "controller": "steady", "script": IDLE_SCRIPT,
        "params": [{"name": "speed", "value": "0.5"}, {"name": "script", "value": "idle.lua"}],
        "joint_sensors": [_JOINT], "joint_actuators": [_MOTOR],
        "radios": [{"id": "mouth", "range": 3.0, "sends": True, "receives": True}],
        "leds": [{"id": "lamp", "color": 0xFF0000}],
        "directional_leds": [{"id": "beam", "color": 0x00FF00}],
        "tags": [{"id": "label", "payload": b"0"}],
        "magnets": [{"id": "coil"}],
        "proximity_sensors": [{"anchor": "hand", "position": [0.05, 0.0, 0.02],
                               "direction": [1.0, 0.0, 0.0], "range": 0.2}],
        "range_and_bearing": {"range": 3.0, "data_size": 2, "sends": True, "receives": True},
        "positioning": True, "battery": True,
    }


def rover(id: str) -> dict:
    """An arm on wheels, with a turret and a camera that has all detectors and takes pictures."""
    return {
        **robot(id),
        "cameras": [{"id": "eye", "anchor": "origin", "position": [0.1, 0.0, 0.2],
                     "orientation": [0.5, -0.5, 0.5, -0.5], "near": 0.1, "far": 2.0,
                     "focal_length": [800.0, 800.0], "principal_point": [2.0, 1.0], "width": 4,
                     "height": 2, "detects_leds": True, "detects_directional_leds": True,
                     "detects_tags": True, "image": True}],
        "wheels": {"axle_length": 0.14, "drives": True, "measures": True},
        "turret": {"drives": True, "measures": True},
        "contact_sensors": [{"id": "skin", "anchor": "base"}],
        "device_kinds": [
            {"name": "lamp", "readings": [{"name": "value"}], "properties": [{"name": "angle", "unit": "rad"}],
             "commands": [{"name": "power", "unit": "W", "least": 0.0, "most": 2.0, "initial": 1.0}],
             "devices": [{"anchor": "origin", "position": [0.0, 0.0, 0.1], "orientation": [1.0, 0.0, 0.0, 0.0],
                          "properties": [0.5]}] * 2},
            {"name": "unheard-of", "readings": [{"name": "x"}, {"name": "y", "unit": "m"}], "most_rows": 3,
             "devices": [{"id": "only", "anchor": "base", "position": [0.0] * 3,
                          "orientation": [1.0, 0.0, 0.0, 0.0]}]}],
        "imus": [{"id": "imu", "anchor": "base", "position": [0.0, 0.0, 0.1],
                  "orientation": [1.0, 0.0, 0.0, 0.0]}],
    }


# Readings of one sensor, after tick 0 and at tick 0 (S1).
_VALUES = {
    "joint_readings": ([0.25], [0.0]), "proximity": ([0.5], [0.0]),
    "positioning": ([0.1, 0.2, 0.3, 1.0, 0.0, 0.0, 0.0],) * 2, "batteries": ([1.0, 9.0],) * 2,
    "led_counts": ([0],) * 2, "directional_led_counts": ([0],) * 2, "tag_counts": ([0],) * 2,
    "wheels": ([0.1, 0.2, 0.01, 0.02], [0.0] * 4), "turret_rotations": ([0.5],) * 2,
    "imus": ([0.1, -0.2, 9.8, 0.0, 0.0, 1.0],) * 2,
    "contact_sensors": ([1.0, 0.0, 0.5, 9.8, 10.0], [0.0] * 5),
    "device_readings": ([0.25], [0.0]), "device_rows": ([2], [0]),
}


def readings(robots: Iterable, tick: int) -> dict:
    """Fields of an Observation with a reading for each sensor of these RobotDescriptions."""
    told = {}
    for field, values in _VALUES.items():
        one = values[tick == 0]
        told[field] = one * (sum(map(PER_ROBOT[field], robots)) // len(one))
    told["device_row_values"] = [0.5, -1.5, 2.5, 3.5] * (len(told["device_rows"]) if tick else 0)
    told["camera_images"] = [bytes(3 * camera.width * camera.height) if tick else b""
                             for robot in robots for camera in robot.cameras if camera.image]
    return told


def sights(led: int = 0, directional_led: int = 0, tag: int = 0) -> dict:
    """What two rovers detect: the first sees nothing, the second so many of each."""
    seen = {"tag_payloads": [b"\0\xff"] * tag, "tag_corners": [0.5] * 8 * tag}
    for name, count in (("led", led), ("directional_led", directional_led), ("tag", tag)):
        seen[f"{name}_counts"] = [0, count]
        seen[f"{name}_centers"] = [1.5, -2.5] * count
    for name, count in (("led", led), ("directional_led", directional_led)):
        seen[f"{name}_colors"] = [0xFF8001] * count
    return seen
