# SPDX-License-Identifier: MIT
"""Controllers for robots of a Ziggurat simulation server. See docs/python-client.md.

    with ziggurat.connect() as session:
        for tick in session:
            for robot in session.robots:
                robot.joints["left"].target = 1.0
"""

from __future__ import annotations

try:
    import google.protobuf
    import zmq
except ImportError as error:
    import sys
    raise ImportError(f"{error}. The client needs pyzmq and protobuf, for this Python: {sys.executable or 'python3'} -m pip "
                      "install pyzmq protobuf; for Debian's /usr/bin/python3: apt-get install python3-zmq "
                      "python3-protobuf") from None

from typing import TYPE_CHECKING, Any

from .curve import Curve
from .devices import *
from .direct import World, direct
from .errors import ConnectionLost, Displaced, ProtocolError, Refused, Timeout, ZigguratError
from .find_server import find_server
from .joining import Deadline, connect, resume
from .learning import all_readings, motors
from .named import Named
from .parallel import ParallelEnv, parallel_env
from .robot import Robot
from .server import Server
from .session import Session
from .supervisor import (EntityState, LinkState, SessionStatus, SolverStatus, States, Status,
                         Supervisor, supervise)
from .ticks import Ending, Event, SpawnedRobot, Tick

if TYPE_CHECKING:  # it needs numpy
    from .vector import VectorEnv

__version__ = "0.1.0"


def vector_env(scene: str, n: int, **options: Any) -> VectorEnv:
    """A VectorEnv (ziggurat.vector): n worlds at once. Needs numpy, which nothing else of this package does."""
    from .vector import VectorEnv
    return VectorEnv(scene, n, **options)


__all__ = [
    "Battery", "Camera", "Color", "ConnectionLost", "ContactSensor", "Curve", "Deadline", "DescribedDevice",
    "Device", "DeviceCommand", "DeviceField", "DevicesByKind", "Displaced", "Ending", "EntityState", "Event",
    "Imu", "Joint", "Led", "LedReading", "LinkState", "MAX_MESSAGE", "MAX_PAYLOAD", "Magnet", "Named", "OFF",
    "Packet", "ParallelEnv", "Pose", "ProtocolError", "ProximitySensor", "Quaternion", "Radio",
    "RangeAndBearing", "Refused", "Robot", "Sensors", "Server", "Session", "SessionStatus", "SolverStatus",
    "SpawnedRobot", "States", "Status", "Supervisor", "Tag", "TagReading", "Tick", "Timeout", "Turret",
    "Vector", "Wheels", "World", "ZigguratError", "all_readings", "connect", "direct", "find_server", "motors",
    "parallel_env", "resume", "supervise", "vector_env",
]
