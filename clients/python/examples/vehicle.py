#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Drives the four-wheeled vehicle of scenes/dynamics3d_multi_body_test.argos.

    ziggurat serve scenes/dynamics3d_multi_body_test.argos
    vehicle.py [ENDPOINT]         in a second terminal

It can also be the command of an <external_controller> in a scene.
"""

import os
import sys

import ziggurat

WHEELS = ("base_wheel_bl", "base_wheel_fl", "base_wheel_br", "base_wheel_fr")


def main():
    endpoint = sys.argv[1] if len(sys.argv) > 1 else ""
    with ziggurat.connect(endpoint, controller=os.environ.get("ZIGGURAT_CONTROLLER", ""),
                          name="vehicle.py") as session:
        vehicle = session.robots[0]
        wheels = [vehicle.joints[name] for name in WHEELS]  # looked up once, before the loop
        for tick in session:
            if tick.event is ziggurat.Event.STEP:
                speeds = ", ".join(f"{wheel.encoder:.2f}" for wheel in wheels)
                vehicle.log(f"wheel velocities: {speeds}")
            else:  # INIT or RESET: tick 0
                for wheel in wheels:
                    wheel.target = 1.0  # [rad/s]


if __name__ == "__main__":
    main()
