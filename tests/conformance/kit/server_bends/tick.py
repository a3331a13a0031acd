# SPDX-License-Identifier: MIT
"""Bends of sections 3 and 3.1: the tick, devices."""

import os
import sys

import protocol_pb2 as protocol

from .kinds import (E, SAID, TOLD, clear_fields, drop, each_value, finite, in_kind, per_device, recode, refill,
                    said, shorter, told)

TOLD["time-in-ms"] = in_kind("observation", lambda _, told: setattr(told, "time_ns", told.time_ns // 1000))


@told("doubles-ticks")
def _(connection, message):
    if message.HasField("observation"):
        message.observation.tick *= 2


@said("doubles-ticks")
def _(connection, message):
    if message.HasField("command"):
        message.command.tick //= 2


@told("tells-twice")
def _(connection, message):
    return [message, message] if message.HasField("observation") else None


@said("dies")
def _(connection, message):
    """Of a Command for an earlier tick."""
    if message.HasField("command") and message.command.tick < connection.tick:
        print("goodbye", file=sys.stderr, flush=True)
        os._exit(1)


@told("no-tick-zero")
def _(connection, message):
    if message.HasField("observation") and message.observation.tick == 0:
        connection.say(command=protocol.Command(tick=0))
        return []
    return None


for _field in ("joint_readings", "proximity", "positioning", "batteries"):
    TOLD[f"short-{_field}"] = shorter(_field)


@said("left-are-unpacked")
def _(connection, message):
    if message.HasField("leave"):
        connection.notes["left"] = True


@told("left-are-unpacked")
def _(connection, message):
    if message.HasField("observation") and connection.notes.get("left"):
        del message.observation.joint_readings[1]


@said("heartbeat-is-an-answer")
def _(connection, message):
    if message.HasField("heartbeat"):
        connection.say(command=protocol.Command(tick=connection.tick))


@told("refused-is-an-answer")
def _(connection, message):
    if message.HasField("error") and message.error.severity == E.DISCARD:
        connection.say(command=protocol.Command(tick=connection.tick))


@said("applies-a-tick-late")
def _(connection, message):
    if message.HasField("command"):
        held, connection.notes["held"] = connection.notes.get("held", []), list(message.command.joint_targets)
        refill(message.command, "joint_targets", held)


@said("forgets-values")
def _(connection, message):
    if message.HasField("command") and not message.command.joint_targets:
        message.command.joint_targets.extend([0.0] * len(connection.welcome.robots))


@said("empty-is-refused")
def _(connection, message):
    if message.HasField("command") and message.command.ByteSize() < 12:
        connection.tell(error=E(code=E.BAD_VALUE, severity=E.DISCARD, message="empty"))
        return []
    return None


SAID["pads-joint-targets"] = per_device("joint_targets", "joint_actuators", 0.0)
SAID["pads-leds"] = per_device("led_colors", "leds", 0)
SAID["pads-beams"] = per_device("directional_led_colors", "directional_leds", 0)
SAID["pads-tags"] = per_device("tag_payloads", "tags", b"")
SAID["pads-currents"] = per_device("magnet_currents", "magnets", 0.0)
SAID["drops-positions-beyond"] = in_kind("command", lambda connection, command: refill(
    command, "robots", [p for p in command.robots if p < len(connection.welcome.robots)]))
SAID["a-position-once"] = in_kind("command", lambda _, command: refill(command, "robots", sorted(set(command.robots))))
SAID["left-are-ignored"] = clear_fields("command", "robots")
SAID["nan-is-zero"] = each_value("joint_targets", finite)
SAID["infinite-currents"] = each_value("magnet_currents", finite)
SAID["any-tick"] = in_kind("command", lambda connection, command: setattr(command, "tick", connection.tick))
TOLD["stale-is-silent"] = drop("error", E.STALE_TICK)
TOLD["future-is-stale"] = recode("error", E.FUTURE_TICK, E.STALE_TICK)
TOLD["duplicate-is-silent"] = drop("error", E.DUPLICATE_TICK)


@told("half-a-command")
def _(connection, message):
    if message.HasField("error") and message.error.severity == E.DISCARD:
        connection.notes["radio"] = True


@said("half-a-command")
def _(connection, message):
    """Radio messages of a Command that was refused go out with the next."""
    if message.HasField("command"):
        if connection.notes.pop("radio", False):
            message.command.radio_messages.add(radio=0, payload=b"lost")


SAID["lines-beyond-dropped"] = in_kind("command", lambda connection, command: refill(
    command, "log", [line for line in command.log if line.robot < len(connection.welcome.robots)]))
SAID["colours-cut"] = each_value("led_colors", lambda color: color & 0xFFFFFF)
SAID["beams-cut"] = each_value("directional_led_colors", lambda color: color & 0xFFFFFF)
SAID["tags-cut"] = each_value("tag_payloads", lambda payload: payload[:65536])


@said("long-tags-refused")
def _(connection, message):
    if any(len(payload) > 65535 for payload in message.command.tag_payloads):
        connection.tell(error=E(code=E.TOO_LARGE, severity=E.DISCARD, field="tag_payloads", message="long"))
        return []
    return None


SAID["bearing-dropped"] = in_kind("command", lambda _, command: command.ClearField("range_and_bearing_data"))


def _messages(keep):
    return in_kind("command", lambda connection, command: refill(
        command, "radio_messages", [m for m in command.radio_messages if keep(command, m)]))


SAID["radios-beyond-ignored"] = _messages(lambda _, message: message.radio < 4)
SAID["any-radio"] = in_kind("command", lambda _, command: command.ClearField("robots")
                        if command.radio_messages else None)
SAID["long-messages-ignored"] = _messages(lambda _, message: len(message.payload) <= 2**20)
SAID["longest-messages-lost"] = _messages(lambda _, message: len(message.payload) < 2**20)
SAID["many-messages-cut"] = in_kind("command", lambda _, command: refill(
    command, "radio_messages", command.radio_messages[:1000]))
SAID["empty-messages-lost"] = _messages(lambda _, message: message.payload)
TOLD["messages-reversed"] = in_kind("observation", lambda _, told: refill(
    told, "radio_messages", reversed(told.radio_messages)))


@told("senders-reversed")
def _(connection, message):
    """Ascending by receiver, but not by sender."""
    if message.HasField("observation"):
        refill(message.observation, "radio_messages",
                sorted(reversed(message.observation.radio_messages), key=lambda m: m.radio))


@told("messages-twice")
def _(connection, message):
    if message.HasField("observation"):
        heard = list(message.observation.radio_messages)
        message.observation.radio_messages.extend(connection.notes.get("heard", []))
        connection.notes["heard"] = heard


TOLD["packets-reversed"] = in_kind("observation", lambda _, told: refill(
    told, "range_and_bearing", reversed(told.range_and_bearing)))
TOLD["packets-lost"] = in_kind("observation", lambda _, told: told.ClearField("range_and_bearing")
                           if told.tick % 2 else None)
TOLD["packets-cut"] = in_kind("observation", lambda _, told: [setattr(p, "data", p.data[:1])
                                                         for p in told.range_and_bearing] and None)


@said("wheels-stop")
def _(connection, message):
    if message.HasField("command") and not message.command.wheel_velocities:
        message.command.wheel_velocities.extend([0.0] * 4)


@said("wheels-swapped")
def _(connection, message):
    values = list(message.command.wheel_velocities)
    if values:
        refill(message.command, "wheel_velocities", [v for i in range(0, len(values), 2)
                                                      for v in (values[i + 1], values[i])])


SAID["wheels-finite"] = each_value("wheel_velocities", finite)
SAID["any-turret-mode"] = each_value("turret_modes", lambda mode: mode if mode in (1, 2, 3) else 1)
TOLD["wheels-lost"] = shorter("wheels")
TOLD["counts-of-cameras"] = in_kind("observation", lambda _, told: told.ClearField("led_counts"))
TOLD["seen-lost"] = in_kind("observation", lambda _, told: told.ClearField("led_colors"))
TOLD["picture-at-tick-0"] = in_kind("observation", lambda _, told: refill(
    told, "camera_images", [bytes(576)] if told.camera_images else []))
TOLD["picture-cut"] = in_kind("observation", lambda _, told: refill(
    told, "camera_images", [image[:-3] for image in told.camera_images]))
TOLD["imus-of-three"] = in_kind("observation", lambda _, told: refill(told, "imus", told.imus[:3]))
TOLD["device-readings-lost"] = in_kind("observation", lambda _, told: told.ClearField("device_readings"))
TOLD["device-rows-lost"] = in_kind("observation", lambda _, told: told.ClearField("device_row_values"))
TOLD["contacts-lost"] = in_kind("observation", lambda _, told: told.ClearField("contact_sensors"))
