# SPDX-License-Identifier: MIT
"""Drives all robots with wheels that it is given: a client for scenes of one robot."""

import os

import ziggurat

with ziggurat.connect("", controller=os.environ["ZIGGURAT_CONTROLLER"], name="wheels_client.py") as session:
    for _ in session:
        for robot in session.robots:
            robot.wheels.set_velocity(0.1, 0.1)
