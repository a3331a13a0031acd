# SPDX-License-Identifier: MIT
"""Lists with access by id."""

from __future__ import annotations

import difflib
from typing import Any, Dict, Generic, Iterable, Iterator, Protocol, Sequence, Tuple, TypeVar, Union

class WithId(Protocol):
    id: str


T = TypeVar("T", bound=WithId)


class Named(Sequence[T]):
    """A list with access by position or by id."""

    __slots__ = ("_things", "_kind", "_owner", "_by_id")

    def __init__(self, things: Iterable[T], kind: str, owner: str = ""):
        """owner: whose they are, for messages."""
        self._things: Tuple[T, ...] = tuple(things)
        self._kind = kind
        self._owner = owner
        self._by_id: Dict[str, T] = {}
        for thing in self._things:
            self._by_id.setdefault(thing.id, thing)

    def __getitem__(self, key: Union[int, str, slice]) -> Any:
        if not isinstance(key, str):
            return self._things[key]
        if key in self._by_id:
            return self._by_id[key]
        begin = f"{self._owner} has no" if self._owner else "no"
        near = difflib.get_close_matches(key, self._by_id, 1) if len(self._by_id) <= 1000 else []
        rest = f"did you mean {near[0]!r}? Known: " if near else "known: "
        raise KeyError(f"{begin} {self._kind} {key!r}; {rest}"
                       + (", ".join(map(repr, self._by_id)) or "none"))

    def __len__(self) -> int:
        return len(self._things)

    def __iter__(self) -> Iterator[T]:
        return iter(self._things)

    def __contains__(self, key: object) -> bool:
        return key in self._by_id if isinstance(key, str) else key in self._things

    def __repr__(self) -> str:
        return f"[{', '.join(map(repr, self._things))}]"


class Listed(Generic[T]):
    """A property of robots: the list of their devices of a kind. It is made when it is first asked for. So a robot has
    few objects: the end of a program looks at each object several times, which took seconds with 100 000 robots."""

    def __init__(self, kind: str):
        self._kind = kind
        self._name = ""

    def __set_name__(self, owner: Any, name: str) -> None:
        self._name = name

    def __get__(self, robot: Any, owner: Any = None) -> Named[T]:
        named: Named[T] = Named(robot._devices.pop(self._name, ()), self._kind, f"robot {robot.id!r}")
        setattr(robot, self._name, named)  # found before this property from now on
        return named
