# SPDX-License-Identifier: MIT
"""Common parts of the handles."""

from __future__ import annotations

import math
from typing import Iterable, Tuple, cast

from ..exchange import Exchange

Vector = Tuple[float, float, float]
Quaternion = Tuple[float, float, float, float]  # w, x, y, z


def vector(values: Iterable[float]) -> Vector:
    """Three numbers of a message."""
    return cast(Vector, tuple(values))


def quaternion(values: Iterable[float]) -> Quaternion:
    """Four numbers of a message."""
    return cast(Quaternion, tuple(values))


def finite(value: float, what: str) -> float:
    value = float(value)
    if not math.isfinite(value):
        raise ValueError(f"{what} must be finite, not {value}")
    return value


class Device:
    """The base of handles with an id."""

    __slots__ = ("id", "_exchange")

    def __init__(self, exchange: Exchange, id: str):
        self.id = id
        self._exchange = exchange

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.id!r})"
