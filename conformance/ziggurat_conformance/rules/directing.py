# SPDX-License-Identifier: MIT
"""What is wrong with messages of a director, or to one, whatever the world is (section 9.1)."""

import math
from typing import Iterator, Optional

from ..wire import protocol
from .command import metric_faults
from .fault import Fault

_MOST_ACTS, _MOST_LINES, _LONGEST_RESULT = 10_000, 1000, 1024
_LONGEST_IMAGE = 2 << 20  # for the floor [bytes]
_LARGEST = 1e6  # of a force [N] or torque [N m], and of a painted region [m]
_Group = protocol.Subscription


def direction_faults(direction: protocol.Direction) -> Iterator[Fault]:
    if len(direction.acts) > _MOST_ACTS:
        yield Fault("K5", f"a Direction has {len(direction.acts)} acts", "TOO_MANY", "acts")
    if len(direction.log) > _MOST_LINES:
        yield Fault("K5", f"a Direction has {len(direction.log)} log lines", "TOO_MANY", "log")
    for number, act in enumerate(direction.acts[:_MOST_ACTS]):
        if act.WhichOneof("act") is None:
            yield Fault("R8", f"act {number} has no kind", "BAD_VALUE", f"acts[{number}]")
        for name in ("force", "torque"):
            values = getattr(act.push, name)
            if values and (len(values) != 3 or not all(abs(value) <= _LARGEST for value in values)):
                yield Fault("R8", f"the {name} of act {number} is {list(values)}", "BAD_VALUE",
                            f"acts[{number}].push.{name}")
        if act.WhichOneof("act") == "paint_floor" and len(act.paint_floor.image) > _LONGEST_IMAGE:
            yield Fault("R12", f"the image of act {number} has more than 2 MiB", "TOO_LARGE",
                        f"acts[{number}].paint_floor.image")
        elif act.WhichOneof("act") == "paint_floor" and not _is_region(act.paint_floor):
            yield Fault("R12", f"act {number} paints no region", "BAD_VALUE", f"acts[{number}].paint_floor")
    if sum(bool(act.paint_floor.image) for act in direction.acts) > 1:
        yield Fault("R12", "a Direction lays several images", "TOO_MANY", "acts")
    if len(direction.finish.result.encode()) > _LONGEST_RESULT:
        yield Fault("R10", "a result is longer than 1 KiB", "TOO_LARGE", "finish.result")
    yield from _figures(direction.metrics)


def _is_region(paint: protocol.PaintFloor) -> bool:
    if paint.image:
        return not paint.center and not paint.size and paint.color == 0
    return (len(paint.center) == 2 and len(paint.size) in (1, 2) and paint.color <= 0xFFFFFF
            and all(abs(value) <= _LARGEST for value in paint.center)
            and all(0 < value <= _LARGEST for value in paint.size))


def last_words_faults(leave: protocol.Leave) -> Iterator[Fault]:
    if leave.reason not in (protocol.Leave.DONE, protocol.Leave.FAILED):
        yield Fault("L1", f"a Leave has the reason {leave.reason}", "BAD_VALUE", "reason")
    if leave.robots:
        yield Fault("R9", "a Leave of a director names robots", "UNKNOWN_ROBOT", "robots")
    yield from _figures(leave.metrics)


def _figures(metrics) -> Iterator[Fault]:
    return metric_faults(math.inf, metrics)


def world_state_faults(entities: list, groups: Optional[set], told: protocol.WorldState) -> Iterator[Fault]:
    """groups  that were subscribed to; None: not known, because the session was resumed"""
    def count(kind: str) -> int:
        return sum(len(getattr(entity, kind)) for entity in entities)

    links = count("links")
    lengths = [("poses", _Group.POSES, 7 * len(entities)), ("links", _Group.LINKS, 13 * links),
               ("joints", _Group.JOINTS, 2 * count("joints")), ("led_colors", _Group.LEDS, count("leds")),
               ("directional_led_colors", _Group.LEDS, count("directional_leds")),
               ("tag_payloads", _Group.TAGS, count("tags")), ("magnets", _Group.MAGNETS, 3 * count("magnets"))]
    for field, group, length in lengths:
        found = len(getattr(told, field))
        expected = (length,) if groups is not None and group in groups else (0,) if groups is not None else (0, length)
        if found not in expected:
            yield Fault("R4", f"{field} has {found} values; {expected[-1]} are expected")
    if 2 * len(told.contacts) != 9 * len(told.contact_links):
        yield Fault("R5", f"there are {len(told.contact_links)} links and {len(told.contacts)} values of contacts")
    if any(not -2 <= link < links for link in told.contact_links) or any(link < 0 for link in told.contact_links[::2]):
        yield Fault("R5", f"the contacts are of the links {list(told.contact_links)}; {links} are told")
    if told.tick == 0 and told.contacts:
        yield Fault("R5", "there are contacts at tick 0")
    radios = count("radios")
    if any(message.radio >= radios or not -2 <= message.sender < radios for message in told.radio_messages):
        yield Fault("R5", f"a message is of a radio that is not told; {radios} are")
