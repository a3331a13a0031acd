#!/usr/bin/env python3
"""Time per substep of construction: the stacking scene, and sixteen copies of it side by side.

    bench/construction/run.py [--repeat 3]

Controllers are Lua scripts in a process of their own. Prints medians for each scene: wall time and
processor time (of server and scripts) per substep, and the real-time factor of the whole run. --scene N writes the scene with N robots to stdout instead.
"""

import argparse
import copy
import json
import os
import pathlib
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENE = ROOT / "scenes/prototype_srocs_system.argos"
BIN = pathlib.Path(os.environ.get("ZIGGURAT_BIN", ROOT / "build/release/bin"))
DISTANCE = 0.5  # between robots [m]: too far for a robot to see the blocks of another


def side_by_side(count):
    """The stacking scene `count` times: robots and blocks in rows along x."""
    tree = ElementTree.parse(SCENE)
    root = tree.getroot()
    arena = root.find("arena")
    arena.set("size", "2, 20, 1")
    originals = list(arena)
    for original in originals:
        arena.remove(original)
    for row in range(count):
        for original in originals:
            entity = copy.deepcopy(original)
            entity.set("id", f"{original.get('id')}_{row}")
            x, _, z = original.find("body").get("position").split(",")
            y = (row - (count - 1) / 2) * DISTANCE
            entity.find("body").set("position", f"{x}, {y}, {z}")
            arena.append(entity)
    return tree


def processor_time():
    """Processor time of all child processes that have ended [s]."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def measure(tree, repeat):
    """Medians: physics, exchange, all, processor [µs per substep], times real time."""
    per_tick = int(tree.find("physics_engines/dynamics3d").get("iterations"))
    rows = []
    with tempfile.TemporaryDirectory(prefix="zc", dir="/tmp") as folder:
        shutil.copytree(SCENE.parent, pathlib.Path(folder) / "scenes")
        scene = pathlib.Path(folder) / "scenes" / SCENE.name
        summary = pathlib.Path(folder) / "summary.json"
        tree.write(scene)
        for _ in range(repeat):
            before = processor_time()
            subprocess.run([BIN / "ziggurat", "run", scene, "--quiet", "--summary", summary],
                           check=True, stdout=subprocess.DEVNULL,
                           env=dict(os.environ, XDG_RUNTIME_DIR=folder))
            row = json.loads(summary.read_text())
            substeps = row["ticks"] * per_tick
            parts = row["wall_time_s"]
            rows.append([1e6 * parts["physics"] / substeps, 1e6 * parts["exchange"] / substeps,
                         1e6 * row["wall_s"] / substeps,
                         1e6 * (processor_time() - before) / substeps, row["real_time_factor"]])
    return [statistics.median(column) for column in zip(*rows)]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--scene", type=int, metavar="N")
    arguments = parser.parse_args()
    if arguments.scene:
        side_by_side(arguments.scene).write(sys.stdout, encoding="unicode")
        return
    print("| robots, blocks | physics [µs per substep] | exchange | all | processor | × real time |")
    print("|---|---|---|---|---|---|")
    for count in (1, 16):
        *times, factor = measure(side_by_side(count), arguments.repeat)
        columns = " | ".join(f"{time:.0f}" for time in times)
        print(f"| {count}, {2 * count} | {columns} | {factor:.1f} |", flush=True)


if __name__ == "__main__":
    main()
