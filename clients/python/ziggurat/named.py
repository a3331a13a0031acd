"""Lists with access by id."""

from __future__ import annotations

import difflib
from typing import Any, Dict, Generic, Iterable, Iterator, List, Sequence, TypeVar, Union

T = TypeVar("T")


class Named(Sequence, Generic[T]):
    """A list with access by position or by id."""

    def __init__(self, things: Iterable[T], kind: str, owner: str = ""):
        """owner: whose they are, for messages."""
        self._things: List[T] = list(things)
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
