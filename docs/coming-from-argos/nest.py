"""The rule of nest.lua: a grey nest on the floor, and a count of the robots that enter it."""

import math

import ziggurat


def main():
    with ziggurat.direct() as world:
        radius = float(world.params["radius"])  # [m]
        for tick in world:
            if tick.event in (ziggurat.Event.INIT, ziggurat.Event.RESET):  # Init(), GetFloorColor(), Reset()
                inside, visits = {}, 0
                world.paint_floor((0, 0), radius, (127, 127, 127))
                continue
            for entity in world.entities.values():  # PostStep()
                if entity.kind != "foot-bot":
                    continue
                is_inside = math.hypot(*entity.position[:2]) < radius
                if is_inside and not inside.get(entity.id):
                    visits += 1
                    world.log(f"{entity.id} enters the nest at tick {tick.number}")
                inside[entity.id] = is_inside
            world.metric("visits", visits)
            if visits >= int(world.params["visits"]):  # IsExperimentFinished()
                world.finish()


main()
