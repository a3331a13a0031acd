#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Foraging with items that respawn: a director with the rule of scenes/experiments/foraging.lua.

    ziggurat serve scenes/experiments/foraging.argos --endpoint tcp://127.0.0.1:7400
    ziggurat-lua --connect tcp://127.0.0.1:7400                                             the robots
    ZIGGURAT_ENDPOINT=tcp://127.0.0.1:7400 ZIGGURAT_DIRECTOR=food python3 foraging.py       the food

With command="python3 …/foraging.py" in place of script="foraging.lua" in the scene, `ziggurat run` starts it.
"""

import math
import random

import ziggurat

REACH = 0.25  # a robot collects what is nearer to its centre [m]
CLEAR = 0.5  # food appears no nearer to a robot [m]
HALF = 1.6  # of the area where food appears [m]
PAUSE = 20  # ticks until something new appears


def distance(a, b):
    return math.dist(a[:2], b[:2])


class Food:
    def __init__(self, world):
        self.world = world
        self.random = random.Random(world.seed)  # the same run again has the same places
        self.due = [1] * int(world.params["items"])  # ticks at which something new appears
        self.expected = []  # ids of what was placed last
        self.placed = self.collected = 0

    def robots(self):
        return [entity for entity in self.world.entities.values() if entity.kind == "foot-bot"]

    def free_place(self):
        """Somewhere, but not beside a robot; None if there is nothing free."""
        for _ in range(100):
            place = (self.random.uniform(-HALF, HALF), self.random.uniform(-HALF, HALF))
            if all(distance(robot.position, place) > CLEAR for robot in self.robots()):
                return place
        return None

    def place_item(self):
        place = self.free_place()
        if place is None:
            return False
        self.placed += 1
        id = f"food{self.placed}"
        self.world.spawn(f'<cylinder id="{id}" radius="0.05" height="0.1" movable="false">'
                         f'<body position="{place[0]:.4f},{place[1]:.4f},0"/></cylinder>')
        self.expected.append(id)
        return True

    def place(self, tick):
        """Before this tick."""
        self.due = [at for at in self.due if at > tick or not self.place_item()]

    def collect(self, tick):
        """After this tick."""
        # What could not be placed, because something stands there, appears elsewhere.
        self.due += [tick for id in self.expected if id not in self.world.entities]
        self.expected = []
        robots = self.robots()
        for item in [each for each in self.world.entities.values() if each.kind == "cylinder"]:
            near = [robot for robot in robots if distance(robot.position, item.position) < REACH]
            if near:
                item.remove()
                self.due.append(tick + PAUSE)
                self.collected += 1
                self.world.log(f"{near[0].id} collects {item.id}: {self.collected}")
        self.world.metric("collected", self.collected)


def main():
    with ziggurat.direct() as world:
        for tick in world:
            if tick.event in (ziggurat.Event.INIT, ziggurat.Event.RESET):
                food = Food(world)
            else:
                food.collect(tick.number)
            if food.collected >= int(world.params["goal"]):
                world.finish()
            food.place(tick.number + 1)


if __name__ == "__main__":
    main()
