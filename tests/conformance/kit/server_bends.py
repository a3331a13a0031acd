"""What the bugs of bent_server.py change."""

import json
import math

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

SAID["wish-ignored-first"] = SAID["wish-ignored"]
