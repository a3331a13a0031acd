# SPDX-License-Identifier: MIT
"""Bends of section 9: supervision."""

import protocol_pb2 as protocol

from .kinds import E, SAID, TOLD, clear_fields, drop, finite, in_kind, refill, said, set_fields, swap, told

SAID["supervisor-robots-ignored"] = in_kind("hello", lambda _, hello: hello.ClearField("robots")
                                        if hello.role == protocol.ROLE_SUPERVISOR else None)
TOLD["id-plus-one"] = in_kind("response", lambda _, response: setattr(response, "id", (response.id + 1) % 2**64))
TOLD["response-tick-plus-one"] = in_kind("response", lambda _, response: setattr(response, "tick", response.tick + 1))
TOLD["response-tick-0"] = set_fields("response", tick=0)
TOLD["responses-swapped"] = swap("response")
TOLD["observer-may-all"] = clear_fields("response", "error")


@said("pause-at-once")
def _(connection, message):
    if message.request.HasField("pause"):
        connection.tell(response=protocol.Response(id=message.request.id, tick=0))


@said("one-step-more")
def _(connection, message):
    if message.request.HasField("step") and message.request.step.ticks:
        message.request.step.ticks += 1


@said("step-of-none")
def _(connection, message):
    if message.request.HasField("step") and not message.request.step.ticks:
        connection.tell(response=protocol.Response(id=message.request.id, tick=connection.tick))
        return []
    return None


@said("steps-go-on")
def _(connection, message):
    is_supervisor = connection.hello is not None and connection.hello.role == protocol.ROLE_SUPERVISOR
    return [] if is_supervisor and message.HasField("leave") else None


TOLD["steps-are-done-by-a-reset"] = clear_fields("response", "error")
TOLD["reset-not-told"] = drop("reset")
TOLD["seed-not-told"] = set_fields("reset", seed=0)


@said("seed-ignored")
def _(connection, message):
    if message.request.HasField("reset"):
        message.request.reset.ClearField("seed")


def _of_states(change):
    return in_kind("response", lambda _, response: change(response.states) if response.HasField("states") else None)


TOLD["states-reversed"] = _of_states(lambda states: refill(states, "entities", reversed(states.entities)))
TOLD["no-state-hash"] = _of_states(lambda states: states.ClearField("hash"))


@told("unknown-entity-is-none")
def _(connection, message):
    if message.HasField("response") and message.response.error.code == E.UNKNOWN_ENTITY:
        message.response.ClearField("error")
        message.response.states.SetInParent()


@said("moves-anywhere")
def _(connection, message):
    if message.request.HasField("move"):
        refill(message.request.move, "position", (list(map(finite, message.request.move.position)) + [0.0] * 3)[:3])


for _name in ("unknown-place-is-free", "unknown-joint-is-set"):
    TOLD[_name] = TOLD["unknown-entity-is-none"]
SAID["joints-at-no-number"] = in_kind("request", lambda _, request: setattr(
    request.set_joint, "position", finite(request.set_joint.position)) if request.HasField("set_joint") else None)
SAID["joints-at-any-speed"] = in_kind("request", lambda _, request: setattr(
    request.set_joint, "velocity", min(request.set_joint.velocity, 1e6)) if request.HasField("set_joint") else None)


SAID["turns-back"] = in_kind("request", lambda _, request: refill(
    request.move, "orientation", request.move.orientation or [1, 0, 0, 0]) if request.HasField("move") else None)
SAID["reasons-lost"] = in_kind("request", lambda _, request: request.shutdown.ClearField("reason")
                               if request.HasField("shutdown") else None)
SAID["long-reasons-cut"] = in_kind("request", lambda _, request: setattr(
    request.shutdown, "reason", request.shutdown.reason[:1024]) if request.HasField("shutdown") else None)


for _name, _may in (("moves-onto-others", True), ("moves-onto-nothing", False)):
    SAID[_name] = in_kind("request", lambda _, request, may=_may: setattr(request.move, "may_overlap", may)
                          if request.HasField("move") else None)
for _name, _there in (("places-never-free", "wall"), ("places-always-free", "")):
    TOLD[_name] = in_kind("response", lambda _, response, there=_there: setattr(response.place, "overlapped", there)
                          if response.HasField("place") else None)


def done_without(kind):
    """A request is answered as done, and is not done."""
    def bend(connection, message):
        if message.HasField("request") and message.request.WhichOneof("request") == kind:
            connection.tell(response=protocol.Response(id=message.request.id, tick=max(connection.tick, 0)))
            return []
        return None
    return bend


for _kind in ("move", "set_joint", "spawn", "remove", "shutdown", "snapshot", "resume"):
    SAID[f"{_kind}-not-done"] = done_without(_kind)
TOLD["removed-not-told"] = drop("error", E.NOT_YOURS)


def _of_status(change):
    return in_kind("response", lambda _, response: change(response.status) if response.HasField("status") else None)


TOLD["no-sessions"] = _of_status(lambda status: status.ClearField("sessions"))
TOLD["no-phase"] = _of_status(lambda status: status.ClearField("phase"))
TOLD["no-free-robots"] = _of_status(lambda status: status.ClearField("free_robots"))
