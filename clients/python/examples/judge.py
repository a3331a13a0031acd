#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Ends the run when one of the blocks stands on the other and the robot has left it: a director.

    ziggurat run judge.argos

The result and two metrics are in the run's summary: how far the upper block is aside of the lower one, and how much
it is turned.
"""

import math

import ziggurat

SIDE = 0.055  # of a block [m]
STILL = 0.0005  # what a block that stands moves at most [m]
AWAY = 0.15  # the robot from the stack, in the plane [m]


def misalignment(lower, upper):
    """How far the upper block is aside [m] and turned about the vertical, up to quarter turns [degrees]."""
    aside = math.dist(lower.position[:2], upper.position[:2])
    w, x, y, z = product(conjugate(lower.orientation), upper.orientation)
    turned = math.degrees(2 * math.atan2(z, w))
    return aside, abs((turned + 45) % 90 - 45)


def conjugate(q):
    return (q[0], -q[1], -q[2], -q[3])


def product(a, b):
    return (a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
            a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
            a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0])


def stands(lower, upper, robot):
    height = upper.position[2] - lower.position[2]
    return (abs(height - SIDE) < 0.1 * SIDE and math.dist(lower.position[:2], upper.position[:2]) < SIDE / 2
            and math.dist(robot.position[:2], upper.position[:2]) > AWAY)


def main():
    with ziggurat.direct() as world:
        rest = float(world.params["rest"])
        since, place = 0.0, None  # since when the upper block stands there
        for tick in world:
            blocks = [world.entities["block1"], world.entities["block2"]]
            lower, upper = sorted(blocks, key=lambda block: block.position[2])
            if not stands(lower, upper, world.entities["robot0"]):
                place = None
                continue
            if place is None or math.dist(place, upper.position) > STILL:
                since, place = tick.time, upper.position
            if tick.time - since >= rest:
                aside, turned = misalignment(lower, upper)
                world.metric("aside_mm", 1000 * aside)
                world.metric("turned_deg", turned)
                world.finish(f"{upper.id} stands on {lower.id}, {1000 * aside:.1f} mm aside")


if __name__ == "__main__":
    main()
