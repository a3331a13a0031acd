#!/usr/bin/env python3
"""Writes a scene of resting robots whose cameras see tagged boxes, and the script that reads the tags.

usage: camera_scenes.py ROBOTS FOLDER

Each robot is a box of 10 cm with a camera of 640 x 360 pixels and a tag detector; in front of it
stand five boxes of 4 cm, each with a tag towards it. The robots stand 1 m apart. Nothing moves.
"""

import math
import pathlib
import sys

SCRIPT = """\
-- Reads the pixels of every tag that the camera sees.
local sum = 0

function init() end

function step()
  for _, tag in ipairs(robot.cameras.cam.tag_detector) do sum = sum + tag.center.x end
end

function destroy() log(#robot.cameras.cam.tag_detector .. " tags in view at the end") end
"""

HEAD = """\
<argos-configuration>
  <framework><experiment length="{length}" ticks_per_second="5" random_seed="1"/></framework>
  <controllers>
    <lua_controller id="looks">
      <actuators/>
      <sensors>
        <cameras implementation="default">
          <camera id="cam" anchor="base" position="0.06,0,0.03" orientation="-90,90,0"
                  range="0.05:0.8" focal_length="884,884" principal_point="320,180"
                  resolution="640,360">
            <tag_detector medium="tags"/>
          </camera>
        </cameras>
      </sensors>
      <params script="camera_bench.lua"/>
    </lua_controller>
  </controllers>
  <arena size="{arena},{arena},1">
"""

TAIL = """\
  </arena>
  <physics_engines>
    <dynamics3d id="world" iterations="25"><gravity g="9.8"/><floor/></dynamics3d>
  </physics_engines>
  <media><tag id="tags"/></media>
</argos-configuration>
"""


def prototype(name, place, size, mass, more):
    return (f'    <prototype id="{name}" movable="true"><body position="{place}"/>{more}\n'
            f'      <links ref="base"><link id="base" geometry="box" size="{size},{size},{size}" '
            f'mass="{mass}"/></links></prototype>\n')


def robot_and_boxes(index, x, y):
    yield prototype(f"robot{index}", f"{x:g},{y:g},0", 0.1, 0.2, '<controller config="looks"/>')
    for box in range(5):
        tag = (f'<devices><tags medium="tags"><tag anchor="base" payload="{box}" side_length="0.025" '
               'observable_angle="75" position="-0.021,0,0.02" orientation="0,-90,0"/></tags>'
               '</devices>')
        place = f"{x + 0.45:g},{y + (box - 2) * 0.05:g},0"
        yield prototype(f"box{index}_{box}", place, 0.04, 0.05, tag)


def scene(robots, length):
    row = math.ceil(math.sqrt(robots))
    text = HEAD.format(length=length, arena=row + 1)
    for index in range(robots):
        x, y = index % row - (row - 1) / 2 - 0.2, index // row - (row - 1) / 2
        text += "".join(robot_and_boxes(index, x, y))
    return text + TAIL


def main():
    if len(sys.argv) != 3:
        print(__doc__)
        return 2
    folder = pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "camera_bench.lua").write_text(SCRIPT)
    path = folder / f"cameras_{sys.argv[1]}.argos"
    path.write_text(scene(int(sys.argv[1]), 20))
    print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
