# SPDX-License-Identifier: MIT
"""require "ziggurat" in Debian's lua5.3, against the real server; the program is in ZIGGURAT."""

import os
import pathlib
import signal
import subprocess
import sys
import unittest

import ziggurat

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[3]
sys.path.insert(0, str(ROOT / "tests"))

from waiting import HANG, wait_until_idle  # noqa: E402

PROGRAM = os.environ["ZIGGURAT"]
VEHICLE = "scenes/dynamics3d_multi_body_test.argos"
DEVICES = "scenes/devices_test.argos"


def serve(scene, *arguments):
    os.chdir(ROOT)
    return ziggurat.Server(scene, command=PROGRAM, arguments=arguments)


def run_script(scene):
    """What `ziggurat run` prints with the scene's own script."""
    return subprocess.run([PROGRAM, "run", scene, "--quiet", "--hash"], cwd=ROOT, check=True,
                          text=True, stdout=subprocess.PIPE, timeout=HANG).stdout.splitlines()


def run_module(scene, script):
    """What a server prints whose robots a Lua program drives."""
    with serve(scene, "--hash") as server:
        subprocess.run(["lua5.3", script, server.endpoint], check=True, timeout=HANG,
                       stdout=subprocess.DEVNULL)
        output, _ = server.process.communicate(timeout=HANG)
        return [line for line in output.splitlines() if not line.startswith("{")]


class Module(unittest.TestCase):
    def test_robots_of_one_state_do_what_scripts_of_their_own_do(self):
        expected = run_script(DEVICES)
        self.assertGreater(len(expected), 3)
        self.assertTrue(expected[-1].startswith("hash "))
        self.assertEqual(run_module(DEVICES, HERE / "module_devices.lua"), expected)

    def test_the_example(self):
        example = ROOT / "clients" / "lua" / "examples" / "vehicle.lua"
        lines = run_module(VEHICLE, example)
        self.assertEqual(lines[-1], run_script(VEHICLE)[-1], "the same commands, the same bits")
        self.assertRegex(lines[-2], r"\[300 vehicle\] wheel velocity: (0\.9[89]|1\.0[0-2])$")

    def test_faults(self):
        with serve(VEHICLE) as server:
            environment = {k: v for k, v in os.environ.items() if k != "ZIGGURAT_ENDPOINT"}
            subprocess.run(["lua5.3", HERE / "module_faults.lua", server.endpoint], check=True,
                           timeout=HANG, env=environment)
            _, errors = server.process.communicate(timeout=HANG)
            self.assertEqual(server.process.returncode, 3)
            self.assertIn("that was enough", errors)

    def test_ctrl_c_ends_the_wait(self):
        script = "require('ziggurat').connect{endpoint = 'ipc://@no-server', connect_timeout = 600}"
        lua = subprocess.Popen(["lua5.3", "-e", "print('begun') io.flush() " + script], text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertEqual(lua.stdout.readline(), "begun\n")
        wait_until_idle(lua.pid)
        lua.send_signal(signal.SIGINT)
        _, errors = lua.communicate(timeout=HANG)
        self.assertEqual(lua.returncode, 1)
        self.assertIn("interrupted!", errors)

    def test_the_controller_is_that_of_the_environment(self):
        script = "require('ziggurat').connect{endpoint = arg[1]}"
        with serve(VEHICLE) as server:
            for names, told in (({"ZIGGURAT_CONTROLLER": "ghost"}, "UNKNOWN_CONTROLLER.*'ghost'"),
                                ({"ZIGGURAT_SERVER_KEY": "short", "ZIGGURAT_CURVE_SECRET": "x"}, "'x'")):
                lua = subprocess.run(["lua5.3", "-", server.endpoint], input=script, text=True, timeout=60,
                                     env={**os.environ, **names}, stderr=subprocess.PIPE)
                self.assertEqual(lua.returncode, 1)
                self.assertRegex(lua.stderr, told)


if __name__ == "__main__":
    unittest.main()
