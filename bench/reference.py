#!/usr/bin/env python3
"""Wall time per tick of scenes whose time is known from the reference simulator.

    bench/reference.py [--repeat 3] [--only NAME]
    bench/reference.py --swarm 16,64,256,1024 [--repeat 3]

Controllers are Lua scripts in a process of their own; the reference had them in its own process. Both take
the same number of substeps per tick. Times are differences between a long and a short run, so start-up is
not in them; medians. The reference's are of another day, on 2 vCPU of an AMD EPYC, one thread, -O3.

--swarm: processor time of server and Lua scripts together per robot and substep, for these numbers of robots.
"""

import argparse
import json
import os
import pathlib
import resource
import shutil
import statistics
import subprocess
import tempfile

import scenes

BIN = pathlib.Path(os.environ.get("ZIGGURAT_BIN",
                                  pathlib.Path(__file__).resolve().parents[1] / "build/release/bin"))

# name, scene, ticks of the short and of the long run, the reference's time per tick [ms]
ROWS = [
    ("construction 1", lambda: scenes.stacking(1, 25), 10, 510, 3.5),
    ("construction 4", lambda: scenes.stacking(4, 25), 10, 210, 15.0),
    ("construction 16", lambda: scenes.stacking(16, 25), 10, 110, 68.3),
    ("magnets 20", lambda: scenes.magnets(5, 4), 10, 40, 5.4),
    ("magnets 100", lambda: scenes.magnets(10, 10), 10, 40, 26.1),
    ("magnets 400", lambda: scenes.magnets(20, 20), 10, 40, 111.0),
    ("vehicle", lambda: scenes.report("dynamics3d_multi_body_test", 25), 10, 1010, 0.84),
]


def processor_time():
    """Processor time of all child processes that have ended [s]."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Folder:
    """The scenes' folder, copied, where a changed scene finds its scripts and models."""

    def __init__(self):
        self.place = tempfile.TemporaryDirectory(prefix="zr", dir="/tmp")
        self.scenes = pathlib.Path(self.place.name) / "scenes"
        shutil.copytree(scenes.SCENES, self.scenes)
        (self.scenes / "wander.lua").write_text(scenes.WANDER)

    def run(self, tree, ticks):
        """Runs a scene. Returns wall time of the ticks and processor time of all [s]."""
        scene, summary = self.scenes / "bench.argos", pathlib.Path(self.place.name) / "summary.json"
        tree.write(scene)
        before = processor_time()
        subprocess.run([BIN / "ziggurat", "run", scene, "--quiet", "--ticks", str(ticks), "--summary",
                        summary], check=True, stdout=subprocess.DEVNULL,
                       env=dict(os.environ, XDG_RUNTIME_DIR=self.place.name))
        return json.loads(summary.read_text())["wall_s"], processor_time() - before


def time_per_tick(folder, tree, short, long, which):
    """Wall (which = 0) or processor (1) time of a tick between two numbers of ticks [s]."""
    return (folder.run(tree, long)[which] - folder.run(tree, short)[which]) / (long - short)


def compare(arguments, folder):
    """The reference's times beside ours."""
    print("| scene, ms per tick | reference [ms] | ours [ms] | times as fast |")
    print("|---|---|---|---|")
    for name, make, short, long, reference in ROWS:
        if arguments.only and arguments.only not in name:
            continue
        ms = statistics.median(1e3 * time_per_tick(folder, make(), short, long, 0)
                               for _ in range(arguments.repeat))
        print(f"| {name} | {reference} | {ms:.2f} | {reference / ms:.1f} |", flush=True)


def measure_swarm(arguments, folder):
    """How the cost of a robot depends on the number of robots."""
    print("| robots | processor time [us per robot and substep] |")
    print("|---|---|")
    for count in (int(word) for word in arguments.swarm.split(",")):
        tree = scenes.swarm(count)
        long = 85  # the same ticks for all: robots that meet cost more
        times = [time_per_tick(folder, tree, 5, long, 1) for _ in range(arguments.repeat)]
        print(f"| {count} | {1e6 * statistics.median(times) / count / 10:.1f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--only", metavar="NAME", help="rows whose name contains this")
    parser.add_argument("--swarm", metavar="COUNTS")
    arguments = parser.parse_args()
    folder = Folder()
    (measure_swarm if arguments.swarm else compare)(arguments, folder)


if __name__ == "__main__":
    main()
