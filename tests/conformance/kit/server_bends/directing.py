# SPDX-License-Identifier: MIT
"""Bends of directors (section 9.1)."""

from .kinds import E, SAID, TOLD, clear_fields, drop, in_kind, refill, said

TOLD["layout-not-told"] = drop("world_layout")
TOLD["poses-cut"] = in_kind("world_state", lambda _, state: refill(state, "poses", state.poses[:-7]))
TOLD["other-groups"] = in_kind("world_state", lambda _, state: state.magnets.append(1.0))
TOLD["places-from-1"] = in_kind("world_layout", lambda _, layout: setattr(layout, "first", layout.first + 1))
TOLD["left-out-without-a-word"] = drop("error", E.BAD_VALUE)
SAID["acts-not-done"] = clear_fields("direction", "acts")
SAID["wrong-acts-left-out"] = in_kind("direction", lambda _, direction: refill(
    direction, "acts", [act for act in direction.acts if act.remove.entity != "nobody"]))
SAID["finish-not-heard"] = clear_fields("direction", "finish")
SAID["results-cut"] = in_kind("direction", lambda _, direction: setattr(
    direction.finish, "result", direction.finish.result[:1024]) if direction.HasField("finish") else None)
SAID["metrics-not-checked"] = clear_fields("direction", "metrics")
SAID["leaves-robots"] = clear_fields("leave", "robots")
SAID["any-subscription"] = in_kind("hello", lambda _, hello: refill(
    hello.subscription, "entities", hello.subscription.entities[:64]) if hello.HasField("subscription") else None)


@said("any-director-id")
def _(connection, message):
    if message.HasField("hello"):
        message.hello.director = message.hello.director.replace(" ", "_")


@said("later-directors")
def _(connection, message):
    if message.HasField("hello") and message.hello.director:
        message.hello.version.minor = 4


@said("commands-direct")
def _(connection, message):
    if message.HasField("command") and connection.hello is not None and connection.hello.director:
        tick = message.command.tick
        message.direction.tick = tick
