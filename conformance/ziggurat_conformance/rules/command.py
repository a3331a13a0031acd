# SPDX-License-Identifier: MIT
"""What a server refuses of a Command or a Leave (S6 to S8, S11, D0 to D7, D13, L1)."""

import math
import re
from dataclasses import replace
from typing import Collection, Iterable, Iterator

from ..wire import protocol
from .fault import Fault

LONGEST_TAG = 64 << 10  # [bytes]
LONGEST_RADIO_MESSAGE = 1 << 20  # [bytes]
LONGEST_RADIO_MESSAGES = 16 << 20  # [bytes] of a robot at a tick
MOST_RADIO_MESSAGES = 1 << 16  # of a robot at a tick
_BRIGHTEST = 0xFFFFFF
_LARGEST_MARKER, _LONGEST_MARKER = 1e6, 100  # [m], [bytes]
_METRIC = re.compile("[A-Za-z0-9_.-]{1,64}")
_MODES = (protocol.TURRET_PASSIVE, protocol.TURRET_POSITION, protocol.TURRET_SPEED)


def _data_size(robot: protocol.RobotDescription) -> int:
    return robot.range_and_bearing.data_size if robot.range_and_bearing.sends else 0


def _device_commands(robot: protocol.RobotDescription) -> list:
    """The field of each value of `device_commands`."""
    return [field for kind in robot.device_kinds for _ in kind.devices for field in kind.commands]


# Field of Command → how many values a robot has there.
PER_ROBOT = {
    "joint_targets": lambda robot: len(robot.joint_actuators),
    "led_colors": lambda robot: len(robot.leds),
    "directional_led_colors": lambda robot: len(robot.directional_leds),
    "tag_payloads": lambda robot: len(robot.tags),
    "magnet_currents": lambda robot: len(robot.magnets),
    "range_and_bearing_data": _data_size,
    "wheel_velocities": lambda robot: 2 * robot.wheels.drives,
    "turret_modes": lambda robot: int(robot.turret.drives),
    "turret_rotations": lambda robot: int(robot.turret.drives),
    "turret_speeds": lambda robot: int(robot.turret.drives),
    "device_commands": lambda robot: len(_device_commands(robot)),
}
_FINITE = ("joint_targets", "magnet_currents", "wheel_velocities", "turret_rotations", "turret_speeds", "device_commands")
_COLORS = ("led_colors", "directional_led_colors")


def command_faults(robots: list, left: Collection[int], command: protocol.Command) -> list:
    """Everything that is wrong with the values of a Command; its tick is judged elsewhere.

    robots  the session's RobotDescriptions, in Welcome's order
    left    positions of those that have left
    """
    faults = list(_position_faults(len(robots), left, command.robots))
    if not faults:
        spoken_for = [robots[position] for position in command.robots] or robots
        faults += [*_length_faults(spoken_for, command), *_radio_faults(robots, left, command),
                   *_limit_faults(spoken_for, command)]
    return [*faults, *_value_faults(command), *_marker_faults(command), *log_faults(len(robots), command.log)]


def leave_faults(count: int, left: Collection[int], leave: protocol.Leave) -> list:
    """Everything that is wrong with a Leave of a session with so many robots."""
    faults = [replace(fault, rule="L1") for fault in _position_faults(count, left, leave.robots)]
    if leave.reason not in (protocol.Leave.DONE, protocol.Leave.FAILED):
        faults.append(Fault("L1", f"a Leave has the reason {leave.reason}; DONE or FAILED is expected",
                            "BAD_VALUE", "reason"))
    return [*faults, *log_faults(count, leave.log)]


def metric_faults(count: int, metrics: Iterable) -> Iterator[Fault]:
    for metric in metrics:
        if metric.robot >= count:
            yield Fault("S14", f"a metric is of position {metric.robot}; the session has {count} robots",
                        "UNKNOWN_ROBOT", "metrics")
        if not _METRIC.fullmatch(metric.name):
            yield Fault("S14", f"{metric.name!r} is no name of a metric", "BAD_VALUE", "metrics")
        if not math.isfinite(metric.value):
            yield Fault("S14", f"the metric {metric.name} is not finite", "BAD_VALUE", "metrics")


def log_faults(count: int, lines: Iterable) -> Iterator[Fault]:
    for line in lines:
        if line.robot >= count:
            yield Fault("S11", f"a log line is of position {line.robot}; the session has {count} robots",
                        "UNKNOWN_ROBOT", "log")
        if line.text.endswith("\n"):
            yield Fault("S11", "a log line ends with a line feed", should=True)


def _position_faults(count: int, left: Collection[int], positions: Iterable[int]) -> Iterator[Fault]:
    seen = set()
    for position in positions:
        if position >= count:
            yield Fault("S7", f"position {position} is named; the session has {count} robots",
                        "UNKNOWN_ROBOT", "robots")
        elif position in seen:
            yield Fault("S7", f"position {position} is named twice", "BAD_VALUE", "robots")
        elif position in left:
            yield Fault("S7", f"position {position} is named, which has left", "NOT_YOURS", "robots")
        seen.add(position)


def _length_faults(spoken_for: list, command: protocol.Command) -> Iterator[Fault]:
    for field, count_of in PER_ROBOT.items():
        found, expected = len(getattr(command, field)), sum(map(count_of, spoken_for))
        if found not in (0, expected):
            yield Fault("S6", f"{field} has {found} values; none or {expected} are expected", "BAD_VALUE",
                        field)


def _limit_faults(spoken_for: list, command: protocol.Command) -> Iterator[Fault]:
    fields = [field for robot in spoken_for for field in _device_commands(robot)]
    if any(not field.least <= value <= field.most for field, value in zip(fields, command.device_commands)):
        yield Fault("D13", "a value of device_commands is beyond its limits", "BAD_VALUE", "device_commands")


def _is_marker(marker: protocol.Marker) -> bool:
    shapes = [len(marker.to) > 0, marker.radius != 0, marker.text != ""]
    numbers = [*marker.at, *marker.to, marker.radius]
    return (len(marker.at) == 3 and len(marker.to) in (0, 3) and sum(shapes) == 1 and marker.radius >= 0
            and all(abs(number) <= _LARGEST_MARKER for number in numbers)
            and len(marker.text.encode()) <= _LONGEST_MARKER and marker.color <= _BRIGHTEST)


def _marker_faults(command: protocol.Command) -> Iterator[Fault]:
    for marker in command.markers:
        if not _is_marker(marker):
            yield Fault("D14", "a marker has no place, shape or colour", "BAD_VALUE", "markers")


def _value_faults(command: protocol.Command) -> Iterator[Fault]:
    for field in _FINITE:
        if not all(map(math.isfinite, getattr(command, field))):
            yield Fault("S8", f"a value of {field} is not finite", "BAD_VALUE", field)
    for field in _COLORS:
        if any(color > _BRIGHTEST for color in getattr(command, field)):
            yield Fault("D0", f"a value of {field} is above 0xFFFFFF", "BAD_VALUE", field)
    if any(len(payload) > LONGEST_TAG for payload in command.tag_payloads):
        yield Fault("D0", f"a payload of a tag is longer than {LONGEST_TAG} bytes", "TOO_LARGE",
                    "tag_payloads")
    if any(mode not in _MODES for mode in command.turret_modes):
        yield Fault("D7", "a mode of a turret does not exist", "BAD_VALUE", "turret_modes")


def _radio_faults(robots: list, left: Collection[int], command: protocol.Command) -> Iterator[Fault]:
    radios = [(position, radio) for position, robot in enumerate(robots) for radio in robot.radios]
    sizes: dict[int, list] = {}  # robot → of its messages
    for message in command.radio_messages:
        if message.radio >= len(radios):
            yield _radio_fault("D1", f"radio {message.radio} is named; the session has {len(radios)}",
                               "UNKNOWN_DEVICE")
            return
        position, radio = radios[message.radio]
        if position in left:
            continue
        if not radio.sends:
            yield _radio_fault("D1", f"radio {message.radio} can't send", "UNKNOWN_DEVICE")
        if command.robots and position not in command.robots:
            yield _radio_fault("D1", f"radio {message.radio} is of a robot that the Command does not name",
                               "NOT_YOURS")
        if len(message.payload) > LONGEST_RADIO_MESSAGE:
            yield _radio_fault("D2", f"a radio message is longer than {LONGEST_RADIO_MESSAGE} bytes",
                               "TOO_LARGE")
        sizes.setdefault(position, []).append(len(message.payload))
    for position, of_robot in sizes.items():
        if sum(of_robot) > LONGEST_RADIO_MESSAGES or len(of_robot) > MOST_RADIO_MESSAGES:
            yield _radio_fault("D2", f"position {position} sends {len(of_robot)} radio messages of "
                               f"{sum(of_robot)} bytes at one tick", "TOO_LARGE")


def _radio_fault(rule: str, text: str, code: str) -> Fault:
    return Fault(rule, text, code, "radio_messages")
