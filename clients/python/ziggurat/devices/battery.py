from __future__ import annotations

from typing import NamedTuple

from ..exchange import Readings


class Battery(NamedTuple):
    available_charge: float  # share of the full charge, 0 … 1
    time_left: float  # [s], may be infinite


battery = Readings("batteries", 2, Battery._make, lambda given: given.battery)
