# SPDX-License-Identifier: MIT
"""The packed arrays of a session, which handles of devices read and write."""

from __future__ import annotations

from collections import Counter, defaultdict
from itertools import accumulate
from operator import mul
from typing import Any, Callable, Dict, Generic, List, Optional, Sequence, Set, Tuple, TypeVar, cast

from . import protocol_pb2 as v1
from .metrics import Metrics
from .packed import NUMBERS, packed_command, packed_values

T = TypeVar("T")
Places = Tuple[str, int, int]  # of readings in a field of Observation: from, to


def joined(places: Sequence[Places]) -> List[Places]:
    """The same with those that follow each other as one."""
    result: List[Places] = []
    for field, begin, end in places:
        if result and result[-1][0] == field and result[-1][2] == begin:
            begin = result.pop()[1]
        result.append((field, begin, end))
    return result


class Exchange:
    """Values of all robots of a session, in Welcome's order."""

    def __init__(self) -> None:
        self.seen = v1.Observation()  # the last one
        self._sorted: Dict[str, Any] = {}  # what it has, by device: sorted when it is asked for
        self.row_widths: List[int] = []  # of each device that reads rows: the values of one
        # By field of Command, a value for each device.
        self.values: Dict[str, List[Any]] = defaultdict(list)
        self.data = bytearray()  # of all range-and-bearing actuators
        self.messages: List[Tuple[int, bytes]] = []
        self.markers: Dict[int, List[v1.Marker]] = defaultdict(list)  # by robot
        self.log: List[v1.LogLine] = []
        self.metrics = Metrics()
        self._places: Counter[str] = Counter()
        self._initial: Dict[str, List[Any]] = {}
        self._new: Set[str] = set()  # fields that were set after the last command
        self._used: Set[str] = set()  # fields that were ever set

    def add(self, field: str, value: Any) -> int:
        """Adds the value of the next device; returns its place."""
        self.values[field].append(value)
        return len(self.values[field]) - 1

    def places(self, kind: str, count: int) -> int:
        """The first of the next places among the readings of a kind of device."""
        self._places[kind] += count
        return self._places[kind] - count

    def place(self, kind: str, is_there: bool = True) -> int:
        """The next place among the readings of a kind of device; -1 for one that is not there."""
        if not is_there:
            return -1
        self._places[kind] += 1
        return self._places[kind] - 1

    def begin(self) -> None:
        """All devices have been added."""
        self._initial = {field: list(values) for field, values in self.values.items()}

    def reset(self) -> None:
        """The world was reset, and so are all values."""
        for field, values in self._initial.items():
            self.values[field][:] = values
        self.data[:] = bytes(len(self.data))
        self.messages.clear()
        self.markers.clear()
        self._new.clear()
        self._used.clear()

    def resume(self, commanded: v1.Command) -> None:
        """The session was resumed: values are those that were commanded before."""
        for field, values in self.values.items():
            before = getattr(commanded, field)
            if len(before) == len(values):
                values[:] = before
                self._used.add(field)
        if len(commanded.range_and_bearing_data) == len(self.data):
            self.data[:] = commanded.range_and_bearing_data
            self._used.add("data")

    def repeat(self) -> None:
        """The server may have discarded the last command: the next one has all values again."""
        self._new |= self._used

    def set(self, field: str, place: int, value: Any) -> None:
        self.values[field][place] = value
        self._new.add(field)

    def set_data(self, begin: int, data: bytes) -> None:
        self.data[begin:begin + len(data)] = data
        self._new.add("data")

    def observe(self, observation: v1.Observation) -> None:
        self.seen = observation
        if self._sorted:
            self._sorted = {}

    def read(self, places: Sequence[Places]) -> List[float]:
        """What stands at these places, one after the other; 0 before the first tick."""
        values: List[float] = []
        for field, begin, end in places:
            values.extend(getattr(self.seen, field)[begin:end] or [0.0] * (end - begin))
        return values

    @property
    def heard(self) -> Dict[int, List[bytes]]:
        """By radio."""
        if "heard" not in self._sorted:
            heard: Dict[int, List[bytes]] = {}
            self._sorted["heard"] = heard
            for message in self.seen.radio_messages:
                heard.setdefault(message.radio, []).append(message.payload)
        return cast(Dict[int, List[bytes]], self._sorted["heard"])

    @property
    def packets(self) -> Dict[int, List[Any]]:
        """By robot."""
        if "packets" not in self._sorted:
            packets: Dict[int, List[Any]] = {}
            self._sorted["packets"] = packets
            for packet in self.seen.range_and_bearing:
                packets.setdefault(packet.robot, []).append(packet)
        return cast(Dict[int, List[Any]], self._sorted["packets"])

    def begins(self, kind: str) -> List[int]:
        """Each camera's first reading of this detector, and the end."""
        if kind not in self._sorted:
            self._sorted[kind] = [0, *accumulate(getattr(self.seen, kind + "_counts"))]
        return cast(List[int], self._sorted[kind])

    @property
    def row_begins(self) -> List[int]:
        """Of each device that reads rows, its first value of device_row_values, and their end."""
        if "rows" not in self._sorted:
            self._sorted["rows"] = [0, *accumulate(map(mul, self.seen.device_rows, self.row_widths))]
        return cast(List[int], self._sorted["rows"])

    def command(self, tick: int, epoch: Optional[int] = None) -> bytes:
        """A ClientMessage with a Command of the values that were set after the last one."""
        parts = b""
        has_more = bool(self.messages or self.markers or self.log or self.metrics)
        for field in self._new:
            if field in NUMBERS:
                parts += packed_values(field, self.values[field])
            else:
                has_more = True
        return packed_command(tick, epoch, parts + self._rest() if has_more else parts)

    def _rest(self) -> bytes:
        """What of the command is not packed numbers."""
        command = v1.Command(log=self.log, metrics=self.metrics.take())
        for field in self._new - NUMBERS.keys():
            if field == "data":
                command.range_and_bearing_data = bytes(self.data)
            else:
                getattr(command, field).extend(self.values[field])
        for radio, payload in self.messages:
            command.radio_messages.add(radio=radio, payload=payload)
        for markers in self.markers.values():
            command.markers.extend(markers)
        return bytes(command.SerializeToString())

    def sent(self) -> None:
        """The command was sent."""
        if self._new:
            self._used |= self._new
            self._new.clear()
        if self.messages or self.markers or self.log:
            self.messages.clear()
            self.markers.clear()
            self.log.clear()


class Readings(Generic[T]):
    """A property of robots: a fixed number of values of the last observation. None for a robot
    without the sensor, or before the first tick."""

    def __init__(self, field: str, count: int, make: Callable[[Sequence[float]], T],
                 is_there: Callable[[v1.RobotDescription], bool]):
        self.field = field  # of Observation
        self._count = count
        self._make = make
        self._is_there = is_there

    def place(self, exchange: Exchange, given: v1.RobotDescription) -> int:
        return exchange.place(self.field, self._is_there(given))

    def __get__(self, robot: Any, owner: Any = None) -> Optional[T]:
        place = robot._places[self.field]
        values = getattr(robot._exchange.seen, self.field)
        if place < 0 or not values:
            return None
        return self._make(values[place * self._count:(place + 1) * self._count])
