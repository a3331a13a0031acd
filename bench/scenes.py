# SPDX-License-Identifier: MIT
"""Scenes that the benchmarks run, as trees of XML elements."""

import copy
import math
import pathlib
import xml.etree.ElementTree as ElementTree

SCENES = pathlib.Path(__file__).resolve().parents[1] / "scenes"


def report(name, iterations=None):
    """A scene of the report; with another number of substeps per tick, if one is given."""
    tree = ElementTree.parse(SCENES / f"{name}.argos")
    if iterations:
        tree.find("physics_engines/dynamics3d").set("iterations", str(iterations))
    return tree


def stacking(count, iterations=None, distance=0.5):
    """The stacking scene `count` times: robots and blocks in rows along x, `distance` apart [m]: too far
    for a robot to see the blocks of another."""
    tree = report("prototype_srocs_system", iterations)
    arena = tree.find("arena")
    arena.set("size", f"2, {max(20, 2 * count * distance)}, 1")
    originals = list(arena)
    for original in originals:
        arena.remove(original)
    for row in range(count):
        for original in originals:
            entity = copy.deepcopy(original)
            entity.set("id", f"{original.get('id')}_{row}")
            x, _, z = original.find("body").get("position").split(",")
            y = (row - (count - 1) / 2) * distance
            entity.find("body").set("position", f"{x}, {y}, {z}")
            arena.append(entity)
    return tree


def magnets(columns, rows):
    """The scene of magnetic boxes with `rows` rows of `columns` boxes."""
    tree = report("dynamics3d_magnetism_test")
    arena = tree.find("arena")
    width, depth = 0.05 * (columns - 1) + 0.3, 0.1 * (rows - 1) + 0.2
    arena.set("size", f"{width:.6g}, {depth:.6g}, 0.5")
    half = 0.025 / 2  # of a wall's thickness
    for wall, size, x, y in (("bn", (2 * half, depth - 2 * half), width / 2 - half, half),
                             ("be", (width - 2 * half, 2 * half), half, half - depth / 2),
                             ("bs", (2 * half, depth - 2 * half), half - width / 2, -half),
                             ("bw", (width - 2 * half, 2 * half), -half, depth / 2 - half)):
        box = arena.find(f"box[@id='{wall}']")
        box.set("size", f"{size[0]:.6g}, {size[1]:.6g}, 0.025")
        box.find("body").set("position", f"{x:.6g}, {y:.6g}, 0")
    group = arena.find("distribute")
    for element in (group.find("position"), group.find("orientation")):
        element.set("layout", f"{columns}, {rows}, 1")
    group.find("entity").set("quantity", str(columns * rows))
    return tree


ROBOT = """
<prototype id="r{number}" movable="true">
  <body position="{x:g}, {y:g}, 0" orientation="{yaw}, 0, 0"/>
  <controller config="wander"/>
  <links ref="base">
    <link id="base" geometry="cylinder" radius="0.05" height="0.03" mass="0.3" position="0, 0, 0.012" orientation="0, 0, 0"/>
    <link id="left" geometry="cylinder" radius="0.02" height="0.006" mass="0.02" position="0, 0.055, 0.02" orientation="0, 0, -90"/>
    <link id="right" geometry="cylinder" radius="0.02" height="0.006" mass="0.02" position="0, -0.055, 0.02" orientation="0, 0, 90"/>
    <link id="front" geometry="sphere" radius="0.005" mass="0.01" position="0.035, 0, 0.001" orientation="0, 0, 0"/>
    <link id="back" geometry="sphere" radius="0.005" mass="0.01" position="-0.035, 0, 0.001" orientation="0, 0, 0"/>
  </links>
  <joints>
    <joint id="left" type="revolute" axis="0, 0, 1">
      <parent link="base" position="0, 0.055, 0.008" orientation="0, 0, -90"/><child link="left"/>
    </joint>
    <joint id="right" type="revolute" axis="0, 0, 1">
      <parent link="base" position="0, -0.055, 0.008" orientation="0, 0, 90"/><child link="right"/>
    </joint>
    <joint id="front" type="fixed"><parent link="base" position="0.035, 0, -0.011"/><child link="front"/></joint>
    <joint id="back" type="fixed"><parent link="base" position="-0.035, 0, -0.011"/><child link="back"/></joint>
  </joints>
  <devices>
    <proximity_sensors>{rays}</proximity_sensors>
    <radios medium="radio"><radio id="radio" anchor="base" position="0, 0, 0.02" range="0.6"/></radios>
  </devices>
</prototype>
"""

SWARM = """
<argos-configuration>
  <framework><experiment length="0" ticks_per_second="10" random_seed="1"/></framework>
  <controllers>
    <lua_controller id="wander">
      <actuators>
        <joints implementation="default">
          <joint id="left" mode="velocity" max_torque="5"/><joint id="right" mode="velocity" max_torque="5"/>
        </joints>
        <radios implementation="default"/>
      </actuators>
      <sensors>
        <joints implementation="default"><joint id="left" mode="velocity"/><joint id="right" mode="velocity"/></joints>
        <proximity implementation="default" show_rays="false"/>
        <radios implementation="default"/>
      </sensors>
      <params script="wander.lua"/>
    </lua_controller>
  </controllers>
  <arena size="{size:g}, {size:g}, 1" center="0, 0, 0.5">{robots}</arena>
  <physics_engines>
    <dynamics3d id="dynamics" iterations="10"><gravity g="9.8"/><floor height="0.01"/></dynamics3d>
  </physics_engines>
  <media><radio id="radio"/></media>
</argos-configuration>
"""

WANDER = """\
-- Drives straight, backs away from what is near, and tells how many messages it heard.
local backing = 0

function init() end

function step()
  local near = 0
  for _, value in ipairs(robot.proximity) do near = math.max(near, value) end
  backing = near > 0.05 and 10 or math.max(backing - 1, 0)
  local speed = backing > 0 and -2 or 3
  robot.joints.left.set_target(speed)
  robot.joints.right.set_target(-speed)
  robot.radios.radio.tx_data({#robot.radios.radio.rx_data, near})
end

function reset() backing = 0 end
function destroy() end
"""


def swarm(count):
    """Robots on two wheels and two casters, with a radio and eight rays, 40 cm apart. Their script, WANDER,
    must stand beside the scene as wander.lua."""
    columns, pitch = math.ceil(math.sqrt(count)), 0.4
    robots = []
    for i in range(count):
        rays = ""
        for k in range(8):
            x, y = math.cos(k * math.pi / 4 + 0.01), math.sin(k * math.pi / 4 + 0.01)
            rays += (f'<sensor anchor="base" offset="{0.055 * x:.4f}, {0.055 * y:.4f}, 0.02"'
                     f' direction="{x:.4f}, {y:.4f}, 0" range="0.15"/>')
        robots.append(ROBOT.format(number=i, x=(i % columns - (columns - 1) / 2) * pitch,
                                   y=(i // columns - (columns - 1) / 2) * pitch,
                                   yaw=i * 137 % 360, rays=rays))
    text = SWARM.format(size=columns * pitch + 1, robots="".join(robots))
    return ElementTree.ElementTree(ElementTree.fromstring(text.strip()))


BARE = """
<argos-configuration>
  <framework><experiment length="0" ticks_per_second="10" random_seed="1"/></framework>
  <controllers/>
  <arena size="{size:g}, {size:g}, 20" center="0, 0, 10">{entities}</arena>
  <physics_engines>
    <dynamics3d id="dynamics" iterations="{iterations}"><gravity g="9.8"/><floor height="0.01"/></dynamics3d>
  </physics_engines>
  <media/>
</argos-configuration>
"""


def bare(size, entities, iterations=10):
    text = BARE.format(size=size, entities=entities, iterations=iterations)
    return ElementTree.ElementTree(ElementTree.fromstring(text.strip()))


def boxes(count):
    """Boxes of 10 cm that stand on the floor, 5 cm apart."""
    columns = math.ceil(math.sqrt(count))
    rows = math.ceil(count / columns)
    return bare(0.15 * columns + 1, f"""
<distribute>
  <position method="grid" center="0, 0, 0" distances="0.15, 0.15, 0" layout="{columns}, {rows}, 1"/>
  <orientation method="constant" values="0, 0, 0"/>
  <entity quantity="{count}" max_trials="1"><box id="b" size="0.1, 0.1, 0.1" movable="true" mass="1"/></entity>
</distribute>""")


def chain(links=20, load=100):
    """A chain of spherical joints with a load [kg] at its end, which falls from the horizontal; 500 substeps
    a second."""
    parts = ['<link id="base" geometry="box" size="0.1, 0.1, 0.1" mass="1" position="0, 0, 0" orientation="0, 0, 0"/>']
    joints = []
    for i in range(links):
        parts.append(f'<link id="l{i}" geometry="cylinder" radius="0.01" height="0.1" mass="0.1" '
                     'position="0, 0, 0" orientation="0, 0, 0"/>')
        joints.append(f'<joint id="j{i}" type="spherical"><parent link="{f"l{i - 1}" if i else "base"}" position="0, 0, 0.1"/>'
                      f'<child link="l{i}"/></joint>')
    parts.append(f'<link id="load" geometry="sphere" radius="0.1" mass="{load}" position="0, 0, 0" orientation="0, 0, 0"/>')
    joints.append(f'<joint id="load" type="fixed"><parent link="l{links - 1}" position="0, 0, 0.1"/><child link="load"/></joint>')
    return bare(20, f"""
<prototype id="chain" movable="false">
  <body position="0, 0, 5" orientation="0, 90, 0"/>
  <links ref="base">{"".join(parts)}</links>
  <joints>{"".join(joints)}</joints>
</prototype>""", 50)


CAMERA_ROBOT = """
<prototype id="r{number}" movable="true">
  <body position="{x:g}, {y:g}, 0" orientation="0, 0, 0"/>
  <controller config="look"/>
  <links ref="base">
    <link id="base" geometry="box" size="0.1, 0.1, 0.1" mass="0.2" position="0, 0, 0" orientation="0, 0, 0"/>
  </links>
</prototype>
"""

TARGET = """
<prototype id="t{robot}_{number}" movable="true">
  <body position="{x:g}, {y:g}, 0" orientation="0, 0, 0"/>
  <links ref="base">
    <link id="base" geometry="box" size="0.04, 0.04, 0.04" mass="0.05" position="0, 0, 0" orientation="0, 0, 0"/>
  </links>
  <devices>
    <tags medium="tags">
      <tag payload="{number}" side_length="0.025" observable_angle="75" anchor="base" position="-0.021, 0, 0.02"
           orientation="0, -90, 0"/>
    </tags>
  </devices>
</prototype>
"""

LOOKING = """
<lua_controller id="look">
  <actuators/>
  <sensors>
    <cameras implementation="default" show_frustum="false">{camera}</cameras>
  </sensors>
  <params script="{script}"/>
</lua_controller>
"""

TAG_CAMERA = """
<camera id="camera" range="0.05:0.8" resolution="640, 360" anchor="base" position="0.06, 0, 0.03"
        orientation="-90, 90, 0" focal_length="884, 884" principal_point="320, 180">
  <tag_detector medium="tags" show_rays="false"/>
</camera>
"""

PICTURE_CAMERA = """
<camera id="camera" range="0.05:8" resolution="640, 480" anchor="base" position="0.06, 0, 0.2"
        orientation="-90, 90, 15" focal_length="600, 600" principal_point="320, 240" image="true"/>
"""

BLINK = """\
function init() end
function step() end
function reset() end
function destroy() end
"""

LOOK = """\
-- Adds up where its camera sees tags.
local sum = 0
function init() end
function step()
  for _, tag in ipairs(robot.cameras.camera.tag_detector) do sum = sum + tag.center.x end
end
function reset() sum = 0 end
function destroy() end
"""


def cameras(count):
    """Robots that stand 1 m apart, each with a camera that sees five tags. Their script, LOOK, must stand
    beside the scene as look.lua."""
    columns = math.ceil(math.sqrt(count))
    entities = []
    for i in range(count):
        x, y = i % columns - (columns - 1) / 2 - 0.2, i // columns - (columns - 1) / 2
        entities.append(CAMERA_ROBOT.format(number=i, x=x, y=y))
        entities += [TARGET.format(robot=i, number=j, x=x + 0.45, y=y + 0.05 * (j - 2)) for j in range(5)]
    tree = bare(columns + 2, "".join(entities))
    controller = LOOKING.format(camera=TAG_CAMERA, script="look.lua")
    tree.find("controllers").append(ElementTree.fromstring(controller.strip()))
    ElementTree.SubElement(tree.find("media"), "tag", id="tags")
    return tree


def pictures(targets):
    """A robot whose camera takes pictures of boxes with a tag each, from 0.4 m on. Its script, BLINK, must stand beside
    the scene as blink.lua."""
    columns = math.ceil(math.sqrt(targets))
    entities = [CAMERA_ROBOT.format(number=0, x=-0.5, y=0)]
    entities += [TARGET.format(robot=0, number=j, x=0.1 * (j // columns), y=0.1 * (j % columns - (columns - 1) / 2))
                 for j in range(targets)]
    tree = bare(0.2 * columns + 4, "".join(entities))
    controller = LOOKING.format(camera=PICTURE_CAMERA, script="blink.lua")
    tree.find("controllers").append(ElementTree.fromstring(controller.strip()))
    ElementTree.SubElement(tree.find("media"), "tag", id="tags")
    return tree
