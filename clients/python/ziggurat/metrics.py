# SPDX-License-Identifier: MIT
"""Metrics that were set since the last command."""

from __future__ import annotations

import math
import re
from typing import Dict, List, Set, Tuple

from . import protocol_pb2 as v1

_NAME = re.compile(r"[A-Za-z0-9_.-]{1,64}")
_MOST_NAMES = 100  # of a robot


class Metrics:
    def __init__(self) -> None:
        self._values: Dict[Tuple[int, str], float] = {}
        self._names: Dict[int, Set[str]] = {}

    def set(self, robot: int, name: str, value: float) -> None:
        """Raises ValueError for a name or value that the server would refuse."""
        if not _NAME.fullmatch(name):
            raise ValueError(f"the name of a metric must have 1 to 64 letters, digits, '_', '-' or '.', not {name!r}")
        number = float(value)
        if not math.isfinite(number):
            raise ValueError(f"the metric {name!r} is {number}; it must be finite")
        names = self._names.setdefault(robot, set())
        if name not in names and len(names) == _MOST_NAMES:
            raise ValueError(f"there are {_MOST_NAMES} metrics already; {name!r} would be one more")
        names.add(name)
        self._values[robot, name] = number

    def __bool__(self) -> bool:
        """Whether there are any since the last call of take()."""
        return bool(self._values)

    def take(self) -> List[v1.Metric]:
        """Those since the last call."""
        metrics = [v1.Metric(robot=robot, name=name, value=value)
                   for (robot, name), value in sorted(self._values.items())]
        self._values.clear()
        return metrics
