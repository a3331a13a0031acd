# SPDX-License-Identifier: MIT
"""Bends of sections 3.3 to 6: pausing, states, leaving, errors."""

import protocol_pb2 as protocol

from .kinds import E, OPTIONS, SAID, TOLD, clear_fields, drop, in_kind, recode, refill, said, set_fields, told

TOLD["paused-not-told"] = drop("paused")
TOLD["paused-wrong-tick"] = in_kind("paused", lambda _, paused: setattr(paused, "tick", paused.tick + 1))
TOLD["state-is-silent"] = drop("error", E.OUT_OF_STATE)
TOLD["nothing-is-fatal"] = in_kind("error", lambda _, error: setattr(error, "severity", E.DISCARD)
                               if error.severity == E.FATAL else None)
TOLD["refusal-not-fatal"] = in_kind("refusal", lambda _, refusal: setattr(refusal.error, "severity", E.DISCARD))
TOLD["unknown-code"] = set_fields("error", code=99)
TOLD["wrong-error-tick"] = in_kind("error", lambda _, error: setattr(error, "tick", error.tick + 7))
TOLD["wrong-tick-of-refusals"] = in_kind("response", lambda _, response: setattr(response.error, "tick", response.tick + 7)
                                         if response.HasField("error") else None)
TOLD["no-severity"] = clear_fields("error", "severity")
TOLD["too-many-is-silent"] = drop("error", E.TOO_MANY)
TOLD["sequence-plus-one"] = in_kind("heartbeat", lambda _, beat: setattr(beat, "sequence", (beat.sequence + 1) % 2**64))
TOLD["heartbeats-lost"] = drop("heartbeat")
TOLD["controller-may-pause"] = clear_fields("response", "error")


@told("welcome-twice")
def _(connection, message):
    return [message, message] if message.HasField("welcome") else None


SAID["any-reason"] = in_kind("leave", lambda _, leave: setattr(leave, "reason", protocol.Leave.DONE))
SAID["failed-is-done"] = in_kind("leave", lambda _, leave: setattr(leave, "reason", min(leave.reason, protocol.Leave.DONE)))
SAID["some-is-all"] = in_kind("leave", lambda _, leave: leave.ClearField("robots"))
SAID["leave-ignored"] = drop("leave")
SAID["leave-beyond-dropped"] = in_kind("leave", lambda _, leave: refill(
    leave, "robots", [p for p in leave.robots if p < 4]))


@said("leaves-release")
def _(connection, message):
    if message.HasField("leave") and message.leave.robots:
        connection.say(command=protocol.Command(tick=connection.tick))


@said("observes-for-ever")
def _(connection, message):
    if message.HasField("leave") and len(message.leave.robots) == len(connection.welcome.robots):
        connection.notes["all-left"] = True
    if message.HasField("command") and connection.notes.get("all-left"):
        connection.tell(observation=protocol.Observation(tick=connection.tick + 1))


TOLD["end-not-told"] = drop("end")
TOLD["end-without-reason"] = clear_fields("end", "reason")
TOLD["end-at-tick-0"] = in_kind("end", lambda _, end: setattr(end, "tick", end.tick + 5))
TOLD["hello-after-end-is-silent"] = drop("refusal")


@said("token-ignored")
def _(connection, message):
    if message.HasField("hello") and message.hello.session_token:
        message.hello.session_token = b""
        message.hello.robots.append("*")


@said("token-waits")
def _(connection, message):
    """A session is resumed only when its connection is gone."""
    if message.HasField("hello") and any(other.welcome and other.welcome.session_token == message.hello.session_token
                                         for other in connection.connections):
        error = E(code=E.ROBOT_TAKEN, severity=E.FATAL, retryable=True, message="no")
        connection.tell(refusal=protocol.Refusal(error=error, holder="itself"))
        return []
    return None


TOLD["resumed-without-observation"] = in_kind("observation", lambda connection, told: []
                                          if connection.hello and connection.hello.session_token else None)
OPTIONS["no-lease"] = lambda options: []
TOLD["lease-not-told"] = clear_fields("welcome", "wall_lease_ms")
TOLD["no-such-session-is-unknown"] = recode("refusal", E.NO_SUCH_SESSION, E.UNKNOWN_ROBOT)
