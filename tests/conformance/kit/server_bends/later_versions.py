# SPDX-License-Identifier: MIT
"""Bends of what is new since version 1.0."""

import protocol_pb2 as protocol

from .supervision import done_without
from .kinds import E, SAID, TOLD, clear_fields, drop, in_kind, refill, said, set_fields, told

TOLD["dropped-not-told"] = drop("error", E.ROBOTS_DROPPED)
TOLD["dropped-beyond"] = in_kind("error", lambda _, error: error.dropped.robots.append(9)
                             if error.code == E.ROBOTS_DROPPED else None)
TOLD["dropped-is-fatal"] = in_kind("error", lambda _, error: setattr(error, "severity", E.FATAL)
                               if error.code == E.ROBOTS_DROPPED else None)
TOLD["resumed-not-told"] = clear_fields("welcome", "resumed")
TOLD["commanded-lost"] = in_kind("welcome", lambda _, welcome: welcome.resumed.commanded.ClearField("led_colors")
                             if welcome.HasField("resumed") else None)
TOLD["commanded-of-the-last"] = in_kind("welcome", lambda _, welcome: refill(
    welcome.resumed.commanded, "joint_targets", [0.0] * 4) if welcome.HasField("resumed") else None)
TOLD["commanded-too-long"] = in_kind("welcome", lambda _, welcome: welcome.resumed.commanded.joint_targets.append(0)
                                 if welcome.HasField("resumed") else None)
TOLD["gone-not-told"] = in_kind("welcome", lambda _, welcome: welcome.resumed.ClearField("gone_robots")
                            if welcome.HasField("resumed") else None)
TOLD["new-is-resumed"] = in_kind("welcome", lambda _, welcome: welcome.resumed.SetInParent()
                             if welcome.version.minor else None)
TOLD["spawned-not-told"] = drop("robot_spawned")


@told("spawned-told-to-all")
def _(connection, message):
    if message.HasField("response") and not message.response.HasField("error"):
        for other in connection.connections:
            if other.hello is not None and other.hello.version.minor and other is not connection:
                other.tell(robot_spawned=protocol.RobotSpawned(robot="arm9", controller="steady"))


@said("later-for-all")
def _(connection, message):
    if message.HasField("hello") and not message.hello.version.minor:
        message.hello.version.minor = 1
        connection.notes["earlier"] = True


@told("later-for-all")
def _(connection, message):
    if message.HasField("welcome") and connection.notes.get("earlier"):
        message.welcome.version.minor = 0


@said("seed-0-is-absent")
def _(connection, message):
    if message.request.HasField("reset") and not message.request.reset.seed:
        message.request.reset.ClearField("seed")


@said("moves-far")
def _(connection, message):
    if message.request.HasField("move"):
        refill(message.request.move, "position", [min(x, 1e6) for x in message.request.move.position])

TOLD["epoch-not-told"] = clear_fields("observation", "epoch")
SAID["any-epoch"] = clear_fields("command", "epoch")
SAID["later-epochs-count"] = in_kind("command", lambda _, command: command.ClearField("epoch")
                                     if command.epoch > 9 else None)
def _of_metrics(change):
    return in_kind("command", lambda _, command: [change(metric) for metric in command.metrics] and None)


SAID["any-metric-name"] = _of_metrics(lambda metric: setattr(metric, "name", "x"))
SAID["infinite-metrics"] = _of_metrics(lambda metric: setattr(metric, "value", 0))
SAID["metrics-of-any-robot"] = _of_metrics(lambda metric: setattr(metric, "robot", 0))
SAID["no-metric-is-right"] = _of_metrics(lambda metric: setattr(metric, "name", "a b"))
TOLD["restored-tick-plus-one"] = in_kind("restored", lambda _, restored: setattr(restored, "tick", restored.tick + 1))
TOLD["restored-to-epoch-0"] = set_fields("restored", epoch=0)
TOLD["restored-without-commanded"] = clear_fields("restored", "commanded")
TOLD["ever-new-epochs"] = in_kind("observation", lambda _, told: setattr(told, "epoch", told.tick)
                                  if told.HasField("epoch") else None)
TOLD["spawned-told-twice"] = lambda _, message: [message, message] if message.HasField("robot_spawned") else None
TOLD["restored-not-told"] = drop("restored")
SAID["restore-not-done"] = done_without("restore")
SAID["restores-all"] = in_kind("hello", lambda _, hello: setattr(hello, "can_restore", True))


@told("reset-begins-at-1")
def _(connection, message):
    if message.HasField("reset"):
        connection.notes["reset"] = True
    elif message.HasField("observation") and connection.notes.pop("reset", False):
        connection.say(command=protocol.Command(tick=0))
        return []
    return None


@said("any-name")
def _(connection, message):
    if message.request.HasField("snapshot"):
        message.request.snapshot.name = "any"
