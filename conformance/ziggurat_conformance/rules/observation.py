# SPDX-License-Identifier: MIT
"""What an Observation and a Welcome must hold (S1, S2, D3 to D12, H9, H14)."""

from typing import Callable, Iterator

from ..wire import protocol
from .command import command_faults
from .fault import Fault

_BRIGHTEST = 0xFFFFFF
NS_PER_S = 1_000_000_000


def _detecting(kind: str) -> Callable:
    return lambda robot: sum(getattr(camera, f"detects_{kind}") for camera in robot.cameras)


# Field of Observation → how many values a robot has there, whether it has left or not.
PER_ROBOT = {
    "joint_readings": lambda robot: len(robot.joint_sensors),
    "proximity": lambda robot: len(robot.proximity_sensors),
    "positioning": lambda robot: 7 * robot.positioning,
    "batteries": lambda robot: 2 * robot.battery,
    "led_counts": _detecting("leds"),
    "directional_led_counts": _detecting("directional_leds"),
    "tag_counts": _detecting("tags"),
    "camera_images": lambda robot: sum(camera.image for camera in robot.cameras),
    "wheels": lambda robot: 4 * robot.wheels.measures,
    "turret_rotations": lambda robot: int(robot.turret.measures),
    "imus": lambda robot: 6 * len(robot.imus),
    "contact_sensors": lambda robot: 5 * len(robot.contact_sensors),
    "device_readings": lambda robot: sum(len(kind.readings) * len(kind.devices)
                                         for kind in robot.device_kinds if not kind.most_rows),
    "device_rows": lambda robot: sum(len(kind.devices) for kind in robot.device_kinds if kind.most_rows),
}

# Field of Observation → the counts that it belongs to, values for each reading.
_PER_READING = {
    "led_colors": ("led_counts", 1), "led_centers": ("led_counts", 2),
    "directional_led_colors": ("directional_led_counts", 1),
    "directional_led_centers": ("directional_led_counts", 2),
    "tag_payloads": ("tag_counts", 1), "tag_centers": ("tag_counts", 2), "tag_corners": ("tag_counts", 8),
}


def time_of(tick: int, ticks_per_second: int) -> int:
    """Simulated [ns]."""
    return (2 * tick * NS_PER_S + ticks_per_second) // (2 * ticks_per_second)


def observation_faults(welcome: protocol.Welcome, told: protocol.Observation) -> Iterator[Fault]:
    """Everything that is wrong with an Observation, whatever was told before."""
    robots = welcome.robots
    expected_time = time_of(told.tick, welcome.ticks_per_second) if welcome.ticks_per_second else 0
    if welcome.ticks_per_second and told.time_ns != expected_time:
        yield Fault("S1", f"time_ns of tick {told.tick} is {told.time_ns}; {expected_time} is expected")
    for field, count_of in PER_ROBOT.items():
        found, expected = len(getattr(told, field)), sum(map(count_of, robots))
        if found != expected:
            yield Fault("S2", f"{field} has {found} values; {expected} are expected")
    for field, (counts, per) in _PER_READING.items():
        found, expected = len(getattr(told, field)), per * sum(getattr(told, counts))
        if found != expected:
            yield Fault("D8", f"{field} has {found} values; {expected} are expected by {counts}")
    yield from _row_faults(robots, told)
    if any(color > _BRIGHTEST for color in (*told.led_colors, *told.directional_led_colors)):
        yield Fault("D8", "a colour is above 0xFFFFFF")
    yield from _radio_faults(robots, told)
    yield from _packet_faults(robots, told)
    yield from _image_faults(robots, told)


def _row_faults(robots, told: protocol.Observation) -> Iterator[Fault]:
    lists = [kind for robot in robots for kind in robot.device_kinds if kind.most_rows for _ in kind.devices]
    expected = sum(rows * len(kind.readings) for kind, rows in zip(lists, told.device_rows))
    if len(told.device_row_values) != expected:
        yield Fault("D12", f"device_row_values has {len(told.device_row_values)} values; {expected} are expected by "
                    "device_rows")
    if any(rows > kind.most_rows for kind, rows in zip(lists, told.device_rows)):
        yield Fault("D12", "a device has more rows than its kind's most_rows")
    if told.tick == 0 and (any(told.device_rows) or any(told.device_readings)):
        yield Fault("D12", "there are readings of devices at tick 0")


def _radio_faults(robots, told: protocol.Observation) -> Iterator[Fault]:
    radios = [radio for robot in robots for radio in robot.radios]
    receivers = [message.radio for message in told.radio_messages]
    if receivers != sorted(receivers):
        yield Fault("D3", "radio messages do not ascend by the receiving radio")
    if any(radio >= len(radios) or not radios[radio].receives for radio in receivers):
        yield Fault("D3", "a message is received by a radio that does not receive")


def _packet_faults(robots, told: protocol.Observation) -> Iterator[Fault]:
    receivers = [packet.robot for packet in told.range_and_bearing]
    if receivers != sorted(receivers):
        yield Fault("D4", "range_and_bearing does not ascend by the receiving robot")
    for packet in told.range_and_bearing:
        device = robots[packet.robot].range_and_bearing if packet.robot < len(robots) else None
        if device is None or not device.receives:
            yield Fault("D4", f"a packet is received by position {packet.robot}, which has no such device")
        elif len(packet.data) != device.data_size:
            yield Fault("D4", f"a packet has {len(packet.data)} bytes; {device.data_size} are expected")


def _image_faults(robots, told: protocol.Observation) -> Iterator[Fault]:
    cameras = [camera for robot in robots for camera in robot.cameras if camera.image]
    for camera, image in zip(cameras, told.camera_images):
        expected = 3 * camera.width * camera.height
        if len(image) not in (0, expected) or (image and told.tick == 0):
            yield Fault("D0", f"the image of camera {camera.id!r} has {len(image)} bytes at tick "
                        f"{told.tick}; {expected} are expected, none at tick 0")


def _device_faults(robot) -> Iterator[Fault]:
    """What is wrong with the description of devices that describe themselves."""
    kinds = [kind.name for kind in robot.device_kinds]
    if len(set(kinds)) != len(kinds) or not all(kinds):
        yield Fault("D11", f"the kinds of devices of robot {robot.id!r} are {kinds}; each name is expected once")
    for kind in robot.device_kinds:
        for fields in (kind.readings, kind.commands, kind.properties):
            names = [field.name for field in fields]
            if len(set(names)) != len(names) or not all(names):
                yield Fault("D11", f"fields of {kind.name!r} are named {names}; each name is expected once")
        if any(len(device.properties) != len(kind.properties) for device in kind.devices):
            yield Fault("D11", f"a device of kind {kind.name!r} has not one number for each property")
        if any(not field.least <= value <= field.most
               for field in kind.commands for value in (field.initial, field.released)):
            yield Fault("D13", f"a command of {kind.name!r} begins or is released beyond its limits")


def _resumed_faults(hello: protocol.Hello, welcome: protocol.Welcome) -> Iterator[Fault]:
    if not welcome.HasField("resumed"):
        if hello.session_token and welcome.version.minor >= 1:
            yield Fault("L13", "the Welcome of a resumed session has no `resumed`")
        return
    if not hello.session_token:
        yield Fault("L13", "the Welcome of a new session has `resumed`")
    gone = list(welcome.resumed.gone_robots)
    if gone != sorted(set(gone)) or any(position >= len(welcome.robots) for position in gone):
        yield Fault("L13", f"gone_robots are {gone} of {len(welcome.robots)} robots")
    yield from commanded_faults("L13", list(welcome.robots), welcome.resumed.commanded)


def commanded_faults(rule: str, robots: list, commanded: protocol.Command) -> Iterator[Fault]:
    """What is wrong with the values that were commanded, as the server tells them of all robots."""
    if commanded.tick or commanded.robots or commanded.log or commanded.radio_messages:
        yield Fault(rule, "`commanded` has a tick, robots, log lines or radio messages")
    yield from (Fault(rule, f"`commanded` is no legal Command: {fault}")
                for fault in command_faults(robots, (), commanded))


def welcome_faults(hello: protocol.Hello, welcome: protocol.Welcome) -> Iterator[Fault]:
    """Everything that is wrong with the Welcome that answers this Hello."""
    if (welcome.version.major != hello.version.major or welcome.version.minor > hello.version.minor):
        yield Fault("H2", f"Welcome has the version {welcome.version.major}.{welcome.version.minor}")
    if welcome.role != hello.role:
        yield Fault("H14", f"the role {welcome.role} is granted; {hello.role} was asked for")
    if not welcome.max_message_bytes:
        yield Fault("T4", "max_message_bytes is 0")
    if not welcome.ticks_per_second or welcome.tick_ns != time_of(1, welcome.ticks_per_second):
        yield Fault("H9", f"tick_ns is {welcome.tick_ns} at {welcome.ticks_per_second} ticks a second")
    if welcome.mode not in (protocol.MODE_LOCK_STEP, protocol.MODE_HARDWARE_IN_THE_LOOP):
        yield Fault("H9", f"the mode is {welcome.mode}")
    if len(welcome.scene_hash) != 16 or set(welcome.scene_hash) - set("0123456789abcdef"):
        yield Fault("H9", f"the scene's hash is {welcome.scene_hash!r}; 16 hexadecimal digits are expected")
    if hello.session_token and welcome.session_token != hello.session_token:
        yield Fault("L4", "the Welcome of a resumed session has another token")
    yield from _resumed_faults(hello, welcome)
    ids = [robot.id for robot in welcome.robots]
    if len(set(ids)) != len(ids) or not all(ids):
        yield Fault("H9", f"the robots are {ids}; each id is expected once")
    yield from (fault for robot in welcome.robots for fault in _device_faults(robot))
    own = [robot.HasField("deadline_policy") for robot in welcome.robots]
    if any(own) and (welcome.HasField("deadline_policy") or not all(own)):
        yield Fault("H14", "the deadline policy is told for all robots and for some")
    if hello.role == protocol.ROLE_CONTROLLER:
        if not welcome.session_token:
            yield Fault("H9", "there is no session token")
        if not ids:
            yield Fault("H9", "a controller's session has no robots")
    elif ids:
        yield Fault("V1", "a session that drives no robots is told of some")
