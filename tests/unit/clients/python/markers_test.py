# SPDX-License-Identifier: MIT
"""Markers that a robot draws."""

import unittest

from ziggurat import protocol_pb2 as v1
from ziggurat.exchange import Exchange
from ziggurat.robot import Robot


class Markers(unittest.TestCase):
    def setUp(self):
        self.exchange = Exchange()
        self.other, self.robot = (Robot(self.exchange, i, v1.RobotDescription(id=id, draws_markers=draws), lambda *_: None)
                                  for i, (id, draws) in enumerate((("other", False), ("painter", True))))
        self.exchange.begin()

    def sent(self):
        markers = list(v1.ClientMessage.FromString(self.exchange.command(1)).command.markers)
        self.exchange.sent()
        return markers

    def test_are_sent_once(self):
        self.robot.draw_arrow((0, 0, 0.1), (1, 2, 3), (255, 0, 1))
        self.robot.draw_ring((0, 0, 0), 0.5)
        self.robot.draw_text((0, 0, 0.2), "ü" * 50)
        arrow, ring, text = self.sent()
        self.assertEqual(arrow, v1.Marker(robot=1, at=[0, 0, 0.1], to=[1, 2, 3], color=0xFF0001))
        self.assertEqual(ring, v1.Marker(robot=1, at=[0, 0, 0], radius=0.5))
        self.assertEqual(text.text, "ü" * 50)
        self.assertEqual(self.sent(), [])

    def test_bounds(self):
        draw = self.robot
        for wrong in (lambda: draw.draw_arrow((0, 0), (1, 2, 3)), lambda: draw.draw_arrow((0, 0, 0), ()),
                      lambda: draw.draw_arrow((0, 0, 0), (1, 2, float("nan"))), lambda: draw.draw_arrow((0, 0, 2e6), (1, 2, 3)),
                      lambda: draw.draw_ring((0, 0, 0), 0), lambda: draw.draw_ring((0, 0, 0), -1),
                      lambda: draw.draw_ring((0, 0, 0), 2e6), lambda: draw.draw_ring((0, 0, 0), float("nan")),
                      lambda: draw.draw_text((0, 0, 0), ""), lambda: draw.draw_text((0, 0, 0), "ü" * 51)):
            self.assertRaises(ValueError, wrong)
        self.assertEqual(self.sent(), [])
        for _ in range(1000):
            draw.draw_ring((0, 0, 0), 1)
        with self.assertRaisesRegex(ValueError, "'painter' draws more than 1000 markers"):
            draw.draw_ring((0, 0, 0), 1)
        self.assertEqual(len(self.sent()), 1000)
        draw.draw_ring((0, 0, 0), 1)

    def test_need_the_actuator(self):
        with self.assertRaisesRegex(AttributeError, "'other' does not draw"):
            self.other.draw_ring((0, 0, 0), 1)


if __name__ == "__main__":
    unittest.main()
