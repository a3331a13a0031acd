# SPDX-License-Identifier: MIT
"""What observations and actions can be, with the names that Gymnasium and PettingZoo use, without those
packages."""

from __future__ import annotations

from typing import Any, Optional, Sequence, Tuple

import numpy


class Box:
    """Arrays of numbers, each from `low` to `high`."""

    def __init__(self, low: Any, high: Any, shape: Optional[Sequence[int]] = None,
                 dtype: Any = numpy.float64):
        self.shape: Tuple[int, ...] = tuple(numpy.shape(low) if shape is None else shape)
        self.dtype = numpy.dtype(dtype)
        self.low = numpy.broadcast_to(numpy.asarray(low, self.dtype), self.shape)
        self.high = numpy.broadcast_to(numpy.asarray(high, self.dtype), self.shape)
        if (self.low > self.high).any():
            raise ValueError("a low limit is above its high one")
        self._random = numpy.random.default_rng()

    def seed(self, seed: Optional[int] = None) -> None:
        self._random = numpy.random.default_rng(seed)

    def sample(self) -> numpy.ndarray[Any, Any]:
        """Uniform between the limits; where one of them is infinite, normal with the deviation 1."""
        bounded = numpy.isfinite(self.low) & numpy.isfinite(self.high)
        low, high = numpy.where(bounded, self.low, 0), numpy.where(bounded, self.high, 1)
        uniform = self._random.uniform(low, high)
        normal = numpy.clip(self._random.normal(size=self.shape), self.low, self.high)
        return numpy.where(bounded, uniform, normal).astype(self.dtype)

    def contains(self, value: Any) -> bool:
        array = numpy.asarray(value)
        return array.shape == self.shape and bool(((array >= self.low) & (array <= self.high)).all())

    __contains__ = contains

    def __eq__(self, other: Any) -> bool:
        return (isinstance(other, Box) and self.shape == other.shape and self.dtype == other.dtype
                and bool((self.low == other.low).all() and (self.high == other.high).all()))

    def __repr__(self) -> str:
        return f"Box({self.low.min() if self.low.size else 0}, " \
               f"{self.high.max() if self.high.size else 0}, {self.shape}, {self.dtype})"
