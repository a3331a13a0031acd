# SPDX-License-Identifier: MIT
"""Devices from end to end: scripts set and read them, in one or several processes."""

import math
import resource
import textwrap

from harness import BIN, CONTROLLER_FAILED, SceneTest, main

# Listing 2.8 of the report, as printed.
REPEATER = """
function init()
reset()
end

function step()
robot.leds.set_all_colors(0,0,0)
if #robot.radios.radio_rx.rx_data > 0 then
robot.leds.set_all_colors(255,0,0)
robot.radios.radio_tx.tx_data({robot.radios.radio_rx.rx_data[1][1] +

1})
end
end

function reset()
-- start the passing of the token
if robot.id == "repeater0" then
robot.radios.radio_tx.tx_data({0})
end
end

function destroy()
end
"""

# The same, and logs the received messages.
LOGGED = REPEATER + """
local repeater_step = step
function step()
  for _, message in ipairs(robot.radios.radio_rx.rx_data) do log(table.concat(message, " ")) end
  repeater_step()
end
"""

CONTROLLER = """
    <lua_controller id="{id}">
      <actuators>{actuators}</actuators>
      <sensors>{sensors}</sensors>
      <params script="{script}" />
    </lua_controller>"""

ROBOT = """
    <prototype id="{id}" movable="true">
      <body position="{x:.6f},{y:.6f},0" orientation="{yaw:.6f},0,0" />
      <controller config="{controller}" />
      <links ref="base">
        <link id="base" geometry="box" size=".1,.04,.025" mass="0.1" />
      </links>
      <devices>{devices}</devices>
    </prototype>"""

SCENE = """<?xml version="1.0" ?>
<argos-configuration>
  <framework><experiment length="8" ticks_per_second="4" random_seed="1" /></framework>
  <controllers>{controllers}
  </controllers>
  <arena size="100,100,1" center="0,0,.5">{robots}
  </arena>
  <physics_engines>
    <dynamics3d id="dyn3d" iterations="{iterations}">
      <gravity g="9.8" />
      <floor />
    </dynamics3d>
  </physics_engines>
  <media>
    <led id="leds" index="grid" grid_size="20,20,20" />
    <directional_led id="directional_leds" index="grid" grid_size="20,20,20" />
    <tag id="tags" index="grid" grid_size="20,20,20" />
    <radio id="radio" index="grid" grid_size="20,20,20" />
  </media>
</argos-configuration>
"""

RADIOS = '<radios implementation="default" />'
LEDS = '<leds implementation="default" medium="leds" />'

REPEATER_DEVICES = """
        <radios medium="radio">
          <radio id="radio_rx" anchor="base" range="0.09" position=".05,0,.0125" />
          <radio id="radio_tx" anchor="base" range="0.09" position="-.05,0,.0125" />
        </radios>
        <leds medium="leds">
          <led id="led" anchor="base" color="0,0,0,0" offset="0,0,.025" />
        </leds>"""


class DeviceTest(SceneTest):
    def scene_of(self, controllers, robots, iterations=5):
        return self.write("scene.argos", SCENE.format(
            controllers="".join(controllers), robots="".join(robots), iterations=iterations))

    def ring(self, count, script=LOGGED, iterations=5):
        """Repeaters around a circle, each one's sender next to the next one's receiver."""
        self.write("repeater.lua", script)
        radius = 0.07 / math.sin(math.pi / count) if count > 4 else 0.06 * math.sqrt(2)
        robots = []
        for i in range(count):
            angle = math.radians(45) + 2 * math.pi * i / count
            robots.append(ROBOT.format(
                id=f"repeater{i}", controller="repeater", devices=REPEATER_DEVICES,
                x=radius * math.cos(angle), y=radius * math.sin(angle),
                yaw=math.degrees(angle) - 90))
        return self.scene_of([CONTROLLER.format(id="repeater", actuators=RADIOS + LEDS,
                                                sensors=RADIOS, script="repeater.lua")], robots,
                             iterations)

    def two(self, sender, receiver, actuators=RADIOS, sensors=RADIOS, devices=None):
        """Two robots within radio range of each other, each with the radios "a" and "b"."""
        self.write("sender.lua", textwrap.dedent(sender))
        self.write("receiver.lua", textwrap.dedent(receiver))
        devices = devices or """
        <radios medium="radio">
          <radio id="a" anchor="base" range="2" position="0,0,.0125" />
          <radio id="b" anchor="base" range="2" position=".05,0,.0125" />
        </radios>"""
        return self.scene_of(
            [CONTROLLER.format(id="sender", actuators=actuators, sensors="", script="sender.lua"),
             CONTROLLER.format(id="receiver", actuators="", sensors=sensors,
                               script="receiver.lua")],
            [ROBOT.format(id="t", controller="sender", devices=devices, x=0, y=0, yaw=0),
             ROBOT.format(id="l", controller="receiver", devices=devices, x=1, y=0, yaw=0)])

    def one(self, script, devices, actuators="", sensors=""):
        self.write("one.lua", textwrap.dedent(script))
        return self.scene_of(
            [CONTROLLER.format(id="one", actuators=actuators, sensors=sensors, script="one.lua")],
            [ROBOT.format(id="r", controller="one", devices=devices, x=0, y=0, yaw=0)])


class Ring(DeviceTest):
    def test_the_token_passes_alike_with_any_number_of_processes(self):
        scene = self.ring(4)
        expected = [f"[{tick} repeater{tick % 4}] {tick - 1}" for tick in range(1, 33)]
        hashes = set()
        for processes in (1, 2, 0, 0):
            outcome = self.run_scene("--ticks", 32, "--hash", "--quiet", "--lua-processes",
                                     processes, scene=scene)
            self.assertEqual(outcome.lines[:-1], expected, f"{processes} processes")
            hashes.add(outcome.lines[-1])
        self.assertEqual(len(hashes), 1, hashes)

    def test_repeaters_in_cpp_give_the_same_hash(self):
        scene = self.ring(4, REPEATER)
        expected = self.hash_of("--ticks", 20, scene=scene)
        text = scene.read_text().replace("lua_controller", "external_controller")
        scene.write_text(text.replace('id="repeater">',
                                      f'id="repeater" command="{BIN / "example_repeater"}">'))
        self.assertEqual(self.hash_of("--ticks", 20, scene=scene), expected)

    def test_bytes_wrap_and_the_token_is_never_lost(self):
        outcome = self.run_scene("--ticks", 600, "--quiet", "--lua-processes", 1,
                                 scene=self.ring(4))
        self.assertEqual(outcome.lines, [f"[{tick} repeater{tick % 4}] {(tick - 1) % 256}"
                                         for tick in range(1, 601)])

    def test_a_large_ring_keeps_its_token(self):
        outcome = self.run_scene("--ticks", 30, "--quiet", "--lua-processes", 2,
                                 scene=self.ring(256, iterations=1))
        self.assertEqual(outcome.lines, [f"[{tick} repeater{tick}] {tick - 1}"
                                         for tick in range(1, 31)])

    def test_the_listing_runs_as_printed(self):
        outcome = self.run_scene("--ticks", 8, "--quiet", scene=self.ring(4, REPEATER))
        self.assertEqual((outcome.out, outcome.err), ("", ""))


class Radio(DeviceTest):
    def test_a_message_that_no_robot_reads_is_dropped(self):
        scene = self.two(
            """
            local text = {}
            for i = 1, 65536 do text[i] = 7 end
            function init() end
            function step() for i = 1, 16 do robot.radios.a.tx_data(text) end end
            """,
            "function init() end function step() end", sensors="")
        # Peak memory of all processes so far [KiB]; every tick sends 1024 KiB.
        def run(ticks):
            self.run_scene("--ticks", ticks, "--quiet", scene=scene)
            return resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
        few = run(4)
        self.assertLess(run(44), few + 20 * 1024)


class Errors(DeviceTest):
    def test_a_wrong_position_ends_the_script_with_a_clear_message(self):
        devices = """
        <leds medium="leds">
          <led id="led" anchor="base" color="red" offset="0,0,.025" />
        </leds>"""
        scene = self.one("function init() end function step() robot.leds.set_single_color(2, 'red') end",
                         devices, actuators=LEDS)
        outcome = self.run_scene("--ticks", 2, "--quiet", scene=scene, code=CONTROLLER_FAILED)
        self.assert_is_sentence(outcome, r"one\.lua:1:.*set_single_color.*no such position: 2; "
                                         r"this robot has 1 LEDs")


class Cameras(DeviceTest):
    # Both are 0.889 m from the camera: there, 1 cm is 9.0 pixels.
    DEVICES = """
        <leds medium="leds"><led anchor="base" color="red" offset=".051,.01,.0225" /></leds>
        <tags medium="tags">
          <tag anchor="base" position=".051,0,.0125" orientation="0,90,0" observable_angle="75"
               side_length=".02" payload="start" />
        </tags>"""
    CAMERA = """
        <cameras implementation="default">
          <camera id="eye" anchor="base" position="-.06,0,.0125" orientation="90,-90,0"
                  range=".1:2" resolution="640,480" focal_length="800,800"
                  principle_point="320,240">
            <led_detector medium="leds" />
            <tag_detector medium="tags" />
          </camera>
        </cameras>"""

    def test_a_robot_sees_leds_and_tags_of_another(self):
        scene = self.two("""
            function init() end
            function step()
              robot.leds.set_all_colors("green")
              robot.tags.set_all_payloads("a\\0b")
            end
            """, """
            function init()
              eye = robot.cameras.eye
              leds, tags = eye.led_detector, eye.tag_detector
              assert(#leds == 0 and #tags == 0 and eye.directional_led_detector == nil)
            end
            function step()
              assert(#leds == 1 and #tags == 1 and tags == robot.cameras.eye.tag_detector)
              local led, tag = leds[1], tags[1]
              local seen = {led.center, tag.center, tag.corners[1], tag.corners[3]}
              for i, pixel in ipairs(seen) do
                seen[i] = string.format("%.1f,%.1f", pixel.x, pixel.y)
              end
              log(led.color.red, ",", led.color.green, " ", #tag.payload, " ",
                  table.concat(seen, " "))
            end
            """, actuators=LEDS + '<tags implementation="default" />', sensors=self.CAMERA,
            devices=self.DEVICES)
        outcome = self.run_scene("--ticks", 3, "--quiet", scene=scene)
        places = "329.0,231.0 320.0,240.0 311.0,231.0 329.0,249.0"
        self.assertEqual(outcome.lines, [f"[1 l] 255,0 5 {places}", f"[2 l] 0,255 3 {places}",
                                         f"[3 l] 0,255 3 {places}"], outcome.err)


if __name__ == "__main__":
    main()
