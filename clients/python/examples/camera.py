#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Logs what the cameras of all robots detect, and writes the last picture of each to a PPM file.

    camera.py [ENDPOINT]
"""

import sys

import ziggurat


def log_readings(robot, camera):
    for tag in camera.tags if camera.detects("tag") else []:
        robot.log(f"{camera.id}: tag {tag.payload.decode(errors='replace')} at "
                  f"{tag.center[0]:.1f}, {tag.center[1]:.1f}")
    for led in camera.leds if camera.detects("led") else []:
        robot.log(f"{camera.id}: LED {tuple(led.color)} at "
                  f"{led.center[0]:.1f}, {led.center[1]:.1f}")


def write_picture(robot, camera):
    with open(f"{robot.id}_{camera.id}.ppm", "wb") as file:
        file.write(f"P6 {camera.width} {camera.height} 255\n".encode() + camera.image)


def main():
    endpoint = sys.argv[1] if len(sys.argv) > 1 else ""
    with ziggurat.connect(endpoint, name="camera.py") as session:
        cameras = [(robot, camera) for robot in session.robots for camera in robot.cameras]
        for _ in session:
            for robot, camera in cameras:
                log_readings(robot, camera)
        for robot, camera in cameras:
            if camera.takes_pictures and camera.image:
                write_picture(robot, camera)


if __name__ == "__main__":
    main()
