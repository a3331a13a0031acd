# SPDX-License-Identifier: MIT
"""Commands that are written as bytes, read by protobuf."""

import unittest

from ziggurat import protocol_pb2 as v1
from ziggurat.exchange import Exchange


class Packed(unittest.TestCase):
    def setUp(self):
        self.exchange = Exchange()
        for field, value in (("joint_targets", 0.0), ("joint_targets", 0.0), ("wheel_velocities", 0.0), ("led_colors", 0)):
            self.exchange.add(field, value)
        self.exchange.begin()

    def command(self, *tick):
        return v1.ClientMessage.FromString(self.exchange.command(*tick)).command

    def test_numbers_and_what_is_none(self):
        self.exchange.set("joint_targets", 1, -2.5)
        self.exchange.set("wheel_velocities", 0, 1e-300)
        self.exchange.set("led_colors", 0, 0xFF0000)
        self.exchange.log.append(v1.LogLine(text="x"))
        self.exchange.metrics.set(0, "m", 4)
        self.assertEqual(self.command(300, 2), v1.Command(
            tick=300, epoch=2, joint_targets=[0, -2.5], wheel_velocities=[1e-300], led_colors=[0xFF0000],
            log=[v1.LogLine(text="x")], metrics=[v1.Metric(name="m", value=4)]))

    def test_only_what_is_new(self):
        self.exchange.set("joint_targets", 0, 1.0)
        self.exchange.command(1)
        self.exchange.sent()
        self.assertEqual(self.command(2), v1.Command(tick=2))

    def test_numbers_of_each_size(self):
        for tick in (0, 1, 127, 128, 16383, 16384, 2 ** 63, 2 ** 64 - 1):
            self.assertEqual(self.command(tick, tick), v1.Command(tick=tick, epoch=tick))
        for _ in range(40):  # more than 127 bytes of them
            self.exchange.add("magnet_currents", 0.0)
        self.exchange.set("magnet_currents", 39, 0.125)
        self.assertEqual(list(self.command(1).magnet_currents), [0.0] * 39 + [0.125])


if __name__ == "__main__":
    unittest.main()
