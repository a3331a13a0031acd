# SPDX-License-Identifier: MIT
"""Two robots build two structures by different rule tables, and wrong structures that the judge must find."""

import math
import os
import pathlib
import subprocess
import tempfile
import unittest

import geometry
import judge
import perturb
import structure


def block(x, y, level, turn=0.0, tilt=0.0):
    """The pose of a block with its centre over (x, y) [m], turned about z and tilted about x [degrees]."""
    yaw, roll = math.radians(turn) / 2, math.radians(tilt) / 2
    return geometry.Pose((x, y, 0.055 * level),
                         (math.cos(yaw) * math.cos(roll), math.cos(yaw) * math.sin(roll),
                          math.sin(yaw) * math.sin(roll), math.sin(yaw) * math.cos(roll)))


def built(table, at=(0.3, -0.2), turn=30.0):
    """The poses of a perfect structure, the seed's first."""
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    places = sorted(structure.places_of(structure.STRUCTURES[table]), key=lambda place: (place != (0, 0, 0), place))
    return [block(at[0] + structure.PITCH * (c * i - s * j), at[1] + structure.PITCH * (s * i + c * j),
                  level, turn) for i, j, level in places]


def moved(pose, x=0.0, y=0.0, z=0.0):
    px, py, pz = pose.position
    return geometry.Pose((px + x, py + y, pz + z), pose.quaternion)


def faults_of(poses, table):
    verdict = judge.Verdict([])
    structure.judge_places(poses, structure.STRUCTURES[table], structure.Limits(), verdict)
    return "\n".join(verdict.faults)


class WrongStructures(unittest.TestCase):
    def test_perfect_ones_are_good_wherever_they_stand(self):
        for table, count in (("rules_cross", 6), ("rules_stairs", 6), ("rules_pyramid", 15)):
            for turn in (0, 30, 100, 200, 315):
                with self.subTest(table=table, turn=turn):
                    poses = built(table, turn=turn)
                    self.assertEqual(len(poses), count)
                    self.assertEqual(faults_of(poses, table), "")

    def test_blocks_may_be_turned_by_quarters(self):
        poses = built("rules_cross", turn=0)
        poses[2] = block(*poses[2].position[:2], 0, turn=90)
        self.assertEqual(faults_of(poses, "rules_cross"), "")

    def test_a_missing_block_and_one_beside(self):
        poses = built("rules_cross")
        poses[-1] = moved(poses[-1], x=0.5)
        self.assertRegex(faults_of(poses, "rules_cross"), r"missing \[\(1, 0, 0\)\], not in its place \[\(.*0\)\]")

    def test_another_structure(self):
        self.assertRegex(faults_of(built("rules_stairs"), "rules_cross"), "missing .*not in its place")

    def test_a_staircase_to_another_side(self):
        poses = [block(x, y, level) for x, y, level in
                 [(0, 0, 0), (0, 0, 1), (0, 0, 2), (0, 0.078, 0), (0, 0.078, 1), (0, 0.156, 0)]]
        self.assertRegex(faults_of(poses, "rules_stairs"), r"missing \[\(1, 0, 0\), \(1, 0, 1\), \(2, 0, 0\)\]")

    def test_two_blocks_in_one_place(self):
        poses = built("rules_cross")
        self.assertRegex(faults_of([*poses, poses[-1]], "rules_cross"), "two blocks in one place")

    def test_a_block_six_millimetres_off(self):
        poses = built("rules_cross")
        poses[3] = moved(poses[3], x=0.006)  # 5 mm after the fit to all blocks
        self.assertRegex(faults_of(poses, "rules_cross"), r"^the block at .* is \d\.\d mm off$")

    def test_a_turned_block(self):
        poses = built("rules_stairs", turn=0)
        poses[4] = block(*poses[4].position[:2], round(poses[4].position[2] / 0.055), turn=86.5)
        self.assertRegex(faults_of(poses, "rules_stairs"), r"^the block at .* is turned by -3\.5 degrees$")

    def test_a_block_that_leans(self):
        poses = built("rules_stairs", turn=0)
        poses[4] = block(*poses[4].position[:2], round(poses[4].position[2] / 0.055), tilt=4)
        self.assertRegex(faults_of(poses, "rules_stairs"), "high or tilted")

    def test_a_block_too_high(self):
        poses = built("rules_stairs")
        poses[2] = moved(poses[2], z=0.003)
        self.assertRegex(faults_of(poses, "rules_stairs"), r"is \+3\.0 mm high or tilted")

    def test_robots_that_overlap(self):
        scene = geometry.read_scene(perturb.STEPS)
        level = (1, 0, 0, 0)
        poses = {}
        for entity, x in (("robot0", 0.0), ("robot1", 0.128)):
            poses[entity, ""] = geometry.Pose((x, 0, 0), level)
            for key in scene.links:
                if key[0] == entity:
                    poses[key] = geometry.Pose((x, 0, 0.006 if key[1] == "base" else 0.5 + x), level)
        verdict = judge.Verdict([])
        structure.judge_robots([(0.1, poses)], scene, structure.Limits(), verdict)
        self.assertRegex("\n".join(verdict.faults), r"2\.00 mm deep: robot1 and robot0 at 0.1 s")


def blocks_beside(gap):
    """A scene of two blocks with a gap between them [m]."""
    blocks = "".join(f'''<prototype id="block{n}" model="block"><body position="{n * (0.055 + gap)},0,0"/>
        <controller config="block"/></prototype>''' for n in (0, 1))
    return f'''<argos-configuration>
        <include file="{perturb.ROOT}/scenes/models/block.argos"/>
        <framework><experiment length="4" ticks_per_second="10" random_seed="1"/></framework><controllers/>
        <arena size="4,4,2" center="0,0,1">{blocks}</arena>
        <physics_engines><dynamics3d id="dyn3d" iterations="20"><floor/><gravity g="9.8"/>
          <magnetism max_distance="0.1"/></dynamics3d></physics_engines>
        <media><directional_led id="directional_leds"/><tag id="tags"/><radio id="nfc"/></media>
        </argos-configuration>'''


class Gap(unittest.TestCase):
    """The smallest gap between columns: where the magnets pull less than friction holds (construction.md)."""

    def moved(self, gap):
        with tempfile.TemporaryDirectory(prefix="zc", dir="/tmp") as folder:
            scene, trace = pathlib.Path(folder) / "gap.argos", pathlib.Path(folder) / "trace.csv"
            scene.write_text(blocks_beside(gap))
            subprocess.run([perturb.BIN / "ziggurat", "run", scene, "--trace", trace, "--quiet"], check=True,
                           capture_output=True, env=dict(os.environ, XDG_RUNTIME_DIR=folder))
            ticks = judge.read_trace(trace)
            return max(math.dist(ticks[0][1][key].position, ticks[-1][1][key].position)
                       for key in ticks[0][1] if key[1] == "base")

    def test_at_12_millimetres_two_blocks_join(self):
        self.assertAlmostEqual(self.moved(0.012), 0.006, delta=2e-4)

    def test_at_14_millimetres_they_stand(self):
        self.assertLess(self.moved(0.014), 1e-5)


class Building(unittest.TestCase):
    def assert_built(self, number, rules, kills=0):
        verdict, changes, log = perturb.run(number, change=perturb.perturb_steps(rules), kills=kills)
        self.assertEqual(verdict.faults, [], f"{changes}\n" + "\n".join(log))
        self.assertEqual(changes.count("killed"), kills, changes)

    def test_a_stepped_pyramid(self):
        self.assert_built(4, "rules_cross")

    def test_another_table_gives_a_staircase(self):
        self.assert_built(0, "rules_stairs")

    @unittest.skipUnless(perturb.TAKES_ALL, "./quickstart test-all runs it")
    def test_robots_that_are_killed_and_started_again(self):
        self.assert_built(4, "rules_cross", kills=2)

    def test_a_run_that_ends_too_early(self):
        verdict, _, _ = perturb.run(0, ["--duration", "60"], perturb.perturb_steps("rules_cross"))
        self.assertRegex("\n".join(verdict.faults), r"missing .*not in its place")
        self.assertRegex("\n".join(verdict.faults), "last log line of robot0 is not 'done'")


if __name__ == "__main__":
    unittest.main(verbosity=2)
