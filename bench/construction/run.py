#!/usr/bin/env python3
"""Time per substep of construction: the stacking scene, and sixteen copies of it side by side.

    bench/construction/run.py [--repeat 3]

Controllers are Lua scripts in a process of their own. Prints medians for each scene: wall time and
processor time (of server and scripts) per substep, and the real-time factor of the whole run. --scene N writes the scene with N robots to stdout instead.
"""

import argparse
import json
import os
import pathlib
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
import scenes  # noqa: E402

SCENE = ROOT / "scenes/prototype_srocs_system.argos"
BIN = pathlib.Path(os.environ.get("ZIGGURAT_BIN", ROOT / "build/release/bin"))


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
        scenes.stacking(arguments.scene).write(sys.stdout, encoding="unicode")
        return
    print("| robots, blocks | physics [µs per substep] | exchange | all | processor | × real time |")
    print("|---|---|---|---|---|---|")
    for count in (1, 16):
        *times, factor = measure(scenes.stacking(count), arguments.repeat)
        columns = " | ".join(f"{time:.0f}" for time in times)
        print(f"| {count}, {2 * count} | {columns} | {factor:.1f} |", flush=True)


if __name__ == "__main__":
    main()
