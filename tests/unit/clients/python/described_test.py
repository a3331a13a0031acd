# SPDX-License-Identifier: MIT
"""Devices that describe themselves."""

import unittest

from ziggurat import protocol_pb2 as v1
from ziggurat.exchange import Exchange
from ziggurat.learning import all_readings
from ziggurat.robot import Robot


def described(id):
    """A robot with two lamps, an ear that reads rows and a nose that reads others."""
    field = v1.DeviceField
    lamps = v1.DeviceKind(
        name="lamp", readings=[field(name="value"), field(name="heat", unit="K")], properties=[field(name="angle")],
        commands=[v1.DeviceCommand(name="power", unit="W", least=-1, most=1, initial=0.5)],
        devices=[v1.DescribedDevice(id=side, anchor="origin", position=[1, 2, 3], properties=[0.75])
                 for side in ("left", "right")])
    ear = v1.DeviceKind(name="ear", readings=[field(name="pitch"), field(name="color")], most_rows=9,
                        devices=[v1.DescribedDevice()])
    nose = v1.DeviceKind(name="nose", readings=[field(name="smell")], most_rows=9, devices=[v1.DescribedDevice()])
    return v1.RobotDescription(id=id, device_kinds=[lamps, ear, nose])


class Described(unittest.TestCase):
    def setUp(self):
        self.exchange = Exchange()
        self.one, self.two = (Robot(self.exchange, i, described(id), lambda *_: None)
                              for i, id in enumerate(("one", "two")))
        self.exchange.begin()

    def see(self):
        self.exchange.observe(v1.Observation(
            tick=1, device_readings=range(1, 9), device_rows=[2, 1, 0, 2],
            device_row_values=[440, 1, 880, 2, 7, 8, 9]))

    def test_values_have_names(self):
        left, right = self.two.devices["lamp"]
        self.assertEqual((left.value, left.angle), (0, 0.75))
        self.see()
        self.assertEqual((left.value, left.heat, right.value, right.heat), (5, 6, 7, 8))
        self.assertEqual(self.two.devices["lamp"]["right"].value, 7)
        self.assertEqual([field.unit for field in left.fields], ["", "K"])
        self.assertEqual(all_readings(self.one), [1, 2, 3, 4])
        with self.assertRaisesRegex(AttributeError, "lamp has no 'colour'; it has: value, heat, angle"):
            left.colour
        with self.assertRaisesRegex(KeyError, "robot 'two' has no devices of kind 'lamb'; it has: lamp, ear, nose"):
            self.two.devices["lamb"]

    def test_rows(self):
        self.assertEqual(self.one.devices["ear"][0].rows, [])
        self.see()
        self.assertEqual(self.one.devices["ear"][0].rows, [{"pitch": 440, "color": 1}, {"pitch": 880, "color": 2}])
        self.assertEqual(self.one.devices["nose"][0].rows, [{"smell": 7}])
        self.assertEqual(self.two.devices["ear"][0].rows, [])
        self.assertEqual(self.two.devices["nose"][0].rows, [{"smell": 8}, {"smell": 9}])
        with self.assertRaisesRegex(AttributeError, "in its `rows`"):
            self.one.devices["ear"][0].pitch

    def test_commands(self):
        lamp = self.two.devices["lamp"]["left"]
        self.assertEqual(lamp.commanded("power"), 0.5)
        lamp.set("power", -1)
        self.assertEqual(list(v1.ClientMessage.FromString(self.exchange.command(1)).command.device_commands), [0.5, 0.5, -1, 0.5])
        for bad in (1.5, -2, float("nan")):
            with self.assertRaises(ValueError):
                lamp.set("power", bad)
        with self.assertRaisesRegex(KeyError, "no command 'colour'; it has: power"):
            lamp.set("colour", 1)
        self.assertEqual(lamp.command_fields[0].most, 1)
        self.exchange.reset()
        self.assertEqual(lamp.commanded("power"), 0.5)


if __name__ == "__main__":
    unittest.main()
