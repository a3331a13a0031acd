# SPDX-License-Identifier: MIT
"""Section 3: the tick, and what devices ask for."""

import math

from ..case import Case
from ..messages import ALL, TWO, answer, hear_error, heartbeat, join, leave, observe
from ..steps import Check, Hear, Silence, Tick, Zeros
from ..wire import Count


def _values(name: str, lists: str, per: int = 1, title: str = ""):
    """Readings are packed: as many as the robots of the session have devices."""

    def check(stage) -> str:
        peer = stage.peer("p")
        expected = per * sum(
            len(getattr(robot, lists)) if hasattr(getattr(robot, lists), "__len__")
            else int(bool(getattr(robot, lists))) for robot in peer.welcome.robots)
        found = len(getattr(peer.observation, name))
        return "" if found == expected else f"{name} has {found} values; expected {expected}"

    return Case(f"S2.{name.replace('_', '-')}", title or f"{name} hold the values of all robots",
                (ALL, Check(name, check), answer("p"), observe("p"), Check(name, check)))


def _bad(rule: str, name: str, code: str, title: str, field: str = "", forms=("binary", "json"), **fields) -> Case:
    """A command that is refused, has no effect, and may be followed by a right one."""
    pattern = {"field": field} if field else {}
    return Case(f"{rule}.{name}", title,
                (ALL, answer("p", **fields), hear_error("p", code, **pattern), answer("p"),
                 observe("p")), forms=forms)


_PER_DEVICE = {
    "joint_targets": ("joint_actuators", 0.0),
    "led_colors": ("leds", 0),
    "directional_led_colors": ("directional_leds", 0),
    "tag_payloads": ("tags", b""),
    "magnet_currents": ("magnets", 0.0),
}

_lengths = [
    case
    for field, (devices, value) in _PER_DEVICE.items()
    for case in (
        _bad("S6", f"short-{field.replace('_', '-')}", "BAD_VALUE", f"One value of {field} too few",
             field, **{field: Zeros(devices, -1, value)}),
        _bad("S6", f"long-{field.replace('_', '-')}", "BAD_VALUE", f"One value of {field} too many",
             field, **{field: Zeros(devices, 1, value)}),
        Case(f"S6.full-{field.replace('_', '-')}", f"A value of {field} for each device is taken",
             (ALL, answer("p", **{field: Zeros(devices, 0, value)}), observe("p"))),
    )
]

_not_finite = [
    _bad("S8", f"{name}-{field.split('_')[0]}", "BAD_VALUE", f"{name} in {field} is refused", field,
         **{field: Zeros(_PER_DEVICE[field][0], 0, 0.0, bad)})
    for field in ("joint_targets", "magnet_currents")
    for name, bad in (("nan", math.nan), ("infinity", math.inf), ("minus-infinity", -math.inf))
]


def _message(radio: int, payload: bytes = b"x") -> dict:
    return {"radio": radio, "payload": payload}


def _heard_in_order(stage) -> str:
    """arm0 sends a and b, arm1 sends c; a radio that sends at a tick receives nothing."""
    heard = [(m.radio, m.payload) for m in stage.peer("p").observation.radio_messages]
    expected = [(radio, payload) for radio in (2, 3) for payload in (b"a", b"b", b"c")]
    return "" if heard == expected else f"heard {heard}; expected {expected}"


def _sights_add_up(stage) -> str:
    """A count per camera that has the detector, and as many readings as they count."""
    peer = stage.peer("p")
    seen = peer.observation
    cameras = [camera for robot in peer.welcome.robots for camera in robot.cameras]
    per_reading = {"led": {"colors": 1, "centers": 2}, "directional_led": {"colors": 1, "centers": 2},
                   "tag": {"payloads": 1, "centers": 2, "corners": 8}}
    for kind, values in per_reading.items():
        counts = getattr(seen, f"{kind}_counts")
        expected = sum(getattr(camera, f"detects_{kind}s") for camera in cameras)
        if len(counts) != expected:
            return f"{kind}_counts has {len(counts)} values; expected {expected}"
        for name, per in values.items():
            found = len(getattr(seen, f"{kind}_{name}"))
            if found != per * sum(counts):
                return f"{kind}_{name} has {found} values; expected {per * sum(counts)}"
    return "" if sum(seen.led_counts) else "no camera sees a lamp"


def _time_is_the_tick(stage) -> str:
    observation = stage.peer("p").observation
    expected = observation.tick * 100_000_000
    return "" if observation.time_ns == expected else f"time_ns is {observation.time_ns}; expected {expected}"


def _note_joints(stage) -> str:
    stage.memory["joints"] = list(stage.peer("p").observation.joint_readings)
    return ""


def _joints_turned(stage) -> str:
    """In the tick since _note_joints, at 1 rad/s."""
    after = stage.peer("p").observation.joint_readings
    turned = [b - a for a, b in zip(stage.memory["joints"], after)]
    return "" if all(abs(t - 0.1) < 0.03 for t in turned) else f"joints turned by {turned}; expected 0.1"


def _joints_stand(stage) -> str:
    """Since _note_joints."""
    pairs = zip(stage.memory["joints"], stage.peer("p").observation.joint_readings)
    turned = [b - a for a, b in pairs]
    return "" if all(abs(t) < 0.03 for t in turned) else f"joints turned by {turned}; expected 0"


def _joints_turn(stage) -> str:
    """At 1 rad/s for a tick of 0.1 s. Where they stood before does not matter: others moved them too."""
    stage.play((answer("p"),))
    before = list(stage.peer("p").observation.joint_readings)
    stage.play((Hear("p", "observation"),))
    after = stage.peer("p").observation.joint_readings
    turned = [b - a for a, b in zip(before, after)]
    return "" if all(abs(t - 0.1) < 0.01 for t in turned) else f"joints turned by {turned}; expected 0.1"


CASES = [
    Case("S1.consecutive", "Ticks follow one another",
         (ALL, *[step for _ in range(20) for step in
                 (answer("p"), Hear("p", "observation", {"tick": Tick(1)}))])),
    Case("S1.time", "time_ns is tick / ticks_per_second", (ALL, Check("time", _time_is_the_tick),
                                                           answer("p"), observe("p"),
                                                           Check("time", _time_is_the_tick))),
    Case("S1.tick-zero", "A run begins with tick 0, where readings are 0",
         (join("p", "*"), Hear("p", "observation", {"tick": 0, "time_ns": 0,
                                                    "joint_readings": [0.0] * 4})), fresh=True),
    _values("joint_readings", "joint_sensors"),
    _values("proximity", "proximity_sensors"),
    _values("positioning", "positioning", 7),
    _values("batteries", "battery", 2),
    Case("S3.command-releases", "The command releases the tick", (ALL, answer("p"), observe("p"))),
    Case("S3.waits", "The world waits for all", (TWO, answer("p"), Silence("p", 0.4), answer("q"),
                                                 observe("p", "q"))),
    Case("S3.heartbeat-does-not", "A Heartbeat does not release the tick",
         (ALL, heartbeat("p", 1), Hear("p", "heartbeat", {"sequence": 1}), Silence("p"), answer("p"),
          observe("p"))),
    Case("S3.error-does-not", "A refused Command does not release the tick",
         (ALL, answer("p", Tick(1)), hear_error("p", "FUTURE_TICK"), Silence("p"), answer("p"),
          observe("p"))),
    Case("S4.applied-next", "A Command is applied at the start of the next tick",
         (ALL, answer("p", joint_targets=Zeros("joint_actuators")), observe("p"), Check("joints", _note_joints),
          answer("p", joint_targets=Zeros("joint_actuators", 0, 1.0)), observe("p"),
          Check("joints", _joints_turned), Check("joints", _joints_turn),
          answer("p", joint_targets=Zeros("joint_actuators")), observe("p"))),
    Case("S5.empty", "An empty Command is legal", (ALL, *[s for _ in range(3) for s in
                                                          (answer("p"), *observe("p"))])),
    Case("S5.stays", "Values stay until changed",
         (ALL, answer("p", joint_targets=Zeros("joint_actuators", 0, 1.0)), observe("p"),
          Check("joints", _joints_turn), Check("joints", _joints_turn),
          answer("p", joint_targets=Zeros("joint_actuators")), observe("p"))),
    *_lengths,
    Case("S6.some-robots", "A Command may speak for some robots",
         (ALL, answer("p", robots=[2, 0], joint_targets=[0.1, 0.2]), observe("p"))),
    _bad("S6", "some-robots-long", "BAD_VALUE", "Values for robots that it does not speak for",
         "joint_targets", robots=[0], joint_targets=[0.1, 0.2]),
    _bad("S7", "position-beyond", "UNKNOWN_ROBOT", "A position beyond the session's robots", "robots",
         robots=[4]),
    _bad("S7", "position-huge", "UNKNOWN_ROBOT", "The largest position there can be", "robots",
         robots=[4294967295]),
    _bad("S7", "position-twice", "BAD_VALUE", "A position twice", "robots", robots=[1, 1]),
    Case("S7.left", "A robot that left can't be spoken for",
         (ALL, leave("p", 1), answer("p", robots=[1]), hear_error("p", "NOT_YOURS"), answer("p"),
          observe("p")), fresh=True),
    *_not_finite,
    Case("S9.stale", "A Command for an earlier tick is STALE_TICK",
         (ALL, answer("p"), observe("p"), answer("p", Tick(-1)), hear_error("p", "STALE_TICK"),
          answer("p"), observe("p"))),
    Case("S9.future", "A Command for a later tick is FUTURE_TICK",
         (ALL, answer("p", Tick(1)), hear_error("p", "FUTURE_TICK"), answer("p"), observe("p"))),
    Case("S9.far-future", "A Command for the largest tick is FUTURE_TICK",
         (ALL, answer("p", 2**64 - 1), hear_error("p", "FUTURE_TICK"), answer("p"), observe("p"))),
    Case("S9.duplicate", "A second Command for a tick is DUPLICATE_TICK; the first counts",
         (TWO, answer("p"), answer("p"), hear_error("p", "DUPLICATE_TICK"), answer("q"),
          observe("p", "q"))),
    Case("S9.first-counts", "The values of a second Command for a tick have no effect",
         (TWO, answer("p", joint_targets=Zeros("joint_actuators")), answer("q"), observe("p", "q"),
          Check("joints", _note_joints), answer("p"), answer("p", joint_targets=Zeros("joint_actuators", 0, 1.0)),
          hear_error("p", "DUPLICATE_TICK"), answer("q"), observe("p", "q"), Check("joints", _joints_stand))),
    Case("S9.resend", "Resending ten times is harmless",
         (TWO, answer("p"), *[s for _ in range(10) for s in
                              (answer("p"), hear_error("p", "DUPLICATE_TICK"))], answer("q"),
          observe("p", "q"))),
    Case("S10.no-effect", "A refused Command has no effect at all",
         (ALL, answer("p", radio_messages=[_message(0, b"lost")], led_colors=[1]),
          hear_error("p", "BAD_VALUE"), answer("p"),
          Hear("p", "observation", {"radio_messages": Count(0)}))),
    Case("S10.last-fault", "… whatever stands before its fault",
         (ALL, answer("p", joint_targets=Zeros("joint_actuators")), observe("p"), Check("joints", _note_joints),
          answer("p", joint_targets=Zeros("joint_actuators", 0, 1.0), radio_messages=[_message(0)],
                 log=[{"robot": 9, "text": "x"}]),
          hear_error("p", "UNKNOWN_ROBOT"), answer("p"), Hear("p", "observation", {"radio_messages": Count(0)}),
          Check("joints", _joints_stand))),
    Case("S11.log", "Lines may be logged", (ALL, answer("p", log=[{"robot": 0, "text": "hello"},
                                                                  {"robot": 3, "error": True,
                                                                   "text": "oh"}]), observe("p"))),
    _bad("S11", "log-beyond", "UNKNOWN_ROBOT", "A line of a robot that is not there", log=[
        {"robot": 9, "text": "x"}]),
    Case("S12.order", "Who answers first does not matter",
         (TWO, answer("q"), answer("p"), observe("p", "q"), answer("p"), answer("q"),
          observe("p", "q"))),
    _bad("D0", "led-beyond", "BAD_VALUE", "A colour above 0xFFFFFF is refused", "led_colors",
         led_colors=Zeros("leds", 0, 0, 0x1000000)),
    _bad("D0", "directional-led-beyond", "BAD_VALUE", "A directional LED's colour above 0xFFFFFF",
         "directional_led_colors", directional_led_colors=Zeros("directional_leds", 0, 0, 0xFFFFFFFF)),
    _bad("D0", "tag-too-long", "TOO_LARGE", "A payload above 64 KiB is refused", "tag_payloads",
         tag_payloads=Zeros("tags", 0, b"", b"x" * 65537)),
    Case("D0.tag-longest", "A payload of 64 KiB is taken",
         (ALL, answer("p", tag_payloads=Zeros("tags", 0, b"", b"x" * 65536)), observe("p"))),
    _bad("D0", "bearing-short", "BAD_VALUE", "Range-and-bearing data of another length",
         "range_and_bearing_data", range_and_bearing_data=b"\x01"),
    Case("D0.bearing-heard", "Range-and-bearing data are heard by the others",
         (ALL, answer("p", range_and_bearing_data=bytes(range(8))),
          Hear("p", "observation", {"range_and_bearing": Count(12)}),
          Check("data", lambda stage: "" if stage.peer("p").observation.range_and_bearing[0].data
                == b"\x02\x03" else "arm0 does not hear arm1's two bytes first"))),
    _bad("D6", "no-wheels", "BAD_VALUE", "Speeds of wheels that no robot has", "wheel_velocities",
         wheel_velocities=[0.1, 0.1]),
    *[_bad("D7", f"no-{name.replace('_', '-')}", "BAD_VALUE", f"{name} of a turret that no robot has",
           name, **{name: [value]})
      for name, value in (("turret_modes", "TURRET_SPEED"), ("turret_rotations", 0.5),
                          ("turret_speeds", 0.5))],
    Case("D8.counts", "What cameras see is counted per camera",
         (ALL, answer("p", led_colors=Zeros("leds", 0, 0xFF0000)), observe("p"),
          Check("sights", _sights_add_up))),
    _bad("D1", "radio-beyond", "UNKNOWN_DEVICE", "A radio beyond the session's", radio_messages=[
        _message(4)]),
    _bad("D1", "radio-huge", "UNKNOWN_DEVICE", "The largest radio there can be", radio_messages=[
        _message(4294967295)]),
    _bad("D1", "radio-not-spoken-for", "NOT_YOURS", "A radio of a robot that is not spoken for",
         robots=[0], radio_messages=[_message(1)]),
    Case("D1.of-the-session", "Radios are counted by session",
         (TWO, answer("q", radio_messages=[_message(0)]), answer("p"),
          Hear("p", "observation", {"radio_messages": Count(2)}),
          Hear("q", "observation", {"radio_messages": [{"radio": 1}]}))),
    Case("D1.left", "Messages of robots that left are ignored",
         (ALL, leave("p", 0), answer("p", radio_messages=[_message(0)]),
          Hear("p", "observation", {"radio_messages": Count(0)})), fresh=True),
    # In JSON a Command may be shorter than such a message (T4).
    _bad("D2", "message-too-long", "TOO_LARGE", "A message above 1 MiB", forms=("binary",), radio_messages=[
        _message(0, b"x" * (2**20 + 1))]),
    Case("D2.message-longest", "A message of 1 MiB is taken",
         (ALL, answer("p", radio_messages=[_message(0, b"x" * 2**20)]),
          Hear("p", "observation", {"radio_messages": Count(3)})),
         forms=("binary",)),
    _bad("D2", "too-many-messages", "TOO_LARGE", "65 537 messages of one robot", radio_messages=[
        _message(0, b"")] * 65537),
    Case("D3.order", "Messages come by receiving radio, then by sender, then as sent",
         (ALL, answer("p", radio_messages=[_message(1, b"c"), _message(0, b"a"), _message(0, b"b")]),
          observe("p"), Check("order", _heard_in_order))),
    Case("D3.empty-message", "An empty message is a message",
         (ALL, answer("p", radio_messages=[_message(0, b"")]),
          Hear("p", "observation", {"radio_messages": Count(3)}))),
    Case("D3.once", "What is not taken at its tick is gone",
         (ALL, answer("p", radio_messages=[_message(0)]),
          Hear("p", "observation", {"radio_messages": Count(3)}), answer("p"),
          Hear("p", "observation", {"radio_messages": Count(0)}))),
    Case("D4.every-tick", "Range-and-bearing data are sent at every tick",
         (ALL, answer("p"), Hear("p", "observation", {"range_and_bearing": Count(12)}), answer("p"),
          Hear("p", "observation", {"range_and_bearing": Count(12)}))),
]
