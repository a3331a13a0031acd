# SPDX-License-Identifier: MIT
"""Drives the robots of the only server, once another client is there."""
import time

import ziggurat

with ziggurat.supervise(observer=True) as world:
    while len(world.status().sessions) < 2:
        time.sleep(0.01)
for _ in ziggurat.connect():
    pass
