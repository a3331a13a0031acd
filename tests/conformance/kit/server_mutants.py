"""What the bugs of bent_server.py change, and the table of all of them and of those of tiny_server.py."""

import json
import math
from dataclasses import dataclass

import protocol_pb2 as protocol

E = protocol.Error
SAID, TOLD, RAW, OPTIONS = {}, {}, {}, {}


def said(*bugs):
    """A bend of what clients say."""
    def keep(function):
        SAID.update({bug: function for bug in bugs})
        return function
    return keep


def told(*bugs):
    """A bend of what the server says."""
    def keep(function):
        TOLD.update({bug: function for bug in bugs})
        return function
    return keep


# ---- kinds of bends --------------------------------------------------------------------------------


def _in(kind, change):
    """Changes messages of a kind: change(connection, content), whose list, if any, takes their place."""
    def bend(connection, message):
        return change(connection, getattr(message, kind)) if message.HasField(kind) else None
    return bend


def _set(kind, **fields):
    def change(_, content):
        for name, value in fields.items():
            setattr(content, name, value)
    return _in(kind, change)


def _clear(kind, *fields):
    def change(_, content):
        for name in fields:
            content.ClearField(name)
    return _in(kind, change)


def _drop(kind, *codes):
    """Swallows messages of a kind; of errors, those with these codes."""
    return _in(kind, lambda _, content: [] if not codes or content.code in codes else None)


def _recode(kind, code, other):
    """Another code in errors."""
    def change(_, content):
        error = content if kind == "error" else content.error
        if error.code == code:
            error.code = other
    return _in(kind, change)


def _shorter(field):
    def change(_, content):
        if getattr(content, field):
            del getattr(content, field)[-1]
    return _in("observation", change)


def _refill(content, field, values):
    values = list(values)
    content.ClearField(field)
    getattr(content, field).extend(values)


def _each_value(field, change):
    return _in("command", lambda _, command: _refill(command, field, map(change, getattr(command, field))))


def _per_device(field, devices, value):
    """Pads and cuts a field of Command to its right length."""
    def change(connection, command):
        if getattr(command, field) and connection.welcome:
            count = sum(len(getattr(robot, devices)) for robot in connection.welcome.robots)
            _refill(command, field, (list(getattr(command, field)) + [value] * count)[:count])
    return _in("command", change)


_finite = lambda value: value if math.isfinite(value) else 0.0  # noqa: E731


# ---- sections 1 and 2 ------------------------------------------------------------------------------

RAW["two-frames"] = lambda data: [(data, b"")]
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


@said("unknown-fields-malformed")
def _(connection, message):
    if message.UnknownFields() or b"\x80\x7d\x07" in message.SerializeToString():
        connection.tell(error=E(code=E.MALFORMED, severity=E.DISCARD, message="unknown"))
        return []
    return None


@told("reorders")
def _(connection, message):
    if not message.HasField("heartbeat"):
        return None
    held = connection.notes.pop("held", None)
    if held is None:
        connection.notes["held"] = message
        return []
    return [message, held]


TOLD["no-limit"] = _set("welcome", max_message_bytes=0)
TOLD["too-large-is-silent"] = _drop("error", E.TOO_LARGE)
TOLD["garbage-is-silent"] = _drop("error", E.MALFORMED)
SAID["deaf-to-hello"] = _drop("hello")
TOLD["client-version-lost"] = _clear("refusal", "client_version")
TOLD["minor-above"] = _in("welcome", lambda _, welcome: setattr(welcome.version, "minor", 9))


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


TOLD["reversed-robots"] = _in("welcome", lambda _, welcome: _refill(welcome, "robots", reversed(welcome.robots)))
SAID["lua-only-ignored"] = _clear("hello", "lua_only")
SAID["controller-ignored"] = _clear("hello", "controller")
SAID["one-of-them-is-enough"] = _in("hello", lambda _, hello: _refill(
    hello, "robots", [robot for robot in hello.robots if robot != "nobody"]))
TOLD["controller-is-a-robot"] = _recode("refusal", E.UNKNOWN_CONTROLLER, E.UNKNOWN_ROBOT)
TOLD["holder-not-named"] = _clear("refusal", "holder")


@told("disturbs-the-holder")
def _(connection, message):
    if message.HasField("refusal"):
        for other in connection.connections:
            if other is not connection and other.welcome is not None:
                other.tell(error=E(code=E.ROBOT_TAKEN, severity=E.WARNING, message="another client asks"))


SAID["takes-over-always"] = _set("hello", takeover=True)
TOLD["left-is-unknown"] = _recode("refusal", E.NOT_YOURS, E.UNKNOWN_ROBOT)
SAID["wish-ignored"] = _clear("hello", "deadline_policy")


@said("hold-without-deadline")
def _(connection, message):
    if message.HasField("hello") and message.hello.HasField("deadline_policy"):
        message.hello.deadline_policy.wall_deadline_ms = message.hello.deadline_policy.wall_deadline_ms or 1000


TOLD["no-token"] = _clear("welcome", "session_token")
TOLD["one-token"] = _set("welcome", session_token=b"the same for all")
TOLD["new-token"] = _in("welcome", lambda connection, welcome: setattr(
    welcome, "session_token", welcome.session_token + b"x") if connection.hello.session_token else None)
TOLD["no-hash"] = _clear("welcome", "scene_hash")
TOLD["wrong-tick-length"] = _set("welcome", tick_ns=1)
TOLD["no-mode"] = _clear("welcome", "mode")


def _of_robots(*fields):
    def change(_, welcome):
        for robot in welcome.robots:
            for field in fields:
                robot.ClearField(field)
    return _in("welcome", change)


TOLD["no-params"] = _of_robots("params")
TOLD["no-script"] = _of_robots("script")
TOLD["devices-lost"] = _of_robots("magnets")
TOLD["params-reversed"] = _in("welcome", lambda _, welcome: [_refill(
    robot, "params", reversed(robot.params)) for robot in welcome.robots] and None)


@told("refused-for-ever")
def _(connection, message):
    if connection.notes.get("refused"):
        return []
    connection.notes["refused"] = message.HasField("refusal")
    return None


@said("late-gets-nothing")
def _(connection, message):
    if message.HasField("command"):
        connection.notes["answered"] = True


@told("late-gets-nothing")
def _(connection, message):
    """A session that begins after another has answered never gets its first Observation."""
    if message.HasField("observation") and not connection.notes.get("begun"):
        connection.notes["begun"] = True
        return [] if any(other.notes.get("answered") for other in connection.connections) else None
    return None


@told("welcome-after-loading-lost")
def _(connection, message):
    connection.notes.setdefault("loading", message.HasField("loading"))
    return [] if message.HasField("welcome") and connection.notes["loading"] else None


TOLD["progress-in-percent"] = _in("loading", lambda _, loading: setattr(loading, "progress", 50.0))
SAID["takeover-ignored"] = _set("hello", takeover=False)
TOLD["displaced-not-told"] = _drop("displaced")
TOLD["role-not-told"] = _clear("welcome", "role")

# ---- section 3 -------------------------------------------------------------------------------------

TOLD["time-in-ms"] = _in("observation", lambda _, told: setattr(told, "time_ns", told.time_ns // 1000))


@told("doubles-ticks")
def _(connection, message):
    if message.HasField("observation"):
        message.observation.tick *= 2


@said("doubles-ticks")
def _(connection, message):
    if message.HasField("command"):
        message.command.tick //= 2


@told("no-tick-zero")
def _(connection, message):
    if message.HasField("observation") and message.observation.tick == 0:
        connection.say(command=protocol.Command(tick=0))
        return []
    return None


for _field in ("joint_readings", "proximity", "positioning", "batteries"):
    TOLD[f"short-{_field}"] = _shorter(_field)


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
        _refill(message.command, "joint_targets", held)


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


SAID["pads-joint-targets"] = _per_device("joint_targets", "joint_actuators", 0.0)
SAID["pads-leds"] = _per_device("led_colors", "leds", 0)
SAID["pads-beams"] = _per_device("directional_led_colors", "directional_leds", 0)
SAID["pads-tags"] = _per_device("tag_payloads", "tags", b"")
SAID["pads-currents"] = _per_device("magnet_currents", "magnets", 0.0)
SAID["drops-positions-beyond"] = _in("command", lambda connection, command: _refill(
    command, "robots", [p for p in command.robots if p < len(connection.welcome.robots)]))
SAID["a-position-once"] = _in("command", lambda _, command: _refill(command, "robots", sorted(set(command.robots))))
SAID["left-are-ignored"] = _clear("command", "robots")
SAID["nan-is-zero"] = _each_value("joint_targets", _finite)
SAID["infinite-currents"] = _each_value("magnet_currents", _finite)
SAID["any-tick"] = _in("command", lambda connection, command: setattr(command, "tick", connection.tick))
TOLD["stale-is-silent"] = _drop("error", E.STALE_TICK)
TOLD["future-is-stale"] = _recode("error", E.FUTURE_TICK, E.STALE_TICK)
TOLD["duplicate-is-silent"] = _drop("error", E.DUPLICATE_TICK)


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


SAID["lines-beyond-dropped"] = _in("command", lambda connection, command: _refill(
    command, "log", [line for line in command.log if line.robot < len(connection.welcome.robots)]))
SAID["colours-cut"] = _each_value("led_colors", lambda color: color & 0xFFFFFF)
SAID["beams-cut"] = _each_value("directional_led_colors", lambda color: color & 0xFFFFFF)
SAID["tags-cut"] = _each_value("tag_payloads", lambda payload: payload[:65536])


@said("long-tags-refused")
def _(connection, message):
    if any(len(payload) > 65535 for payload in message.command.tag_payloads):
        connection.tell(error=E(code=E.TOO_LARGE, severity=E.DISCARD, field="tag_payloads", message="long"))
        return []
    return None


SAID["bearing-dropped"] = _in("command", lambda _, command: command.ClearField("range_and_bearing_data"))


def _messages(keep):
    return _in("command", lambda connection, command: _refill(
        command, "radio_messages", [m for m in command.radio_messages if keep(command, m)]))


SAID["radios-beyond-ignored"] = _messages(lambda _, message: message.radio < 4)
SAID["any-radio"] = _in("command", lambda _, command: command.ClearField("robots")
                        if command.radio_messages else None)
SAID["long-messages-ignored"] = _messages(lambda _, message: len(message.payload) <= 2**20)
SAID["longest-messages-lost"] = _messages(lambda _, message: len(message.payload) < 2**20)
SAID["many-messages-cut"] = _in("command", lambda _, command: _refill(
    command, "radio_messages", command.radio_messages[:1000]))
SAID["empty-messages-lost"] = _messages(lambda _, message: message.payload)
TOLD["messages-reversed"] = _in("observation", lambda _, told: _refill(
    told, "radio_messages", reversed(told.radio_messages)))


@told("senders-reversed")
def _(connection, message):
    """Ascending by receiver, but not by sender."""
    if message.HasField("observation"):
        _refill(message.observation, "radio_messages",
                sorted(reversed(message.observation.radio_messages), key=lambda m: m.radio))


@told("messages-twice")
def _(connection, message):
    if message.HasField("observation"):
        heard = list(message.observation.radio_messages)
        message.observation.radio_messages.extend(connection.notes.get("heard", []))
        connection.notes["heard"] = heard


TOLD["packets-reversed"] = _in("observation", lambda _, told: _refill(
    told, "range_and_bearing", reversed(told.range_and_bearing)))
TOLD["packets-lost"] = _in("observation", lambda _, told: told.ClearField("range_and_bearing")
                           if told.tick % 2 else None)
TOLD["packets-cut"] = _in("observation", lambda _, told: [setattr(p, "data", p.data[:1])
                                                         for p in told.range_and_bearing] and None)


@said("wheels-stop")
def _(connection, message):
    if message.HasField("command") and not message.command.wheel_velocities:
        message.command.wheel_velocities.extend([0.0] * 4)


@said("wheels-swapped")
def _(connection, message):
    values = list(message.command.wheel_velocities)
    if values:
        _refill(message.command, "wheel_velocities", [v for i in range(0, len(values), 2)
                                                      for v in (values[i + 1], values[i])])


SAID["wheels-finite"] = _each_value("wheel_velocities", _finite)
SAID["any-turret-mode"] = _each_value("turret_modes", lambda mode: mode if mode in (1, 2, 3) else 1)
TOLD["wheels-lost"] = _shorter("wheels")
TOLD["counts-of-cameras"] = _in("observation", lambda _, told: told.ClearField("led_counts"))
TOLD["seen-lost"] = _in("observation", lambda _, told: told.ClearField("led_colors"))
TOLD["picture-at-tick-0"] = _in("observation", lambda _, told: _refill(
    told, "camera_images", [bytes(576)] if told.camera_images else []))
TOLD["picture-cut"] = _in("observation", lambda _, told: _refill(
    told, "camera_images", [image[:-3] for image in told.camera_images]))
TOLD["imus-of-three"] = _in("observation", lambda _, told: _refill(told, "imus", told.imus[:3]))
TOLD["contacts-lost"] = _in("observation", lambda _, told: told.ClearField("contact_sensors"))

# ---- section 3.2 -----------------------------------------------------------------------------------


def _policy(bug, change):
    """Another policy holds than the one that is told."""
    def hello(connection, message):
        if message.HasField("hello") and message.hello.HasField("deadline_policy"):
            connection.notes["asked"] = protocol.DeadlinePolicy.FromString(
                message.hello.deadline_policy.SerializeToString())
            change(message.hello.deadline_policy)

    def welcome(connection, message):
        if message.HasField("welcome") and "asked" in connection.notes:
            message.welcome.deadline_policy.CopyFrom(connection.notes["asked"])

    SAID[bug], TOLD[bug] = hello, welcome


_P = protocol.DeadlinePolicy
_policy("waits-always", lambda policy: (policy.Clear(), setattr(policy, "action", _P.WAIT)))
_policy("hold-is-zero", lambda policy: setattr(policy, "action", _P.ZERO))
_policy("zero-is-hold", lambda policy: setattr(policy, "action", _P.HOLD))
_policy("drop-is-hold", lambda policy: setattr(policy, "action", _P.HOLD))
_policy("stop-is-hold", lambda policy: setattr(policy, "action", _P.HOLD))
_policy("misses-early", lambda policy: setattr(policy, "wall_deadline_ms", policy.wall_deadline_ms // 5))
_policy("no-budget", lambda policy: setattr(policy, "miss_budget", 0))
TOLD["miss-not-told"] = _drop("error", E.DEADLINE_MISSED)
TOLD["miss-is-fatal"] = _in("error", lambda _, error: setattr(error, "severity", E.DISCARD)
                            if error.code == E.DEADLINE_MISSED else None)
TOLD["late-is-silent"] = _drop("error", E.STALE_TICK)

# ---- sections 3.3 to 6 -----------------------------------------------------------------------------

TOLD["paused-not-told"] = _drop("paused")
TOLD["paused-wrong-tick"] = _in("paused", lambda _, paused: setattr(paused, "tick", paused.tick + 1))
TOLD["state-is-silent"] = _drop("error", E.OUT_OF_STATE)
TOLD["nothing-is-fatal"] = _in("error", lambda _, error: setattr(error, "severity", E.DISCARD)
                               if error.severity == E.FATAL else None)
TOLD["refusal-not-fatal"] = _in("refusal", lambda _, refusal: setattr(refusal.error, "severity", E.DISCARD))
TOLD["unknown-code"] = _set("error", code=99)
TOLD["no-severity"] = _clear("error", "severity")
TOLD["too-many-is-silent"] = _drop("error", E.TOO_MANY)
TOLD["sequence-plus-one"] = _in("heartbeat", lambda _, beat: setattr(beat, "sequence", (beat.sequence + 1) % 2**64))
TOLD["heartbeats-lost"] = _drop("heartbeat")
TOLD["controller-may-pause"] = _clear("response", "error")


@told("welcome-twice")
def _(connection, message):
    return [message, message] if message.HasField("welcome") else None


SAID["any-reason"] = _in("leave", lambda _, leave: setattr(leave, "reason", protocol.Leave.DONE))
SAID["some-is-all"] = _in("leave", lambda _, leave: leave.ClearField("robots"))
SAID["leave-ignored"] = _drop("leave")
SAID["leave-beyond-dropped"] = _in("leave", lambda _, leave: _refill(
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


TOLD["end-not-told"] = _drop("end")
TOLD["end-without-reason"] = _clear("end", "reason")
TOLD["end-at-tick-0"] = _in("end", lambda _, end: setattr(end, "tick", end.tick + 5))
TOLD["hello-after-end-is-silent"] = _drop("refusal")


@said("token-ignored")
def _(connection, message):
    if message.HasField("hello") and message.hello.session_token:
        message.hello.session_token = b""
        message.hello.robots.append("*")


TOLD["resumed-without-observation"] = _in("observation", lambda connection, told: []
                                          if connection.hello and connection.hello.session_token else None)
OPTIONS["no-lease"] = lambda options: []
TOLD["lease-not-told"] = _clear("welcome", "wall_lease_ms")
TOLD["no-such-session-is-unknown"] = _recode("refusal", E.NO_SUCH_SESSION, E.UNKNOWN_ROBOT)

# ---- section 9 -------------------------------------------------------------------------------------

SAID["supervisor-robots-ignored"] = _in("hello", lambda _, hello: hello.ClearField("robots")
                                        if hello.role == protocol.ROLE_SUPERVISOR else None)
TOLD["id-plus-one"] = _in("response", lambda _, response: setattr(response, "id", (response.id + 1) % 2**64))


@told("responses-swapped")
def _(connection, message):
    if not message.HasField("response"):
        return None
    held = connection.notes.pop("held", None)
    if held is None:
        connection.notes["held"] = message
        return []
    return [message, held]


TOLD["observer-may-all"] = _clear("response", "error")


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


TOLD["reset-not-told"] = _drop("reset")
TOLD["seed-not-told"] = _set("reset", seed=0)


@said("seed-ignored")
def _(connection, message):
    if message.request.HasField("reset"):
        message.request.reset.ClearField("seed")


def _of_states(change):
    return _in("response", lambda _, response: change(response.states) if response.HasField("states") else None)


TOLD["states-reversed"] = _of_states(lambda states: _refill(states, "entities", reversed(states.entities)))
TOLD["no-state-hash"] = _of_states(lambda states: states.ClearField("hash"))


@told("unknown-entity-is-none")
def _(connection, message):
    if message.HasField("response") and message.response.error.code == E.UNKNOWN_ENTITY:
        message.response.ClearField("error")
        message.response.states.SetInParent()


@said("moves-anywhere")
def _(connection, message):
    if message.request.HasField("move"):
        _refill(message.request.move, "position", (list(map(_finite, message.request.move.position)) + [0.0] * 3)[:3])


def _done_without(kind):
    """A request is answered as done, and is not done."""
    def bend(connection, message):
        if message.HasField("request") and message.request.WhichOneof("request") == kind:
            connection.tell(response=protocol.Response(id=message.request.id, tick=max(connection.tick, 0)))
            return []
        return None
    return bend


for _kind in ("move", "spawn", "remove", "shutdown", "snapshot", "resume"):
    SAID[f"{_kind}-not-done"] = _done_without(_kind)
TOLD["removed-not-told"] = _drop("error", E.NOT_YOURS)


def _of_status(change):
    return _in("response", lambda _, response: change(response.status) if response.HasField("status") else None)


TOLD["no-sessions"] = _of_status(lambda status: status.ClearField("sessions"))
TOLD["no-phase"] = _of_status(lambda status: status.ClearField("phase"))
TOLD["no-free-robots"] = _of_status(lambda status: status.ClearField("free_robots"))

# ---- since 1.1 -------------------------------------------------------------------------------------

TOLD["dropped-not-told"] = _drop("error", E.ROBOTS_DROPPED)
TOLD["dropped-beyond"] = _in("error", lambda _, error: error.dropped.robots.append(9)
                             if error.code == E.ROBOTS_DROPPED else None)
TOLD["dropped-is-fatal"] = _in("error", lambda _, error: setattr(error, "severity", E.FATAL)
                               if error.code == E.ROBOTS_DROPPED else None)
TOLD["resumed-not-told"] = _clear("welcome", "resumed")
TOLD["commanded-lost"] = _in("welcome", lambda _, welcome: welcome.resumed.commanded.ClearField("led_colors")
                             if welcome.HasField("resumed") else None)
TOLD["commanded-of-the-last"] = _in("welcome", lambda _, welcome: _refill(
    welcome.resumed.commanded, "joint_targets", [0.0] * 4) if welcome.HasField("resumed") else None)
TOLD["commanded-too-long"] = _in("welcome", lambda _, welcome: welcome.resumed.commanded.joint_targets.append(0)
                                 if welcome.HasField("resumed") else None)
TOLD["gone-not-told"] = _in("welcome", lambda _, welcome: welcome.resumed.ClearField("gone_robots")
                            if welcome.HasField("resumed") else None)
TOLD["new-is-resumed"] = _in("welcome", lambda _, welcome: welcome.resumed.SetInParent()
                             if welcome.version.minor else None)
TOLD["spawned-not-told"] = _drop("robot_spawned")


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
        _refill(message.request.move, "position", [min(x, 1e6) for x in message.request.move.position])


SAID["all-left-release"] = SAID["leaves-release"]
TOLD["names-as-they-are"] = _in("refusal", lambda _, refusal: setattr(refusal, "holder", "\x1b]" + "x" * 100))
TOLD["always-retryable"] = _in("refusal", lambda _, refusal: setattr(refusal.error, "retryable", True))

# ---- rules of several sections ---------------------------------------------------------------------


@told("begins-early")
def _(connection, message):
    return [message, protocol.ServerMessage(observation={})] if message.HasField("welcome") else None


SAID["reset-not-done"] = _done_without("reset")
TOLD["paused-told-to-one"] = _in("paused", lambda connection, _: None if connection is connection.connections[0] else [])


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


_policy("dead-is-waited-for", lambda policy: (policy.Clear(), setattr(policy, "action", _P.WAIT)))
TOLD["loading-is-silent"] = _drop("loading")


@said("flood-is-served")
def _(connection, message):
    if message.HasField("heartbeat"):
        connection.tell(heartbeat=message.heartbeat)
        return []
    return None


SAID["patterns-cut"] = _in("hello", lambda _, hello: _refill(hello, "robots", hello.robots[:64]))


# ---- the table -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Mutant:
    bug: str
    rule: str  # that it breaks
    case: str  # that catches it
    form: str = "binary"
    program: str = "bent_server.py"
    patience: float = 2.0  # [s]: to be late is as wrong as to say nothing
    is_must: bool = True


def _tiny(bug, case):
    return Mutant(bug, case.split(".")[0], case, program="tiny_server.py")


def _bent(bug, case, rule="", **more):
    return Mutant(bug, rule or case.split(".")[0], case, **more)


MUTANTS = [
    _tiny("any-version", "H2.major-above"),
    _tiny("any-token", "L4.unknown-token"),
    _tiny("token-waits", "L8.token-alone"),
    _tiny("asked-order", "H4.some"),
    _tiny("shares-robots", "H6.taken-twice"),
    _tiny("late-waits", "H11.late"),
    _tiny("silent-on-garbage", "T2.garbage-text"),
    _tiny("stale-counts", "S9.stale"),
    _tiny("future-counts", "S9.future"),
    _tiny("duplicate-silent", "S9.duplicate"),
    _tiny("tells-twice", "S3.waits"),
    _tiny("heartbeat-releases", "S3.heartbeat-does-not"),
    _tiny("skips-ticks", "S1.consecutive"),
    _tiny("time-drifts", "S1.time"),
    _tiny("short-readings", "S2.joint-readings"),
    _tiny("two-steps", "S4.applied-next"),
    _tiny("any-length", "S6.long-joint-targets"),
    _tiny("nan-counts", "S8.nan-joint"),
    _tiny("half-a-command", "S10.no-effect"),
    _tiny("radio-reversed", "D3.order"),
    _tiny("plain-text", "K1.plain"),
    _tiny("any-key", "K2.unlisted"),
    _tiny("any-role", "K3.controller-as-supervisor"),
    _bent("two-frames", "H1.at-once", "T2"),
    _bent("garbage-is-silent", "T2.session-garbage-ones"),
    _bent("reorders", "T3.order"),
    _bent("no-limit", "T4.limit-is-told"),
    _bent("too-large-is-silent", "T4.too-long"),
    _bent("unknown-fields-malformed", "T5.unknown-field"),
    _bent("other-form", "T6.json-session", form="json"),
    _bent("json-leaves-zeros-out", "T6.json-session", form="json"),
    _bent("json-numbers", "T6.json-session", form="json"),
    _bent("json-snakes", "T6.json-session", form="json"),
    _bent("json-enum-numbers", "S9.stale", "T6", form="json"),
    _bent("deaf-to-hello", "H1.at-once"),
    _bent("state-is-silent", "H1.first"),
    _bent("client-version-lost", "H2.both-versions"),
    _bent("minor-above", "H2.minor-agreed"),
    _bent("any-role-of-the-future", "H3.unknown-role"),
    _bent("nothing-is-all", "H4.nothing-asked"),
    _bent("reversed-robots", "H4.some"),
    _bent("lua-only-ignored", "H4.lua-only"),
    _bent("controller-ignored", "H4.controller"),
    _bent("one-of-them-is-enough", "H5.unknown-among"),
    _bent("controller-is-a-robot", "H5.controller"),
    _bent("holder-not-named", "H6.taken-twice"),
    _bent("disturbs-the-holder", "H6.holder-undisturbed"),
    _bent("takes-over-always", "H6.taken-twice"),
    _bent("left-is-unknown", "H7.left-by-id"),
    _bent("wish-ignored", "H8.hold"),
    _bent("hold-without-deadline", "H8.no-deadline"),
    _bent("no-token", "H9.run"),
    _bent("one-token", "H9.tokens-differ"),
    _bent("no-hash", "H9.run"),
    _bent("wrong-tick-length", "H9.run"),
    _bent("no-mode", "H9.run"),
    _bent("no-params", "H9.params"),
    _bent("params-reversed", "H9.params"),
    _bent("no-script", "H9.script"),
    _bent("devices-lost", "H9.devices"),
    _bent("refused-for-ever", "H10.again"),
    _bent("late-gets-nothing", "H11.late"),
    _bent("welcome-after-loading-lost", "H12.welcome"),
    _bent("progress-in-percent", "H12.welcome"),
    _bent("takeover-ignored", "H13.takeover"),
    _bent("displaced-not-told", "H13.takeover"),
    _bent("role-not-told", "H14.waits"),
    _bent("wish-ignored-first", "H15.never-before-later"),
    _bent("time-in-ms", "S1.time"),
    _bent("doubles-ticks", "S1.consecutive"),
    _bent("no-tick-zero", "S1.tick-zero"),
    *[_bent(f"short-{field}", f"S2.{field.replace('_', '-')}")
      for field in ("joint_readings", "proximity", "positioning", "batteries")],
    _bent("left-are-unpacked", "L1.values-stay-packed", "S2"),
    _bent("heartbeat-is-an-answer", "S3.heartbeat-does-not"),
    _bent("refused-is-an-answer", "S3.error-does-not"),
    _bent("applies-a-tick-late", "S4.applied-next"),
    _bent("forgets-values", "S5.stays"),
    _bent("empty-is-refused", "S5.empty"),
    _bent("pads-joint-targets", "S6.short-joint-targets"),
    _bent("pads-leds", "S6.long-led-colors"),
    _bent("pads-beams", "S6.short-directional-led-colors"),
    _bent("pads-tags", "S6.long-tag-payloads"),
    _bent("pads-currents", "S6.short-magnet-currents"),
    _bent("drops-positions-beyond", "S7.position-beyond"),
    _bent("a-position-once", "S7.position-twice"),
    _bent("left-are-ignored", "S7.left"),
    _bent("nan-is-zero", "S8.nan-joint"),
    _bent("infinite-currents", "S8.infinity-magnet"),
    _bent("wheels-finite", "S8.nan-wheel-velocities"),
    _bent("any-tick", "S9.stale"),
    _bent("stale-is-silent", "S9.stale"),
    _bent("future-is-stale", "S9.future"),
    _bent("duplicate-is-silent", "S9.duplicate"),
    _bent("half-a-command", "S10.no-effect"),
    _bent("lines-beyond-dropped", "S11.log-beyond"),
    _bent("colours-cut", "D0.led-beyond"),
    _bent("beams-cut", "D0.directional-led-beyond"),
    _bent("tags-cut", "D0.tag-too-long"),
    _bent("long-tags-refused", "D0.tag-longest"),
    _bent("bearing-dropped", "D0.bearing-short", "S6"),
    _bent("radios-beyond-ignored", "D1.radio-beyond"),
    _bent("any-radio", "D1.radio-not-spoken-for"),
    _bent("long-messages-ignored", "D2.message-too-long"),
    _bent("longest-messages-lost", "D2.message-longest"),
    _bent("many-messages-cut", "D2.too-many-messages"),
    _bent("messages-reversed", "D3.order"),
    _bent("senders-reversed", "D3.order"),
    _bent("messages-twice", "D3.once"),
    _bent("empty-messages-lost", "D3.empty-message"),
    _bent("packets-reversed", "D4.every-tick"),
    _bent("packets-lost", "D4.every-tick"),
    _bent("packets-cut", "D4.every-tick"),
    _bent("wheels-stop", "D6.stays"),
    _bent("wheels-swapped", "D6.per-wheel"),
    _bent("wheels-lost", "D6.per-wheel", "S2"),
    _bent("any-turret-mode", "D7.mode-0"),
    _bent("counts-of-cameras", "D8.counts", "S2"),
    _bent("seen-lost", "D8.counts"),
    _bent("picture-at-tick-0", "D8.no-picture-at-tick-0"),
    _bent("picture-cut", "D8.picture"),
    _bent("imus-of-three", "D9.six-values"),
    _bent("contacts-lost", "D10.five-values"),
    _bent("waits-always", "W1.hold"),
    _bent("hold-is-zero", "W1.hold-keeps"),
    _bent("zero-is-hold", "W7.zero-zeroes"),
    _bent("drop-is-hold", "W1.drop"),
    _bent("stop-is-hold", "W1.stop"),
    _bent("misses-early", "W1.not-before"),
    _bent("no-budget", "W4.budget"),
    _bent("miss-not-told", "W5.told"),
    _bent("miss-is-fatal", "W5.told"),
    _bent("late-is-silent", "W6.late-answer"),
    _bent("paused-not-told", "P1.told"),
    _bent("paused-wrong-tick", "P1.told"),
    _bent("nothing-is-fatal", "M0.new-command"),
    _bent("refusal-not-fatal", "H5.unknown-id", "M0"),
    _bent("unknown-code", "S9.future"),
    _bent("no-severity", "S9.future"),
    _bent("welcome-twice", "S3.command-releases", "M0"),
    _bent("too-many-is-silent", "M4.many-faults"),
    _bent("sequence-plus-one", "M5.answered"),
    _bent("heartbeats-lost", "M6.heartbeats"),
    _bent("controller-may-pause", "M8.request"),
    _bent("any-reason", "L1.no-reason"),
    _bent("leave-beyond-dropped", "L1.beyond"),
    _bent("leave-ignored", "L1.twice"),
    _bent("some-is-all", "L2.some-do-not-release"),
    _bent("leaves-release", "L2.some-do-not-release"),
    _bent("observes-for-ever", "L3.all-one-by-one"),
    _bent("end-not-told", "L3.told-the-end"),
    _bent("end-without-reason", "L5.end"),
    _bent("end-at-tick-0", "L5.end"),
    _bent("hello-after-end-is-silent", "L5.hello-after-end"),
    _bent("token-ignored", "L4.unknown-token"),
    _bent("new-token", "L4.resume"),
    _bent("resumed-without-observation", "L4.resume"),
    _bent("no-such-session-is-unknown", "L4.unknown-token"),
    _bent("no-lease", "L7.lease"),
    _bent("lease-not-told", "L7.lease-is-told"),
    _bent("supervisor-robots-ignored", "V1.robots"),
    _bent("id-plus-one", "V2.id"),
    _bent("responses-swapped", "V2.order"),
    _bent("observer-may-all", "V3.pause"),
    _bent("pause-at-once", "V4.not-before"),
    _bent("resume-not-done", "V4.pause"),
    _bent("one-step-more", "V5.step"),
    _bent("step-of-none", "V5.none"),
    _bent("reset-not-told", "V6.reset"),
    _bent("seed-not-told", "V6.seed"),
    _bent("seed-ignored", "V6.seed"),
    _bent("states-reversed", "V7.some"),
    _bent("no-state-hash", "V3.read"),
    _bent("unknown-entity-is-none", "V7.unknown"),
    _bent("move-not-done", "V8.move"),
    _bent("moves-anywhere", "V8.nan"),
    _bent("spawn-not-done", "V9.spawn"),
    _bent("shutdown-not-done", "V10.shutdown"),
    _bent("snapshot-not-done", "V11.snapshot"),
    _bent("no-sessions", "V12.who"),
    _bent("no-phase", "V12.phase"),
    _bent("no-free-robots", "V12.free"),
    _bent("remove-not-done", "V13.remove"),
    _bent("removed-not-told", "V13.robot"),
    _bent("begins-early", "W3.beginning"),
    _bent("reset-not-done", "V14.back"),
    _bent("paused-told-to-one", "P2.late"),
    _bent("end-is-final", "M1.command-on-its-way"),
    _bent("lost-are-taken", "M2.lost"),
    _bent("no-repetition", "L9.safe-to-repeat"),
    _bent("dead-is-waited-for", "W2.hangs-up"),
    _bent("loading-is-silent", "T9.early", is_must=False),
    _bent("flood-is-served", "M7.flood"),
    _bent("patterns-cut", "H4.too-many-patterns", "K5"),
    _bent("dropped-not-told", "W10.told"),
    _bent("dropped-beyond", "W10.told"),
    _bent("dropped-is-fatal", "W10.told"),
    _bent("resumed-not-told", "L13.commanded"),
    _bent("commanded-lost", "L13.commanded"),
    _bent("commanded-of-the-last", "L13.not-the-last-only"),
    _bent("commanded-too-long", "L13.commanded"),
    _bent("gone-not-told", "L13.gone"),
    _bent("new-is-resumed", "L13.commanded"),
    _bent("spawned-not-told", "V15.told"),
    _bent("spawned-told-to-all", "V15.not-others"),
    _bent("later-for-all", "L13.not-for-1.0", "H2"),
    _bent("seed-0-is-absent", "V6.seed-0"),
    _bent("moves-far", "V8.far"),
    _bent("all-left-release", "L3.still-owes"),
    _bent("names-as-they-are", "H16.shown"),
    _bent("always-retryable", "H5.unknown-id", "H10"),
]
SAID["wish-ignored-first"] = SAID["wish-ignored"]
