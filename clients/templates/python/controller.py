"""Drives, and turns left while a sensor in front sees something near."""

import math

import ziggurat


def ahead(robot):
    """The greatest reading of the rays within 60 degrees of straight ahead: 0 is nothing, 1 is contact."""
    return max(reading for sensor, reading in zip(robot.proximity_sensors, robot.proximity)
               if abs(sensor.angle) < math.radians(60))


with ziggurat.connect() as session:
    for tick in session:
        for robot in session.robots:
            speed = float(robot.params["speed"])  # [m/s]
            is_near = ahead(robot) > 0
            robot.wheels.set_velocity(-speed / 2 if is_near else speed, speed / 2 if is_near else speed)
            for led in robot.leds:
                led.color = (255, 0, 0) if is_near else (0, 255, 0)
