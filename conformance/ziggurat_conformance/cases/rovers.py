# SPDX-License-Identifier: MIT
"""Section 3.1: wheels, turrets, pictures, IMUs, contact sensors and devices that describe themselves, in a scene of
their own. rover0 and rover1 drive and measure, rover2 only measures. rover1 has all of the others."""

import math

from ..case import Case
from ..messages import answer, hear_error, hello, join, leave, observe
from ..steps import Check, Join

SCENE = "rovers"
ALL = [join("p", "*"), *observe("p")]
_DRIVERS = 2  # of the three robots


def _case(id: str, title: str, *steps, fresh: bool = False) -> Case:
    return Case(id, title, steps, fresh=fresh, scene=SCENE)


def _stands(peer: str = "p", robots: int = _DRIVERS) -> list:
    """Whatever the case before has left: wheels stand, turrets turn with their robots."""
    return [answer(peer, wheel_velocities=[0.0] * 2 * robots, turret_modes=["TURRET_PASSIVE"] * robots,
                   turret_rotations=[0.0] * robots, turret_speeds=[0.0] * robots), *observe(peer)]


def _speeds(*expected: float) -> Check:
    """Velocities of left and right wheels, robot by robot."""

    def check(stage) -> str:
        told = list(stage.peer("p").observation.wheels)
        if len(told) != 4 * len(expected) // 2:
            return f"wheels has {len(told)} values; expected {4 * len(expected) // 2}"
        found = [told[4 * (i // 2) + i % 2] for i in range(len(expected))]
        wrong = any(abs(a - b) > 1e-9 for a, b in zip(found, expected))
        return f"the wheels' speeds are {found}; expected {list(expected)}" if wrong else ""

    return Check("wheels", check)


def _distances(stage) -> str:
    """What the speeds carry in a tick of 0.1 s."""
    told = list(stage.peer("p").observation.wheels)
    wrong = any(abs(told[i + 2] - 0.1 * told[i]) > 1e-9 for i in range(len(told)) if i % 4 < 2)
    return f"wheels is {told}: distances are not a tenth of the speeds" if wrong else ""


def _remember(stage) -> str:
    stage.memory["turrets"] = list(stage.peer("p").observation.turret_rotations)
    count = len(stage.peer("p").welcome.robots)
    found = len(stage.memory["turrets"])
    return "" if found == count else f"turret_rotations has {found} values; expected {count}"


def _turned(*expected: float) -> Check:
    """By how much the turrets turned since _remember."""

    def check(stage) -> str:
        pairs = zip(stage.memory["turrets"], stage.peer("p").observation.turret_rotations)
        found = [math.remainder(b - a, math.tau) for a, b in pairs]
        wrong = len(found) != len(expected) or any(abs(a - b) > 1e-6 for a, b in zip(found, expected))
        return f"the turrets turned by {found}; expected {list(expected)}" if wrong else ""

    return Check("turrets", check)


def _point_to(*expected: float) -> Check:
    def check(stage) -> str:
        found = list(stage.peer("p").observation.turret_rotations)
        wrong = len(found) != len(expected) or any(
            abs(math.remainder(a - b, math.tau)) > 0.05 for a, b in zip(found, expected))
        return f"the turrets point to {found}; expected {list(expected)}" if wrong else ""

    return Check("turrets", check)


def _images(size: int) -> Check:
    def check(stage) -> str:
        found = [len(image) for image in stage.peer("p").observation.camera_images]
        return "" if found == [size] else f"camera_images are of {found} bytes; expected [{size}]"

    return Check("pictures", check)


def _feels(stage) -> str:
    """rover1 stands on level ground."""
    found = list(stage.peer("p").observation.imus)
    wrong = len(found) != 6 or any(abs(a - b) > 1e-3 for a, b in zip(found, [0, 0, 9.8, 0, 0, 0]))
    return f"imus is {found}; [0, 0, 9.8, 0, 0, 0] is expected" if wrong else ""


def _touches(stage) -> str:
    found = list(stage.peer("p").observation.contact_sensors)
    wrong = len(found) != 5 or found[0] != 1 or found[3] <= 0 or found[4] < found[3] - 1e-9
    return f"contact_sensors is {found}; [1, x, y, force up, strength] is expected" if wrong else ""


def _kind(stage, name: str):
    return next(kind for kind in stage.peer("p").welcome.robots[1].device_kinds if kind.name == name)


def _described(stage) -> str:
    light, scanner = _kind(stage, "footbot_light"), _kind(stage, "footbot_distance_scanner")
    found = [[field.name for field in fields] for fields in (light.readings, light.properties, scanner.commands)]
    if found != [["value"], ["angle"], ["mode", "angle", "speed"]] or len(light.devices) != 24 or not scanner.most_rows:
        return f"rover1 is told of the devices {stage.peer('p').welcome.robots[1].device_kinds}"
    return ""


def _sees_light(stage) -> str:
    """A light of intensity 1 is 1 m ahead."""
    angles = [device.properties[0] for device in _kind(stage, "footbot_light").devices]
    expected = [math.exp(-2) * max(0.0, 1 - 2 * abs(angle) / math.pi) for angle in angles]
    found = list(stage.peer("p").observation.device_readings)[:24]  # those of the ground are behind
    wrong = len(found) != 24 or any(abs(a - b) > 1e-6 for a, b in zip(found, expected))
    return f"device_readings is {found}; {expected} is expected" if wrong else ""


def _rows(count: int) -> Check:
    def check(stage) -> str:
        told = stage.peer("p").observation
        wrong = list(told.device_rows) != [count] or len(told.device_row_values) != 3 * count
        return f"device_rows is {list(told.device_rows)}; [{count}] is expected" if wrong else ""

    return Check("rows", check)


def _bad(rule: str, name: str, title: str, field: str, values: list, **more) -> Case:
    """A command that is BAD_VALUE and has no effect; a right one follows."""
    return _case(f"{rule}.{name}", title, ALL, _stands(), answer("p", **{field: values}, **more),
                 hear_error("p", "BAD_VALUE", field=field), answer("p"), observe("p"),
                 _speeds(0, 0, 0, 0, 0, 0))


_ZEROS = {"wheel_velocities": [0.1] * 4, "turret_modes": ["TURRET_SPEED"] * 2,
          "turret_rotations": [0.5] * 2, "turret_speeds": [0.5] * 2}
_KEBAB = {field: field.replace("_", "-") for field in _ZEROS}
_TICKS = [step for _ in range(40) for step in (answer("p"), *observe("p"))]

CASES = [
    _case("D6.per-wheel", "A speed for each wheel of the robots that drive, left and right", ALL,
          answer("p", wheel_velocities=[0.1, 0.2, -0.1, 0.05]), observe("p"),
          _speeds(0.1, 0.2, -0.1, 0.05, 0, 0), Check("distances", _distances), _stands()),
    _case("D6.stays", "Speeds of wheels stay until changed", ALL,
          answer("p", wheel_velocities=[0.1] * 4), observe("p"), answer("p"), observe("p"),
          _speeds(0.1, 0.1, 0.1, 0.1, 0, 0), _stands(), _speeds(0, 0, 0, 0, 0, 0)),
    _case("D6.begins", "They begin as 0", ALL, _speeds(0, 0, 0, 0, 0, 0), answer("p"), observe("p"),
          _speeds(0, 0, 0, 0, 0, 0), fresh=True),
    _case("D6.some", "A command may speak for one robot: two values", ALL, _stands(),
          answer("p", robots=[1], wheel_velocities=[0.1, 0.2]), observe("p"),
          _speeds(0, 0, 0.1, 0.2, 0, 0), _stands()),
    _case("D6.asked-order", "Values are in the order of `robots`", ALL, _stands(),
          answer("p", robots=[1, 0], wheel_velocities=[0.1, 0.2, 0.3, 0.4]), observe("p"),
          _speeds(0.3, 0.4, 0.1, 0.2, 0, 0), _stands()),
    _case("D6.described", "Welcome names the robots that drive and those that measure",
          Join("p", hello("*"), {"robots": [
              {"wheels": {"drives": True, "measures": True}, "turret": {"drives": True, "measures": True}},
              {"wheels": {"drives": True, "measures": True}, "turret": {"drives": True, "measures": True}},
              {"wheels": {"drives": False, "measures": True},
               "turret": {"drives": False, "measures": True}}]})),
    _bad("D6", "of-a-passenger", "Speeds for a robot that only measures", "wheel_velocities",
         [0.1, 0.1], robots=[2]),
    _case("D6.left", "The wheels of robots that left stand (L1)", ALL,
          answer("p", wheel_velocities=[0.1] * 4), observe("p"), leave("p", 0), answer("p"),
          observe("p"), _speeds(0, 0, 0.1, 0.1, 0, 0),
          answer("p", wheel_velocities=[0.1] * 4), observe("p"), _speeds(0, 0, 0.1, 0.1, 0, 0), fresh=True),
    *[_bad("S6", f"{name}-{_KEBAB[field]}", f"One value of {field} too {word}", field, values)
      for field, zeros in _ZEROS.items()
      for name, word, values in (("short", "few", zeros[1:]), ("long", "many", zeros + zeros[:1]))],
    *[_bad("S8", f"{name}-{_KEBAB[field]}", f"{name} in {field} is refused", field,
           [bad, *_ZEROS[field][1:]])
      for field in ("wheel_velocities", "turret_rotations", "turret_speeds")
      for name, bad in (("nan", math.nan), ("infinity", math.inf))],
    *[_bad("D7", f"mode-{mode}", "A mode that does not exist", "turret_modes", ["TURRET_SPEED", mode])
      for mode in (0, 4, 77)],
    _bad("D7", "of-a-passenger", "A mode for a robot that only measures", "turret_modes",
         ["TURRET_SPEED"], robots=[2]),
    _case("D7.begins", "A turret begins passive, at 0 and with speed 0", ALL, Check("", _remember),
          answer("p", turret_speeds=[1.0, 1.0], turret_rotations=[1.0, 1.0]), observe("p"),
          answer("p"), observe("p"), _turned(0, 0, 0),  # a value changes no mode
          answer("p", turret_modes=["TURRET_SPEED", "TURRET_PASSIVE"]), observe("p"),
          _turned(0.1, 0, 0), fresh=True),  # and waits for its own
    _case("D7.left", "The turrets of robots that left stand (L1)", ALL,
          answer("p", turret_modes=["TURRET_SPEED"] * 2, turret_speeds=[1.0, 1.0]), observe("p"), leave("p", 0),
          answer("p"), observe("p"), Check("", _remember), answer("p"), observe("p"), _turned(0, 0.1, 0), fresh=True),
    _case("D7.speed", "At a speed it turns, until told otherwise", ALL, _stands(), Check("", _remember),
          answer("p", turret_modes=["TURRET_SPEED"] * 2, turret_speeds=[1.0, -0.5]), observe("p"),
          _turned(0.1, -0.05, 0), answer("p"), observe("p"), _turned(0.2, -0.1, 0),
          answer("p", turret_speeds=[0.0, 0.0]), observe("p"), _turned(0.2, -0.1, 0), _stands()),
    _case("D7.position", "Towards an angle it turns until it is there", ALL, _stands(),
          answer("p", turret_modes=["TURRET_POSITION"] * 2, turret_rotations=[1.0, -2.0]), observe("p"),
          _TICKS, _TICKS, _TICKS, _point_to(1.0, -2.0, 0), _stands()),
    _case("D7.by-itself", "Setting one thing changes no other", ALL, _stands(), Check("", _remember),
          answer("p", turret_modes=["TURRET_SPEED"] * 2, turret_speeds=[1.0, 1.0]), observe("p"),
          answer("p", turret_rotations=[2.0, 2.0]), observe("p"), _turned(0.2, 0.2, 0), _stands()),
    _case("D7.robot-turns", "A passive turret turns with its robot: its rotation stays", ALL, _stands(),
          Check("", _remember), answer("p", wheel_velocities=[-0.05, 0.05, 0.1, 0.1]), observe("p"),
          _turned(0, 0, 0), _stands()),
    _case("D8.picture", "A camera with `image` has a picture of width × height × 3 bytes",
          ALL, answer("p"), observe("p"), _images(16 * 12 * 3)),
    _case("D8.no-picture-at-tick-0", "At tick 0 it is empty", ALL, _images(0), fresh=True),
    _case("D9.described", "Welcome says which IMUs there are, and where",
          Join("p", hello("*"), {"robots": [
              {}, {"imus": [{"id": "imu", "anchor": "origin", "position": [0.0, 0.0, 0.05],
                             "orientation": [1.0, 0.0, 0.0, 0.0]}]}, {}]})),
    _case("D9.six-values", "An IMU has six values; at rest it feels the ground push up", ALL, _stands(),
          Check("imus", _feels), answer("p"), observe("p"), Check("imus", _feels)),
    _case("D10.described", "Welcome says which contact sensors there are",
          Join("p", hello("*"), {"robots": [
              {}, {"contact_sensors": [{"id": "skin", "anchor": "origin"}]}, {}]})),
    _case("D11.described", "Welcome says what devices read, have and are told", ALL, Check("kinds", _described)),
    _case("D11.values", "Their readings are in the order of the description", ALL, answer("p"), observe("p"),
          Check("lights", _sees_light), fresh=True),
    _case("D12.rows", "A device with rows says how many; there are none until it is commanded", ALL, _rows(0),
          answer("p", device_commands=[1.0, 0.0, 0.0]), observe("p"), _rows(4),
          answer("p", device_commands=[0.0, 0.0, 0.0]), observe("p"), _rows(0), fresh=True),
    _case("D13.stays", "What devices are told stays until changed", ALL,
          answer("p", device_commands=[1.0, 0.0, 0.0]), observe("p"), answer("p"), observe("p"), _rows(4),
          answer("p", robots=[1], device_commands=[0.0, 0.0, 0.0]), observe("p"), _rows(0)),
    _case("D13.left", "Commands of a robot that left are released", ALL,
          answer("p", device_commands=[2.0, 0.0, 1.0]), observe("p"), _rows(24), leave("p", 1), answer("p"), observe("p"),
          _rows(0), fresh=True),
    *[_bad("D13", name, title, "device_commands", values)
      for name, title, values in (("short", "Too few commands", [1.0, 0.0]), ("long", "Too many commands", [1.0] * 4),
                                  ("beyond", "A mode beyond its limit", [3.0, 0.0, 0.0]),
                                  ("below", "A mode below its limit", [-1.0, 0.0, 0.0]),
                                  ("nan", "A command that is no number", [1.0, math.nan, 0.0]))],
    _bad("D13", "of-another", "Commands for a robot that has no such device", "device_commands", [1.0, 0.0, 0.0],
         robots=[0]),
    _case("D14.drawn", "Robots draw arrows, rings and texts", ALL,
          answer("p", markers=[{"robot": 1, "at": [0.0, 0.0, 0.1], "to": [1.0, 0.0, 0.1], "color": 0xFF0000},
                               {"robot": 1, "at": [0.0, 0.0, 0.1], "radius": 0.5},
                               {"robot": 1, "at": [0.0, 0.0, 0.3], "text": "here"}]), observe("p")),
    *[_bad("D14", name, title, "markers", [{"robot": 1, "at": [0.0, 0.0, 0.0], **marker}]) for name, title, marker in (
        ("no-shape", "A marker without shape", {}), ("two", "… with two", {"radius": 1.0, "text": "x"}),
        ("place", "… without place", {"at": [0.0], "radius": 1.0}), ("far", "… too far away", {"to": [2e6, 0.0, 0.0]}),
        ("long", "… with too long a text", {"text": "x" * 101}),
        ("color", "… without colour", {"radius": 1.0, "color": 0x1000000}))],
    _case("D14.of-another", "A robot that has no debug does not draw", ALL, _stands(),
          answer("p", markers=[{"robot": 0, "at": [0.0, 0.0, 0.0], "radius": 1.0}]),
          hear_error("p", "UNKNOWN_DEVICE", field="markers"), answer("p"), observe("p")),
    _case("D14.many", "More than 1000 markers of a robot are TOO_MANY", ALL, _stands(),
          answer("p", markers=[{"robot": 1, "at": [0.0, 0.0, 0.0], "radius": 1.0}] * 1001),
          hear_error("p", "TOO_MANY", field="markers"), answer("p"), observe("p")),
    _case("D10.five-values", "A contact sensor has five values; on the ground it touches", ALL, _stands(),
          Check("contact_sensors", _touches)),
]
