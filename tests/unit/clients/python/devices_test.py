# SPDX-License-Identifier: MIT
"""Devices: readings out of packed arrays, values into them. Two robots, so that places count."""

import unittest

from ziggurat import Color, protocol_pb2 as v1
from ziggurat.exchange import Exchange
from ziggurat.robot import Robot

from fake_server import equipped


class Devices(unittest.TestCase):
    def setUp(self):
        self.exchange = Exchange()
        self.robots = [Robot(self.exchange, i, equipped(id), lambda *_: None)
                       for i, id in enumerate(("one", "two"))]
        self.exchange.begin()
        self.one, self.two = self.robots

    def see(self, **fields):
        self.exchange.observe(v1.Observation(tick=1, **fields))

    def command(self):
        command = v1.ClientMessage.FromString(self.exchange.command(1)).command
        self.exchange.sent()
        return command

    def test_joints(self):
        self.assertEqual([joint.id for joint in self.two.joints], ["left", "arm", "right"])
        self.see(joint_readings=[1, 2, 3, 4])
        self.assertEqual(self.two.joints["left"].encoder, 3)
        self.assertEqual(self.two.joints["arm"].encoder, 4)
        self.assertEqual(self.two.joints["left"].sensor_mode, "position")
        self.assertEqual(self.two.joints["left"].actuator_mode, "velocity")
        self.assertEqual(self.two.joints["left"].max_impulse, 0.5)
        self.two.joints["right"].target = 9
        self.assertEqual(list(self.command().joint_targets), [0, 0, 0, 9])
        with self.assertRaises(AttributeError):
            self.two.joints["right"].encoder
        with self.assertRaises(AttributeError):
            self.two.joints["arm"].target = 1
        for bad in (float("nan"), float("inf")):
            with self.assertRaises(ValueError):
                self.two.joints["right"].target = bad
        with self.assertRaisesRegex(KeyError, "'left', 'arm', 'right'"):
            self.two.joints["wing"]
        with self.assertRaisesRegex(KeyError, "robot 'two' has no joint 'lefd'; did you mean 'left'"):
            self.two.joints["lefd"]

    def test_a_joint_with_a_sensor_of_its_position_and_one_of_its_velocity(self):
        joint = v1.JointDescription
        given = v1.RobotDescription(id="three", joint_sensors=[
            joint(id="arm", mode=joint.VELOCITY), joint(id="arm", mode=joint.POSITION), joint(id="leg", mode=joint.POSITION)])
        exchange = Exchange()
        joints = Robot(exchange, 0, given, lambda *_: None).joints
        self.assertEqual([each.id for each in joints], ["arm", "leg"])
        self.assertEqual((joints["arm"].position, joints["arm"].velocity), (0, 0))
        exchange.observe(v1.Observation(tick=1, joint_readings=[1, 2, 3]))
        self.assertEqual((joints["arm"].position, joints["arm"].velocity), (2, 1))
        self.assertEqual((joints["arm"].encoder, joints["arm"].sensor_mode), (1, "velocity"))
        self.assertEqual(joints["arm"].readings, [1, 2])
        self.assertEqual(joints["leg"].position, 3)
        with self.assertRaisesRegex(AttributeError, 'no sensor in mode .velocity.; add <joint id="leg" mode="velocity"/>'):
            joints["leg"].velocity

    def test_before_the_first_tick(self):
        self.assertEqual(self.two.joints["left"].encoder, 0)
        self.assertEqual(list(self.two.proximity), [0, 0])
        self.assertIsNone(self.two.pose)
        self.assertIsNone(self.two.battery)
        self.assertEqual(self.two.imus["imu"].acceleration, (0, 0, 0))
        self.assertFalse(self.two.contact_sensors["skin"].touches)
        self.assertEqual(self.two.contact_sensors["skin"].force, (0, 0, 0))
        self.assertEqual(self.two.cameras["front"].tags, [])
        self.assertEqual(self.two.cameras["front"].image, b"")
        self.assertEqual(self.two.wheels.velocity, (0, 0))
        self.assertEqual(self.two.turret.rotation, 0)

    def test_imus(self):
        self.see(imus=range(12))
        imu = self.two.imus["imu"]
        self.assertEqual((imu.anchor, imu.position, imu.orientation),
                         ("base", (1, 2, 3), (0, 1, 0, 0)))
        self.assertEqual(imu.acceleration, (6, 7, 8))
        self.assertEqual(imu.angular_velocity, (9, 10, 11))

    def test_contact_sensors(self):
        self.see(contact_sensors=[0, 0, 0, 0, 0, 1, 2, 3, 4, 9])
        self.assertFalse(self.one.contact_sensors["skin"].touches)
        skin = self.two.contact_sensors["skin"]
        self.assertEqual((skin.anchor, skin.touches, skin.force, skin.strength),
                         ("base", True, (2, 3, 4), 9))

    def test_radios(self):
        self.see(radio_messages=[v1.RadioMessage(radio=1, payload=b"x"),
                                 v1.RadioMessage(radio=3, payload=b"y"),
                                 v1.RadioMessage(radio=3, payload=b"")])
        self.assertEqual(self.one.radios["ear"].received, [b"x"])
        self.assertEqual(self.two.radios["ear"].received, [b"y", b""])
        self.assertEqual(self.two.radios["mouth"].received, [])
        self.two.radios["mouth"].send(b"a")
        self.two.radios["mouth"].send(b"b")
        self.assertEqual([(m.radio, m.payload) for m in self.command().radio_messages],
                         [(2, b"a"), (2, b"b")])
        self.assertEqual(len(self.command().radio_messages), 0, "sent once")
        with self.assertRaises(AttributeError):
            self.two.radios["ear"].send(b"")
        with self.assertRaises(ValueError):
            self.two.radios["mouth"].send(bytes((1 << 20) + 1))

    def test_lights_tags_and_magnets(self):
        self.assertEqual(self.two.leds["a"].color, Color(255, 0, 0))
        self.two.leds["b"].color = (1, 2, 3)
        self.two.directional_leds["beam"].color = Color(0, 255, 0)
        self.two.tags["tag"].payload = "text"
        self.two.magnets["coil"].current = -0.5
        command = self.command()
        self.assertEqual(list(command.led_colors), [0xFF0000, 0, 0xFF0000, 0x010203])
        self.assertEqual(list(command.directional_led_colors), [0, 0x00FF00])
        self.assertEqual(list(command.tag_payloads), [b"7", b"text"])
        self.assertEqual(list(command.magnet_currents), [0, -0.5])
        with self.assertRaises(ValueError):
            self.two.leds["a"].color = (0, 0, 256)
        with self.assertRaises(ValueError):
            self.two.tags["tag"].payload = bytes((1 << 16) + 1)

    def test_sensors(self):
        self.see(proximity=[0.1, 0.2, 0.3, 0.4], positioning=range(14),
                 batteries=[1, 10, 0.5, float("inf")], wheels=range(8),
                 turret_rotations=[0.5, -0.5])
        self.assertEqual(list(self.two.proximity), [0.3, 0.4])
        self.assertEqual(self.two.proximity_sensors[0].position, (1, 2, 3))
        self.assertEqual([sensor.angle for sensor in self.two.proximity_sensors], [0, None])
        self.assertEqual(self.two.pose.position, (7, 8, 9))
        self.assertEqual(self.two.pose.orientation, (10, 11, 12, 13))
        self.assertEqual(self.one.battery, (1, 10))
        self.assertEqual(self.two.battery, (0.5, float("inf")))
        self.assertEqual(self.two.wheels.velocity, (4, 5))
        self.assertEqual(self.two.wheels.distance, (6, 7))
        self.assertEqual(self.two.turret.rotation, -0.5)

    def test_range_and_bearing(self):
        packet = v1.RangeAndBearingPacket
        self.see(range_and_bearing=[packet(robot=0, range=1, data=b"ab"),
                                    packet(robot=1, range=2, horizontal_bearing=0.5,
                                           vertical_bearing=-0.1, data=b"cd")])
        self.assertEqual(self.two.range_and_bearing.packets, [(2, 0.5, -0.1, b"cd")])
        self.two.range_and_bearing.data = b"xy"
        self.assertEqual(self.two.range_and_bearing.data, b"xy")
        self.assertEqual(self.one.range_and_bearing.data, b"\0\0")
        self.assertEqual(self.command().range_and_bearing_data, b"\0\0xy")
        with self.assertRaises(ValueError):
            self.two.range_and_bearing.data = b"xyz"

    def test_wheels_and_turret(self):
        self.two.wheels.set_velocity(0.1, -0.1)
        self.assertEqual(list(self.command().wheel_velocities), [0, 0, 0.1, -0.1])
        self.two.turret.rotate_at(2)
        command = self.command()
        self.assertEqual(list(command.turret_modes), [v1.TURRET_PASSIVE, v1.TURRET_SPEED])
        self.assertEqual(list(command.turret_speeds), [0, 2])
        self.two.turret.rotate_to(1)
        command = self.command()
        self.assertEqual(list(command.turret_modes), [v1.TURRET_PASSIVE, v1.TURRET_POSITION])
        self.assertEqual(list(command.turret_rotations), [0, 1])
        self.two.turret.release()
        self.assertEqual(list(self.command().turret_modes), [v1.TURRET_PASSIVE] * 2)

    def test_cameras(self):
        # LEDs: one camera per robot has the detector; tags: two.
        self.see(led_counts=[2, 1], led_colors=[1, 2, 0x0000FF], led_centers=range(6),
                 tag_counts=[0, 1, 2, 0], tag_payloads=[b"p", b"q", b"r"], tag_centers=range(6),
                 tag_corners=range(24), camera_images=[bytes(24), bytes(range(24))])
        front, blind = self.two.cameras
        self.assertEqual(len(self.one.cameras["front"].leds), 2)
        self.assertEqual(front.leds, [((0, 0, 255), (4, 5))])
        self.assertEqual(self.one.cameras["blind"].tags[0].payload, b"p")
        self.assertEqual([tag.payload for tag in front.tags], [b"q", b"r"])
        self.assertEqual(front.tags[1].center, (4, 5))
        self.assertEqual(front.tags[1].corners, ((16, 17), (18, 19), (20, 21), (22, 23)))
        self.assertEqual(blind.tags, [])
        self.assertEqual(front.image, bytes(range(24)))
        self.assertFalse(front.detects("directional_led"))
        with self.assertRaises(AttributeError):
            front.directional_leds
        with self.assertRaises(AttributeError):
            blind.image
        try:
            import numpy  # noqa: F401
        except ImportError:
            return
        self.assertEqual(front.image_array()[1, 0].tolist(), [12, 13, 14])


if __name__ == "__main__":
    unittest.main()
