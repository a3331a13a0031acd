# SPDX-License-Identifier: MIT
"""Bends of sections 1 and 2: transport, Hello."""

import json
import secrets

import protocol_pb2 as protocol

from .kinds import E, RAW, RAW_SAID, SAID, TOLD, clear_fields, drop, in_kind, recode, refill, said, set_fields, swap, told

RAW["two-frames"] = lambda data: [(data, b"")]
RAW["nul-behind"] = lambda data: [data if data[:1] == b"{" else data + b"\0"]
RAW["other-form"] = lambda data: [data[1:] if data[:1] == b"{" else data]


def _rewritten(change):
    """Of the JSON form."""
    def bend(data):
        return [json.dumps(change(json.loads(data))).encode()] if data[:1] == b"{" else [data]
    return bend


def _without_zeros(value):
    if isinstance(value, dict):
        return {name: _without_zeros(inner) for name, inner in value.items() if inner not in (0, "", False, [])}
    return value


def _numbers(value):
    if isinstance(value, dict):
        return {name: int(inner) if name in ("tick", "timeNs", "seed") else _numbers(inner)
                for name, inner in value.items()}
    return value


def _snakes(value):
    if isinstance(value, dict):
        return {"".join("_" + c.lower() if c.isupper() else c for c in name): _snakes(inner)
                for name, inner in value.items()}
    return value


def _enum_numbers(value):
    if isinstance(value, dict):
        return {name: E.Severity.Value(inner) if name == "severity" else _enum_numbers(inner)
                for name, inner in value.items()}
    return value


RAW["json-leaves-zeros-out"] = _rewritten(_without_zeros)
RAW["json-numbers"] = _rewritten(_numbers)
RAW["json-snakes"] = _rewritten(_snakes)
RAW["json-enum-numbers"] = _rewritten(_enum_numbers)
RAW_SAID["json-refuses-texts"] = lambda data: [data.replace(b'["0.5"]', b"[true]")]
RAW_SAID["json-strips-texts"] = lambda data: [data.replace(b'" 5"', b'"5"')]


@said("unknown-fields-malformed")
def _(connection, message):
    if message.UnknownFields() or b"\x80\x7d\x07" in message.SerializeToString():
        connection.tell(error=E(code=E.MALFORMED, severity=E.DISCARD, message="unknown"))
        return []
    return None


TOLD["reorders"] = swap("heartbeat")
TOLD["no-limit"] = set_fields("welcome", max_message_bytes=0)
TOLD["too-large-is-silent"] = drop("error", E.TOO_LARGE)
TOLD["garbage-is-silent"] = drop("error", E.MALFORMED)
SAID["deaf-to-hello"] = drop("hello")
TOLD["client-version-lost"] = clear_fields("refusal", "client_version")
SAID["any-version"] = in_kind("hello", lambda _, hello: setattr(hello.version, "major", 1))
TOLD["minor-above"] = in_kind("welcome", lambda _, welcome: setattr(welcome.version, "minor", 9))


@said("any-role-of-the-future")
def _(connection, message):
    if message.HasField("hello") and message.hello.role > 3:
        message.hello.role = protocol.ROLE_CONTROLLER


@said("nothing-is-all")
def _(connection, message):
    hello = message.hello
    if message.HasField("hello") and not (hello.robots or hello.controller or hello.lua_only
                                          or hello.session_token):
        hello.robots.append("*")


TOLD["reversed-robots"] = in_kind("welcome", lambda _, welcome: refill(welcome, "robots", reversed(welcome.robots)))
SAID["lua-only-ignored"] = clear_fields("hello", "lua_only")
SAID["controller-ignored"] = clear_fields("hello", "controller")
SAID["one-of-them-is-enough"] = in_kind("hello", lambda _, hello: refill(
    hello, "robots", [robot for robot in hello.robots if robot != "nobody"]))
TOLD["controller-is-a-robot"] = recode("refusal", E.UNKNOWN_CONTROLLER, E.UNKNOWN_ROBOT)
TOLD["holder-not-named"] = clear_fields("refusal", "holder")


@told("disturbs-the-holder")
def _(connection, message):
    if message.HasField("refusal"):
        for other in connection.connections:
            if other is not connection and other.welcome is not None:
                other.tell(error=E(code=E.ROBOT_TAKEN, severity=E.WARNING, message="another client asks"))


SAID["takes-over-always"] = set_fields("hello", takeover=True)
TOLD["left-is-unknown"] = recode("refusal", E.NOT_YOURS, E.UNKNOWN_ROBOT)
SAID["wish-ignored"] = clear_fields("hello", "deadline_policy")


@said("hold-without-deadline")
def _(connection, message):
    if message.HasField("hello") and message.hello.HasField("deadline_policy"):
        message.hello.deadline_policy.wall_deadline_ms = message.hello.deadline_policy.wall_deadline_ms or 1000


TOLD["no-token"] = clear_fields("welcome", "session_token")
TOLD["one-token"] = set_fields("welcome", session_token=b"the same for all")
TOLD["new-token"] = in_kind("welcome", lambda connection, welcome: setattr(
    welcome, "session_token", welcome.session_token + b"x") if connection.hello.session_token else None)
TOLD["no-hash"] = clear_fields("welcome", "scene_hash")
TOLD["another-hash-each"] = in_kind("welcome", lambda _, welcome: setattr(
    welcome, "scene_hash", secrets.token_hex(8)))
TOLD["wrong-tick-length"] = set_fields("welcome", tick_ns=1)
TOLD["no-mode"] = clear_fields("welcome", "mode")


def _of_robots(*fields):
    def change(_, welcome):
        for robot in welcome.robots:
            for field in fields:
                robot.ClearField(field)
    return in_kind("welcome", change)


TOLD["no-params"] = _of_robots("params")
TOLD["no-script"] = _of_robots("script")
TOLD["devices-lost"] = _of_robots("magnets")
TOLD["params-reversed"] = in_kind("welcome", lambda _, welcome: [refill(
    robot, "params", reversed(robot.params)) for robot in welcome.robots] and None)


@told("refused-for-ever")
def _(connection, message):
    if connection.notes.get("refused"):
        return []
    connection.notes["refused"] = message.HasField("refusal")
    return None


@told("late-gets-nothing")
def _(connection, message):
    """A session that begins after another has got an Observation never gets its first one."""
    if message.HasField("welcome"):
        connection.notes["late"] = any(other.notes.get("begun") for other in connection.connections)
    if message.HasField("observation") and not connection.notes.get("begun"):
        connection.notes["begun"] = True
        return [] if connection.notes.get("late") else None
    return None


@told("welcome-after-loading-lost")
def _(connection, message):
    connection.notes.setdefault("loading", message.HasField("loading"))
    return [] if message.HasField("welcome") and connection.notes["loading"] else None


TOLD["progress-in-percent"] = in_kind("loading", lambda _, loading: setattr(loading, "progress", 50.0))
SAID["takeover-ignored"] = set_fields("hello", takeover=False)
TOLD["displaced-not-told"] = drop("displaced")
TOLD["role-not-told"] = clear_fields("welcome", "role")
