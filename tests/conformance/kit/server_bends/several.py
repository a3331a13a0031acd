# SPDX-License-Identifier: MIT
"""Bends of rules that several sections have."""

import protocol_pb2 as protocol

from .deadlines import policy
from .supervision import done_without
from .kinds import E, POLICY, SAID, TOLD, drop, in_kind, refill, said, told


def _refused(connection, code):
    connection.tell(refusal=protocol.Refusal(error=E(code=code, severity=E.FATAL, message="no")))
    return []


@told("begins-early")
def _(connection, message):
    return [message, protocol.ServerMessage(observation={})] if message.HasField("welcome") else None


SAID["reset-not-done"] = done_without("reset")
TOLD["paused-told-to-one"] = in_kind("paused", lambda connection, _: None if connection is connection.connections[0] else [])


@told("end-is-final")
def _(connection, message):
    connection.notes["ended"] = connection.notes.get("ended") or message.HasField("end")


@said("end-is-final")
def _(connection, message):
    if message.HasField("command") and connection.notes.get("ended"):
        connection.tell(error=E(code=E.OUT_OF_STATE, severity=E.DISCARD, message="it is over"))
        return []
    return None


_hellos = []


@said("lost-are-taken")
def _(connection, message):
    """The third session gets no robots."""
    if message.HasField("hello") and message.hello.version.major:
        _hellos.append(message)
        if len(_hellos) > 2:
            error = E(code=E.ROBOT_TAKEN, severity=E.FATAL, retryable=True, message="they were had before")
            connection.tell(refusal=protocol.Refusal(error=error, holder="a ghost"))
            return []
    return None


@said("no-repetition")
def _(connection, message):
    if message.HasField("command") and connection.hello.session_token:
        connection.tell(error=E(code=E.STALE_TICK, severity=E.DISCARD, message="it was answered before"))
        return []
    return None


policy("dead-is-waited-for", lambda policy: (policy.Clear(), setattr(policy, "action", POLICY.WAIT)))
TOLD["loading-is-silent"] = drop("loading")


@said("flood-is-served")
def _(connection, message):
    if message.HasField("heartbeat"):
        connection.tell(heartbeat=message.heartbeat)
        return []
    return None


SAID["few-patterns"] = in_kind("hello", lambda connection, hello: _refused(connection, E.TOO_MANY)
                               if len(hello.robots) > 32 else None)
SAID["short-patterns"] = in_kind("hello", lambda connection, hello: _refused(connection, E.TOO_MANY)
                                 if any(len(pattern) > 200 for pattern in hello.robots) else None)
SAID["patterns-cut"] = in_kind("hello", lambda _, hello: refill(hello, "robots", hello.robots[:64]))

SAID["wish-ignored-first"] = SAID["wish-ignored"]
SAID["future-counts"] = SAID["any-tick"]
SAID["any-length"] = SAID["pads-joint-targets"]
TOLD["silent-on-garbage"] = TOLD["garbage-is-silent"]
SAID["all-left-release"] = SAID["leaves-release"]
TOLD["names-as-they-are"] = in_kind("refusal", lambda _, refusal: setattr(refusal, "holder", "\x1b]" + "x" * 100))
TOLD["always-retryable"] = in_kind("refusal", lambda _, refusal: setattr(refusal.error, "retryable", True))


# ---- what results must not depend on ----------------------------------------------------------------

_answered = set()  # ticks that one of two sessions has answered


@said("order-counts")
def _(connection, message):
    """Who answers second drives at half the speed."""
    if not message.HasField("command"):
        return
    if message.command.tick in _answered:
        refill(message.command, "joint_targets", [value / 2 for value in message.command.joint_targets])
    _answered.symmetric_difference_update({message.command.tick})


@said("policy-counts")
def _(connection, message):
    if message.HasField("command") and connection.hello.HasField("deadline_policy"):
        refill(message.command, "joint_targets", [value / 2 for value in message.command.joint_targets])


@said("supervisors-need-keys")
def _(connection, message):
    if message.HasField("hello") and message.hello.role == protocol.ROLE_SUPERVISOR:
        return _refused(connection, E.FORBIDDEN)
    return None
