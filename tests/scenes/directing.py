# SPDX-License-Identifier: MIT
"""A world of boxes for tests of directors, and what these have in common."""

import json
import os
import sys

from harness import LIMIT, SceneTest

sys.path.insert(0, os.environ["ZIGGURAT_PYTHON_PACKAGE"])

import ziggurat  # noqa: E402

SCENE = """<argos-configuration>
  <framework><experiment length="{length}" ticks_per_second="10" random_seed="1" /></framework>
  <controllers />
  {director}
  <arena size="20, 20, 2">
    <box id="b1" size="0.1,0.1,0.1" movable="true" mass="1"><body position="0,0,0" />
      <leds medium="leds"><led anchor="origin" offset="0,0,0.1" color="red" /></leds></box>
    <box id="b2" size="0.1,0.1,0.1" movable="true" mass="2"><body position="1,0,0" /></box>
    <box id="wall" size="1,1,1" movable="false"><body position="5,0,0" /></box>
  </arena>
  <physics_engines><dynamics3d id="d" iterations="10"><gravity g="9.8" />{floor}</dynamics3d></physics_engines>
  <media><led id="leds" /></media>
</argos-configuration>
"""
EVERYTHING = ("poses", "links", "joints", "leds", "contacts")


def box(id, position, mass=1):
    return (f'<box id="{id}" size="0.1,0.1,0.1" movable="true" mass="{mass}">'
            f'<body position="{position}" /></box>')


class Directing(SceneTest):
    def setUp(self):
        super().setUp()
        self.endpoint = f"ipc://{self.folder}/e"
        self.record = self.folder / "run.mcap"
        self.write_scene()

    def write_scene(self, director='<director id="judge" />', floor="<floor />", length=0):
        self.scene.write_text(SCENE.format(director=director, floor=floor, length=length))

    def begin(self, *arguments):
        """Starts the run, which waits for a client."""
        self.run = self.start("run", self.scene, "--endpoint", self.endpoint, "--record", self.record, "--hash",
                              "--summary", self.folder / "summary.json", *arguments)
        self.wait_for((self.folder / "e").exists, bool, "socket")

    def direct(self, id="judge", **options):
        options.setdefault("tell", EVERYTHING)
        world = ziggurat.direct(id, self.endpoint, wait_timeout=LIMIT, **options)
        self.addCleanup(world.abandon)
        return world

    def end(self, code=0):
        """The end of the run; returns its summary, once the recording has been found to repeat it."""
        outcome = self.finish(self.run)
        self.assertEqual(outcome.code, code, outcome.err)
        self.outcome = outcome
        verified = self.ziggurat("verify", self.record)
        self.assertEqual(verified.code, 0, verified.out + verified.err)
        return json.loads((self.folder / "summary.json").read_text())
