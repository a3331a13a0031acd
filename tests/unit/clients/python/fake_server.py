# SPDX-License-Identifier: MIT
"""A server whose messages a test chooses, over a real socket."""

import pathlib
import sys

import zmq

from ziggurat import protocol_pb2 as v1

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3]))

from waiting import HANG  # noqa: E402


class FakeServer:
    def __init__(self, secret_key=None):
        self.socket = zmq.Context.instance().socket(zmq.ROUTER)
        if secret_key is not None:
            self.socket.curve_server = True
            self.socket.curve_secretkey = secret_key
        self.socket.setsockopt(zmq.LINGER, 0)
        self.socket.setsockopt(zmq.ROUTER_MANDATORY, 1)
        self.endpoint = f"tcp://127.0.0.1:{self.socket.bind_to_random_port('tcp://127.0.0.1')}"
        self.peer = None

    def receive(self):
        """The content of the client's next message."""
        if not self.socket.poll(1000 * HANG):
            raise TimeoutError("no message from the client")
        self.peer, data = self.socket.recv_multipart()
        message = v1.ClientMessage.FromString(data)
        return getattr(message, message.WhichOneof("message"))

    def send(self, **fields):
        self.socket.send_multipart([self.peer, v1.ServerMessage(**fields).SerializeToString()])

    def observe(self, tick, **fields):
        self.send(observation=v1.Observation(tick=tick, time_ns=tick * 100_000_000, **fields))

    def close(self):
        self.socket.close()


def welcome(*robots, **fields):
    fields.setdefault("role", v1.ROLE_CONTROLLER)
    return v1.Welcome(version=v1.Version(major=1), session_token=b"token", tick_ns=100_000_000,
                      ticks_per_second=10, mode=v1.MODE_LOCK_STEP, seed=7,
                      max_message_bytes=1 << 20, robots=robots, **fields)


def equipped(id, **fields):
    """A robot with two of most devices."""
    joint = v1.JointDescription
    return v1.RobotDescription(
        id=id, controller="some", params=[v1.Parameter(name="speed", value="2")],
        joint_sensors=[joint(id="left", mode=joint.POSITION), joint(id="arm", mode=joint.VELOCITY)],
        joint_actuators=[joint(id="left", mode=joint.VELOCITY, max_impulse=0.5),
                         joint(id="right", mode=joint.POSITION)],
        radios=[v1.RadioDescription(id="mouth", range=2, sends=True),
                v1.RadioDescription(id="ear", receives=True)],
        leds=[v1.LedDescription(id="a", color=0xFF0000), v1.LedDescription(id="b")],
        directional_leds=[v1.LedDescription(id="beam")],
        tags=[v1.TagDescription(id="tag", payload=b"7")],
        magnets=[v1.MagnetDescription(id="coil")],
        proximity_sensors=[v1.ProximityDescription(anchor="base", position=[1, 2, 3],
                                                   direction=[0, 0, 1], range=0.1, angle=angle)
                           for angle in (0, None)],
        range_and_bearing=v1.RangeAndBearingDescription(range=3, data_size=2, sends=True,
                                                        receives=True),
        positioning=True, battery=True,
        contact_sensors=[v1.ContactSensorDescription(id="skin", anchor="base")],
        imus=[v1.ImuDescription(id="imu", anchor="base", position=[1, 2, 3],
                                orientation=[0, 1, 0, 0])],
        cameras=[v1.CameraDescription(id="front", near=0.1, far=2, width=4, height=2,
                                      focal_length=[100, 100], principal_point=[2, 1],
                                      detects_leds=True, detects_tags=True, image=True),
                 v1.CameraDescription(id="blind", detects_tags=True)],
        wheels=v1.WheelsDescription(axle_length=0.14, drives=True, measures=True),
        turret=v1.TurretDescription(drives=True, measures=True), **fields)
