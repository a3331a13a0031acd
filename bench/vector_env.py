#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Steps per second of vector_env: 1, 2, 4, 8 worlds of a foot-bot and of the construction robot.

usage: PYTHONPATH=build/…/python vector_env.py ZIGGURAT [--seconds S] [--scene NAME] [--worlds N]

Each number of worlds runs for S seconds (default 5), with constant actions. A step of n worlds counts n times.
Processor time is that of this program and of its servers.
"""

import argparse
import os
import pathlib
import time

import numpy as np

import ziggurat

ROOT = pathlib.Path(__file__).resolve().parents[1]
SCENES = [("foot-bot", ROOT / "clients/python/examples/avoid.argos", "fb"),
          ("construction", ROOT / "scenes/prototype_srocs_system.argos", "robot0")]


def processor_time(processes):
    """Of this program and its servers so far [s]."""
    ticks = 0
    for pid in processes:
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
        ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def measure(program, scene, robot, n, seconds):
    os.chdir(ROOT)
    with ziggurat.vector_env(scene, n, command=program, robots=robot) as env:
        env.reset(seed=1)
        actions = np.full(env.action_space.shape, 0.1)
        processes = [os.getpid(), *(world.server.process.pid for world in env._worlds)]
        for _ in range(20):
            env.step(actions)
        steps, begin, used = 0, time.monotonic(), processor_time(processes)
        while time.monotonic() - begin < seconds:
            env.step(actions)
            steps += n
        wall, used = time.monotonic() - begin, processor_time(processes) - used
        resets = 20
        begin = time.monotonic()
        for _ in range(resets):
            env.reset(seed=1)
        return steps / wall, used / steps, (time.monotonic() - begin) / resets / n


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("ziggurat")
    parser.add_argument("--seconds", type=float, default=5)
    parser.add_argument("--scene", choices=[name for name, *_ in SCENES], help="this one only")
    parser.add_argument("--worlds", type=int, help="this number only")
    options = parser.parse_args()
    print("| scene | worlds | steps per second | processor time of a step | reset of a world |\n|---|---|---|---|---|")
    for name, scene, robot in SCENES:
        if options.scene not in (None, name):
            continue
        for n in [options.worlds] if options.worlds else (1, 2, 4, 8):
            rate, used, reset = measure(options.ziggurat, scene, robot, n, options.seconds)
            print(f"| {name} | {n} | {rate:.0f} | {1e6 * used:.0f} µs | {1e3 * reset:.1f} ms |", flush=True)


main()
