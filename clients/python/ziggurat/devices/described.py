# SPDX-License-Identifier: MIT
"""Devices that describe themselves: the server tells the names and units of their values."""

from __future__ import annotations

from typing import Dict, Iterator, List, Mapping, NamedTuple, Sequence, Tuple

from .. import protocol_pb2 as v1
from ..exchange import Exchange, Places
from ..named import Named
from .device import Device, Quaternion, Vector, finite, quaternion, vector

__all__ = ["DeviceCommand", "DescribedDevice", "DevicesByKind", "DeviceField"]


class DeviceField(NamedTuple):
    """A value that devices of a kind read, or that is told of each once."""

    name: str
    unit: str  # empty: a number without unit; 0xRRGGBB: a colour


class DeviceCommand(NamedTuple):
    """A value that can be commanded."""

    name: str
    unit: str
    least: float
    most: float
    initial: float


class Kind:
    """What devices of a kind of one robot have in common."""

    def __init__(self, given: v1.DeviceKind):
        self.name: str = given.name
        self.readings: Dict[str, int] = {field.name: i for i, field in enumerate(given.readings)}
        self.properties: Dict[str, int] = {field.name: i for i, field in enumerate(given.properties)}
        self.commands: Dict[str, int] = {field.name: i for i, field in enumerate(given.commands)}
        self.fields = tuple(DeviceField(field.name, field.unit) for field in given.readings)
        self.property_fields = tuple(DeviceField(field.name, field.unit) for field in given.properties)
        self.command_fields = tuple(DeviceCommand(field.name, field.unit, field.least, field.most, field.initial)
                                    for field in given.commands)
        self.has_rows: bool = given.most_rows > 0


class DescribedDevice(Device):
    """Its readings and properties are attributes: `light.value`. One that reads any number of rows has them in `rows`, each
    a mapping. Readings are 0 before the first tick."""

    __slots__ = ("kind", "anchor", "position", "orientation", "_kind", "_properties", "_place", "_commands")

    def __init__(self, exchange: Exchange, kind: Kind, given: v1.DescribedDevice):
        super().__init__(exchange, given.id)
        self.kind: str = kind.name  # of its element in the scene
        self.anchor: str = given.anchor  # id of a link, or "origin"
        self.position: Vector = vector(given.position)  # in the anchor's frame [m]
        self.orientation: Quaternion = quaternion(given.orientation)  # in the anchor's frame
        self._kind = kind
        self._properties: Tuple[float, ...] = tuple(given.properties)
        self._place = exchange.places("device_rows", 1) if kind.has_rows \
            else exchange.places("device_readings", len(kind.fields))
        self._commands = [exchange.add("device_commands", field.initial) for field in kind.command_fields]

    @property
    def fields(self) -> Tuple[DeviceField, ...]:
        """The names and units of its readings, or of those of each row."""
        return self._kind.fields

    @property
    def property_fields(self) -> Tuple[DeviceField, ...]:
        return self._kind.property_fields

    @property
    def command_fields(self) -> Tuple[DeviceCommand, ...]:
        return self._kind.command_fields

    @property
    def readings(self) -> Sequence[float]:
        """All readings, in the order of `fields`; none if it reads rows."""
        return self._exchange.read(self._places)

    @property
    def _places(self) -> List[Places]:
        """Of its readings."""
        return [] if self._kind.has_rows else [("device_readings", self._place, self._place + len(self._kind.fields))]

    @property
    def rows(self) -> List[Mapping[str, float]]:
        """What it sees at this tick, if it reads rows."""
        if not self._kind.has_rows:
            return []
        names, begins = tuple(self._kind.readings), self._exchange.row_begins
        if self._place + 1 >= len(begins):
            return []
        values = self._exchange.seen.device_row_values
        return [dict(zip(names, values[first:first + len(names)]))
                for first in range(begins[self._place], begins[self._place + 1], len(names))]

    def __getattr__(self, name: str) -> float:
        if name.startswith("_"):
            raise AttributeError(name)
        if name in self._kind.readings and not self._kind.has_rows:
            return self.readings[self._kind.readings[name]]
        if name in self._kind.properties:
            return self._properties[self._kind.properties[name]]
        known = [*([] if self._kind.has_rows else self._kind.readings), *self._kind.properties]
        raise AttributeError(f"{self._kind.name} has no {name!r}; it has: {', '.join(known) or 'no values'}"
                             + ("; what it reads is in its `rows`" if self._kind.has_rows else ""))

    def set(self, name: str, value: float) -> None:
        """Sets a command; it stays until changed."""
        field = self._field(name)
        _, _, least, most, _ = self._kind.command_fields[field]
        value = finite(value, f"{name} of {self.kind}")
        if not least <= value <= most:
            raise ValueError(f"{name} of {self.kind} must be from {least} to {most}, not {value}")
        self._exchange.set("device_commands", self._commands[field], value)

    def commanded(self, name: str) -> float:
        """The last value set; before that, the initial one."""
        return float(self._exchange.values["device_commands"][self._commands[self._field(name)]])

    def _field(self, name: str) -> int:
        if name not in self._kind.commands:
            raise KeyError(f"{self.kind} has no command {name!r}; it has: {', '.join(self._kind.commands) or 'none'}")
        return self._kind.commands[name]

    def __repr__(self) -> str:
        return f"DescribedDevice({self.kind!r}, {self.id!r})"


class DevicesByKind(Mapping[str, Named[DescribedDevice]]):
    """A robot's devices that describe themselves, by the name of their kind."""

    def __init__(self, exchange: Exchange, robot: v1.RobotDescription):
        self._owner = f"robot {robot.id!r}"
        self._kinds: Dict[str, Named[DescribedDevice]] = {}
        for given in robot.device_kinds:
            kind = Kind(given)
            if kind.has_rows:
                exchange.row_widths.extend([len(kind.fields)] * len(given.devices))
            devices = [DescribedDevice(exchange, kind, device) for device in given.devices]
            self._kinds[kind.name] = Named(devices, kind.name, self._owner)

    def __getitem__(self, kind: str) -> Named[DescribedDevice]:
        if kind in self._kinds:
            return self._kinds[kind]
        raise KeyError(f"{self._owner} has no devices of kind {kind!r}; it has: {', '.join(self._kinds) or 'none'}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._kinds)

    def __len__(self) -> int:
        return len(self._kinds)

    def __repr__(self) -> str:
        return repr(self._kinds)
