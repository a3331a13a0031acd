# SPDX-License-Identifier: MIT
"""A controller for the conformance kit, which tests the package with it: it uses every device."""

import os
import sys

import ziggurat


def use(robot, number):
    for joint in robot.joints:
        if joint.actuator_mode is not None:
            joint.target = 0.001 * (number % 7)
    for light in (*robot.leds, *robot.directional_leds):
        light.color = (number % 256, 0, 255)
    for tag in robot.tags:
        tag.payload = str(number)
    for magnet in robot.magnets:
        magnet.current = 0.5
    for radio in robot.radios:
        if radio.sends:
            radio.send(b"tick %d" % number)
    if robot.range_and_bearing is not None and robot.range_and_bearing.sends:
        robot.range_and_bearing.data = bytes(robot.range_and_bearing.data_size)


def main():
    with ziggurat.connect(controller=os.environ.get("ZIGGURAT_CONTROLLER", "")) as session:
        for tick in session:
            for robot in session.robots:
                use(robot, tick.number)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except ziggurat.ZigguratError as error:
        print(error, file=sys.stderr)
        sys.exit(1)
