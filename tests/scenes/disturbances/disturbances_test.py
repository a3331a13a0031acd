# SPDX-License-Identifier: MIT
"""Sixteen controllers, each of them disturbed. The results of the runs must not change.

disturbances_test.py         1000 ticks, a disturbance for each controller
disturbances_test.py --full  10 000 ticks, every disturbance for each controller
"""

import multiprocessing
import os
import pathlib
import re
import signal
import sys
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import controller  # noqa: E402
import hostile_peers  # noqa: E402
from controller import FLOOD, GARBAGE, ROBOTS, RUDE, SLOW, Board  # noqa: E402
from harness import FINISHED, SceneTest  # noqa: E402
from waiting import wait_until, wait_until_stopped  # noqa: E402

IS_FULL = "--full" in sys.argv
TICKS = 10_000 if IS_FULL else 1000
LIMIT = 1200 if IS_FULL else 120  # [s] of wall time for a run: more is a hang
STOPPED_TICKS = 4  # so many ticks a stopped controller with a deadline misses
FORK = multiprocessing.get_context("fork")

ACTUATORS = """<actuators>
        <joints implementation="default"><joint id="hinge" mode="velocity" max_impulse="0.01" /></joints>
        <radios implementation="default" />
      </actuators>
      <sensors>
        <joints implementation="default"><joint id="hinge" mode="position" /></joints>
        <radios implementation="default" />
      </sensors>"""


def scene():
    """Robots with one arm each on the floor, 1 m apart: within radio range, never in contact."""
    controllers, robots = [], []
    for i in range(ROBOTS):
        controllers.append(f"""
    <external_controller id="c{i}">
      {ACTUATORS}
      <params />
    </external_controller>""")
        robots.append(f"""
    <prototype id="robot{i}">
      <body position="{i % 4}, {i // 4}, 0" orientation="{10 * i}, 0, 0" />
      <controller config="c{i}" />
      <links ref="base">
        <link id="base" geometry="box" size="0.1, 0.1, 0.05" mass="2" />
        <link id="arm" geometry="box" size="0.2, 0.02, 0.02" mass="0.1" position="0, 0, 0.05" />
      </links>
      <joints>
        <joint id="hinge" type="revolute" axis="0, 0, 1">
          <parent link="base" position="0, 0, 0.05" orientation="0, 0, 0" />
          <child link="arm" position="0, 0, 0" orientation="0, 0, 0" />
        </joint>
      </joints>
      <devices>
        <radios medium="air">
          <radio id="transceiver" anchor="base" position="0, 0, 0.1" range="1.5" />
        </radios>
      </devices>
    </prototype>""")
    return f"""<argos-configuration>
  <framework><experiment length="0" ticks_per_second="10" random_seed="3" /></framework>
  <controllers>{"".join(controllers)}
  </controllers>
  <arena size="10, 10, 1" center="0, 0, 0.5">{"".join(robots)}
  </arena>
  <physics_engines>
    <dynamics3d id="dyn3d" iterations="4"><floor /><gravity g="9.8" /></dynamics3d>
  </physics_engines>
  <media><radio id="air" /></media>
</argos-configuration>
"""


class Run:
    """A server and its sixteen controllers during one run."""

    def __init__(self, test, name, *options, talks=True):
        self.test, self.name, self.talks = test, name, talks
        self.folder = test.folder / name
        self.folder.mkdir()
        self.board = Board()
        with open(self.folder / "stderr", "w", encoding="utf-8") as stderr:
            self.server = test.start(
                "serve", test.scene, "--endpoint", "tcp://127.0.0.1:*", "--ticks", TICKS,
                "--hash-file", self.folder / "hashes", "--trace", self.folder / "trace.csv", *options,
                limit=LIMIT, stderr=stderr)
        self.endpoint = self.server.stdout.readline().split()[1]
        self.others = []
        self.controllers = [self.fork(controller.control, *self.arguments_of(i))
                            for i in range(ROBOTS)]

    def arguments_of(self, i):
        return i, self.endpoint, self.folder, self.board, self.talks

    def fork(self, function, *arguments):
        process = FORK.Process(target=function, args=arguments, daemon=True)
        process.start()
        self.others.append(process)
        self.test.addCleanup(process.kill)  # a stopped process would outlive a failed test
        return process

    def signal(self, i, number):
        os.kill(self.controllers[i].pid, number)

    def restart(self, i):
        self.controllers[i] = self.fork(controller.control, *self.arguments_of(i))

    def wait(self, is_true, what):
        try:
            wait_until(lambda: is_true() or self.server.poll() is not None, what, hang=LIMIT)
        except AssertionError as error:
            self.test.fail(f"{error}\n{self.log()}")
        if not is_true():
            self.test.fail(f"the run has ended, and no {what}\n{self.log()}")

    def wait_for_tick(self, tick, of):
        self.wait(lambda: self.board.ticks[of] >= tick, f"tick {tick}")

    def log(self):
        """All that the server has written to stderr."""
        return (self.folder / "stderr").read_text()

    def finish(self):
        """Waits for the run's end and expects the exit code of a finished run."""
        try:
            code = self.server.wait(LIMIT)
        finally:
            ended = time.monotonic() + 20
            for process in self.controllers:
                process.join(max(0.0, ended - time.monotonic()))
            for process in self.others:
                if process.is_alive():
                    process.kill()
                process.join()
            self.server.stdout.close()
        self.test.assertEqual(code, FINISHED, self.log())
        return self

    def memory(self):
        """The most memory that the server had so far [KiB]."""
        status = pathlib.Path(f"/proc/{self.server.pid}/status").read_text()
        return int(re.search(r"VmHWM:\s*(\d+)", status)[1])

    def hashes(self):
        return (self.folder / "hashes").read_text().splitlines()

    def differences(self, other):
        """Robot -> the first tick at which one of its poses differs."""
        found = {}
        with open(self.folder / "trace.csv") as ours, open(other.folder / "trace.csv") as theirs:
            for one, two in zip(ours, theirs, strict=True):
                if one != two:
                    tick, _, robot, _ = one.split(",", 3)
                    found.setdefault(robot, int(tick))
        return found

    def arm_at_the_end(self, i, ticks):
        """Orientations of a robot's arm in the last ticks."""
        with open(self.folder / "trace.csv") as rows:
            found = [row.split(",")[7:] for row in rows if f",robot{i},arm," in row]
        return [[float(value) for value in row] for row in found[-ticks:]]


class Disturbances(SceneTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("sixteen_arms.argos", scene())
        self.begun = time.monotonic()

    def report(self, text):
        print(f"  {time.monotonic() - self.begun:6.1f} s  {text}", flush=True)

    def undisturbed(self, **options):
        run = Run(self, "undisturbed", **options).finish()
        self.assertEqual([0] * ROBOTS, list(run.board.noticed))
        self.assertEqual([1] * ROBOTS, list(run.board.ended))
        self.report(f"undisturbed: {run.hashes()[-1]}")
        return run

    # ---- a run without deadlines loses nothing ----

    def test_without_deadlines_every_hash_stays_the_same(self):
        """Policy WAIT and a lease: the hash of every tick equals that of the undisturbed run."""
        expected = self.undisturbed()
        run = Run(self, "disturbed", "--lease", "60")
        for function in (hostile_peers.slowloris, hostile_peers.noise,
                         hostile_peers.never_reads):
            run.fork(hostile_peers.run_until_server_ends, function, run.endpoint)
        kinds = (self.stop, self.kill, GARBAGE, RUDE, FLOOD, SLOW)
        rounds = len(kinds) if IS_FULL else 1
        apart = TICKS * 9 // 10 // (rounds * ROBOTS)
        resumed = [0] * ROBOTS
        for number in range(rounds * ROBOTS):
            i = number % ROBOTS
            kind = kinds[(number + number // ROBOTS) % len(kinds)]
            run.board.gate.value = apart * (number + 2)  # the run does not end before a late test's turn
            run.wait_for_tick(apart * (number + 1), of=i)
            peak = run.memory()
            if callable(kind):
                kind(run, i)
            else:
                run.board.orders[i] = kind
            resumed[i] += kind in (self.kill, RUDE, FLOOD, SLOW)
        run.board.gate.value = TICKS + 1
        run.finish()
        self.report(f"the server had {peak / 1024:.0f} MB at most")
        self.report(f"disturbed:   {run.hashes()[-1]}, {rounds * ROBOTS} disturbances")
        self.assertEqual([0] * ROBOTS, list(run.board.noticed), run.log())
        self.assertEqual(resumed, list(run.board.resumed))
        self.assertEqual([1] * ROBOTS, list(run.board.ended))
        self.assertEqual(expected.hashes(), run.hashes())

    def stop(self, run, i):
        """The world waits while a controller is stopped."""
        run.signal(i, signal.SIGSTOP)
        wait_until_stopped(run.controllers[i].pid)
        time.sleep(0.2)  # elapsed time is the subject: the world could have many ticks
        # Its current tick may be answered already, but not the next one.
        self.assertLessEqual(max(run.board.ticks), run.board.ticks[i] + 1)
        run.signal(i, signal.SIGCONT)

    def kill(self, run, i):
        run.signal(i, signal.SIGKILL)
        run.controllers[i].join()
        run.restart(i)

    # ---- with deadlines, only the disturbed robots are affected ----

    def test_with_deadlines_only_disturbed_robots_move_differently(self):
        """HOLD, ZERO and DROP: only disturbed robots move differently, and only after the disturbance."""
        expected = self.undisturbed(talks=False)
        for turn in range(4 if IS_FULL else 1):
            self.disturb_under_policies(expected, [(i + turn) % 4 for i in range(ROBOTS)], turn)

    def disturb_under_policies(self, expected, roles, turn):
        """Roles: 0 waits; 1 holds and 2 zeroes while it is stopped; 3 is killed and dropped."""
        texts = (None, "hold:200", "zero:200", "drop:200:20")
        options = ["--allow-drops",
                   *(f"--deadline=c{i}={texts[role]}" for i, role in enumerate(roles) if role)]
        run = Run(self, f"policies{turn}", *options, talks=False)
        begun = {}
        apart = TICKS * 8 // 10 // ROBOTS
        for i, role in enumerate(roles):
            run.wait_for_tick(apart * (i + 1), of=roles.index(0))
            if role == 0:
                continue
            begun[f"robot{i}"] = max(run.board.ticks)
            run.signal(i, signal.SIGKILL if role == 3 else signal.SIGSTOP)
            if role != 3:
                run.wait_for_tick(max(run.board.ticks) + STOPPED_TICKS, of=roles.index(0))
                run.signal(i, signal.SIGCONT)
        run.finish()
        differences = run.differences(expected)
        self.report(f"policies: robots that moved differently, and their first such tick: {differences}")
        self.assertEqual(set(begun), set(differences), run.log())
        for i, role in enumerate(roles):
            if run.board.first_missed[i] >= 0:  # on a busy machine it may miss one earlier
                begun[f"robot{i}"] = run.board.first_missed[i]
            if role:
                self.assertGreater(differences[f"robot{i}"], begun[f"robot{i}"], i)
            self.judge(run, i, role)

    def judge(self, run, i, role):
        """Checks what a controller of this role noticed, and whether its robot's arm moved at the end."""
        self.assertEqual(role != 3, bool(run.board.ended[i]), i)
        if role == 0:
            self.assertEqual(0, run.board.missed[i], i)
        if role in (1, 2):
            self.assertGreaterEqual(run.board.missed[i], STOPPED_TICKS - 1, i)
        self.assertEqual(0, run.board.noticed[i], i)
        dropped = re.search(rf"robot{i} \(controller 'c{i}'\) is dropped at tick (\d+)", run.log())
        self.assertEqual(role == 3, bool(dropped), run.log())
        last = run.arm_at_the_end(i, 10)
        travel = max(abs(a - b) for a, b in zip(last[0], last[-1]))
        if role == 3:  # it still creeps a little on its contacts with the floor
            self.assertLess(travel, 1e-4, "the arm of a dropped robot stands still")
        else:
            self.assertGreater(travel, 1e-3, "an arm with a controller moves")


if __name__ == "__main__":
    unittest.main(argv=[word for word in sys.argv if word != "--full"], verbosity=2)
