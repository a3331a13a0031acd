# SPDX-License-Identifier: MIT
"""What the bugs of tiny_client.py change."""

import math
import time

import protocol_pb2 as protocol


def _set(name, value):
    """Sets a field of a Hello or a Leave."""
    return lambda message: setattr(message, name, value)


def _many_patterns(hello):
    hello.robots.extend(f"x{i}*" for i in range(70))


def _policy(action):
    return lambda hello: hello.deadline_policy.CopyFrom(protocol.DeadlinePolicy(action=action))


HELLOS = {
    "version-zero": lambda hello: hello.version.Clear(),
    "asks-for-nothing": lambda hello: hello.ClearField("robots"),
    "no-role": _set("role", protocol.ROLE_UNSPECIFIED),
    "observer": _set("role", protocol.ROLE_OBSERVER),
    "takes-over": _set("takeover", True),
    "long-name": _set("client_name", "x" * 70_000),
    "many-patterns": _many_patterns,
    "names-its-token": lambda hello: setattr(hello, "client_name", hello.session_token.hex() or "tiny"),
    "long-pattern": lambda hello: hello.robots.append("x" * 300),
    "hold-without-deadline": _policy(protocol.DeadlinePolicy.HOLD),
    "unknown-action": _policy(77),
}

def _resumes_as_observer(hello):
    if hello.session_token:
        hello.role = protocol.ROLE_OBSERVER
        hello.ClearField("robots")


HELLOS["resumes-as-observer"] = _resumes_as_observer

LEAVES = {
    "leaves-without-reason": _set("reason", protocol.Leave.REASON_UNSPECIFIED),
    "leave-log-beyond": lambda leave: leave.log.add(robot=99, text="x"),
    "leave-beyond": lambda leave: leave.robots.append(99),
    "leave-twice-in-one": lambda leave: leave.robots.extend([0, 0]),
}

# Silences after which a client takes its connection for lost [s].
SILENCES = {"lost-after-a-moment": 0.6, "lost-after-3-s": 3.0}

# The refusal that is answered by taking over what others have.
TAKEOVERS = {"takes-over-what-is-taken": protocol.Error.ROBOT_TAKEN, "takes-over-without-session": protocol.Error.NO_SUCH_SESSION}

# The bytes of a message → what is sent.
BYTES = {
    "nul-behind": lambda data: data + b"\0",
    "end-of-a-group-behind": lambda data: data + b"\x0c",
    "nul-before-junk": lambda data: data + b"\0\xff\xfe of the heap" if data[:1] == b"\x12" else data,
}

# The text of a message in JSON → what is sent.
TEXTS = {
    "single-quotes": lambda text: text.replace('"', "'").encode(),
    "trailing-comma": lambda text: (text[:-1] + ",}").encode(),
    "bare-names": lambda text: text.replace('"tick"', "tick").encode(),
    "nan-literal": lambda text: text.replace('"jointTargets": [0.5', '"jointTargets": [NaN').encode(),
    "name-twice": lambda text: ('{"hello": {}, ' + text[1:] if "hello" in text else text).encode(),
    "two-kinds": lambda text: (text[:-1] + ', "heartbeat": {}}' if "command" in text else text).encode(),
    "both-names": lambda text: text.replace('"jointTargets"', '"joint_targets": [], "jointTargets"').encode(),
    "deep": lambda text: (text[:-1] + ', "later": ' + "[" * 70 + "]" * 70 + "}").encode(),
    "not-base64": lambda text: text.replace('"rangeAndBearingData": "', '"rangeAndBearingData": "!!!').encode(),
    "true-target": lambda text: text.replace('"jointTargets": [0.5', '"jointTargets": [true').encode(),
    "spaced-number": lambda text: text.replace('"jointTargets": [0.5', '"jointTargets": [" 0.5"').encode(),
    "misspelt-mode": lambda text: text.replace("TURRET_SPEED", "TURRET_SPED").encode(),
    "role-beyond-32-bits": lambda text: text.replace('"ROLE_CONTROLLER"', "4294967297").encode(),
    "mode-beyond-32-bits": lambda text: text.replace('"TURRET_SPEED"', "4294967299").encode(),
    "utf-16": lambda text: text.encode("utf-16-le"),
    "space-first": lambda text: (" " + text).encode(),
    "text-for-a-list": lambda text: text.replace('"robots": ["*"]', '"robots": "*"').encode(),
}


def _first(field, value):
    """The first value of a field that is sent."""

    def change(_, command):
        values = getattr(command, field)
        if values:
            values[0] = value

    return change


def _shorter(field):
    def change(_, command):
        if getattr(command, field):
            if field == "range_and_bearing_data":
                command.range_and_bearing_data = command.range_and_bearing_data[:-1]
            else:
                del getattr(command, field)[-1]

    return change


def _longer(field):
    def change(_, command):
        values = getattr(command, field)
        if isinstance(values, bytes) and values:
            setattr(command, field, values + b"x")
        elif values:
            values.append(values[0])

    return change


def _at_tick(tick, change):
    return lambda client, command: change(client, command) if client.tick == tick else None


def _radio(index, payload=b"x", count=1):
    def change(_, command):
        command.radio_messages.extend(protocol.RadioMessage(radio=index, payload=payload)
                                      for _ in range(count))

    return change


def _named(client, command):
    command.Clear()
    command.tick = client.tick
    command.robots.append(0)
    command.radio_messages.add(radio=1, payload=b"x")


def _names_twice(client, command):
    command.Clear()
    command.tick = client.tick
    command.robots.extend([1, 1])


def _names(client, command, position):
    command.Clear()
    command.tick = client.tick
    command.robots.append(position)


def _names_beyond(client, command):
    command.Clear()
    command.tick = client.tick
    command.robots.append(len(client.welcome.robots))


def _names_left(client, command):
    if client.left:
        command.Clear()
        command.tick = client.tick
        command.robots.extend(client.left)


def _deaf_radio(client, command):
    radios = [radio for robot in client.welcome.robots for radio in robot.radios]
    command.radio_messages.extend(protocol.RadioMessage(radio=i) for i in range(len(radios)))


def _disabled_is_absent(client, command):
    if command.joint_targets and not command.robots:
        count = sum(joint.mode != protocol.JointDescription.DISABLED
                    for robot in client.welcome.robots for joint in robot.joint_actuators)
        del command.joint_targets[count:]


def _log(position, text="x"):
    def change(client, command):
        command.log.add(robot=len(client.welcome.robots) if position is None else position, text=text)

    return change


def _moved(by):
    def change(client, command):
        command.tick = max(0, client.tick + by)

    return change


def _sleeps(client, command):
    if client.tick % 10 == 7:
        time.sleep(0.4)  # longer than the deadline


def _metrics(count=1, **fields):
    """Of a session that has metrics; the names of several are new at each tick."""

    def change(client, command):
        if client.welcome.version.minor >= 3:
            for i in range(count):
                command.metrics.add(**{"name": f"m{client.tick}.{i}", "value": 1.0, **fields})

    return change


COMMANDS = {
    "logs-its-token": lambda client, command: command.log.add(robot=0, text=f"session {client.token.hex()}"),
    "metric-beyond": _metrics(robot=99),
    "metric-of-two-words": _metrics(name="two words"),
    "metric-not-finite": _metrics(value=math.nan),
    "ever-new-metrics": _metrics(count=40),
    "tick-ahead": _moved(1),
    "tick-behind": _moved(-1),
    "short-targets": _shorter("joint_targets"),
    "long-targets": _longer("joint_targets"),
    "short-leds": _shorter("led_colors"),
    "long-beams": _longer("directional_led_colors"),
    "short-tags": _shorter("tag_payloads"),
    "long-currents": _longer("magnet_currents"),
    "short-bearing": _shorter("range_and_bearing_data"),
    "long-bearing": _longer("range_and_bearing_data"),
    "short-wheels": _shorter("wheel_velocities"),
    "long-turret-modes": _longer("turret_modes"),
    "short-rotations": _shorter("turret_rotations"),
    "short-turret-speeds": _shorter("turret_speeds"),
    "nan-targets": _first("joint_targets", math.nan),
    "infinite-currents": _first("magnet_currents", math.inf),
    "infinite-wheels": _first("wheel_velocities", -math.inf),
    "nan-rotations": _first("turret_rotations", math.nan),
    "nan-turret-speeds": _first("turret_speeds", math.nan),
    "bright-leds": _first("led_colors", 0x1000000),
    "bright-beams": _first("directional_led_colors", 0xFFFFFFFF),
    "long-tag": _first("tag_payloads", b"x" * 65537),
    "no-turret-mode": _first("turret_modes", 0),
    "unknown-turret-mode": _first("turret_modes", 9),
    "names-beyond": _names_beyond,
    "names-twice": _names_twice,
    "names-left": _names_left,
    "radio-beyond": _at_tick(3, _radio(99)),
    "radio-not-named": _at_tick(3, _named),
    "deaf-radio": _deaf_radio,
    "long-radio-message": _at_tick(3, _radio(0, b"x" * (2**20 + 1))),
    "many-radio-messages": _at_tick(3, _radio(0, b"", 65537)),
    "large-radio-messages": _at_tick(3, _radio(0, b"x" * 2**20, 17)),
    "disabled-is-absent": _disabled_is_absent,
    "log-beyond": _log(None),
    "names-dropped": lambda client, command: _names(client, command, 1) if client.tick == 6 else None,
    "line-feed": _log(0, "a line\n"),
    "many-logs": lambda client, command: [command.log.add() for _ in range(1 << 18)],
    "many-numbers": _at_tick(3, lambda client, command: command.robots.extend([0] * (5 << 20))),
    "long-log": _log(0, "x" * 5000),
    "huge-log": _log(0, "x" * (80 << 20)),
    "misses-deadlines": _sleeps,
}


def _twice(client, command):
    client.say(command=command)
    client.say(command=command)


def _skips(client, command):
    if client.tick != 7:
        client.say(command=command)


def _skips_zero(client, command):
    if client.tick != 0:
        client.say(command=command)


def _sends(*frames):
    def answer(client, command):
        if client.tick == 2:
            client.send(*frames)
        else:
            client.say(command=command)

    return answer


def _also(**fields):
    def answer(client, command):
        client.say(command=command)
        client.say(**fields)

    return answer


def _mixes(client, command):
    client.form = "json" if client.tick >= 2 else "binary"
    client.say(command=command)


def _floods(client, command):
    client.say(command=command)
    for sequence in range(20000):
        client.say(heartbeat=protocol.Heartbeat(sequence=sequence))


def _other_connection(client, command):
    if client.tick == 2:
        client.monitor.close(linger=0)
        client.connect()
    client.say(command=command)


def _leaves(*leaves):
    def answer(client, command):
        if client.tick == 2:
            for leave in leaves:
                client.say(leave=leave)
        client.say(command=command)

    return answer


_DONE = protocol.Leave.DONE

# Instead of one message with the Command.
ANSWERS = {
    "answers-twice": _twice,
    "skips-a-tick": _skips,
    "skips-zero": _skips_zero,
    "two-frames": _sends(b"\x12\x00", b"more"),
    "empty-frame": _sends(b""),
    "garbage": _sends(b"\xff" * 20),
    "no-kind": _sends(b"\x80\x7d\x07"),
    "not-utf8": _sends(b"\x12\x08\x08\x02\x22\x04\x1a\x02\xff\xfe"),
    "mixes-forms": _mixes,
    "floods": _floods,
    "other-connection": _other_connection,
    "asks-for-pause": _also(request=protocol.Request(id=1, pause={})),
    "leaves-one-beyond": _leaves(protocol.Leave(robots=[9], reason=_DONE)),
    "leaves-again": _leaves(protocol.Leave(robots=[1], reason=_DONE), protocol.Leave(robots=[1], reason=_DONE)),
    "leaves-for-no-reason": _leaves(protocol.Leave(robots=[1])),
    "leaves-then-names": lambda client, command: (
        client.say(leave=protocol.Leave(robots=[1], reason=_DONE)) if client.tick == 2 else None,
        client.say(command=protocol.Command(tick=client.tick, robots=[1]) if client.tick == 3 else command)),
}
