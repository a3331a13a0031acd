# SPDX-License-Identifier: MIT
"""Handles of a robot's devices, a file for each kind. Reading and setting take the same time in a
session of any size.

Numbers are SI: m, rad, s, m/s, rad/s; pixels are counted from the top left corner of the image, u
to the right and v down.
"""

from .camera import Camera, LedReading, TagReading
from .described import DescribedDevice, DeviceCommand, DeviceField, DevicesByKind
from .device import Device, Quaternion, Vector
from .joint import Joint
from .led import OFF, Color, Led
from .magnet import Magnet
from .radio import MAX_MESSAGE, Radio
from .range_and_bearing import Packet, RangeAndBearing
from .sensors import *
from .tag import MAX_PAYLOAD, Tag
from .turret import Turret
from .wheels import Wheels

__all__ = [
    "Battery", "Camera", "Color", "ContactSensor", "DescribedDevice", "Device", "DeviceCommand", "DeviceField",
    "DevicesByKind", "Imu", "Joint", "Led", "LedReading", "MAX_MESSAGE", "MAX_PAYLOAD", "Magnet", "OFF",
    "Packet", "Pose", "ProximitySensor", "Quaternion", "Radio", "RangeAndBearing", "Sensors", "Tag",
    "TagReading", "Turret", "Vector", "Wheels",
]
