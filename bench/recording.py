#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What a recording costs: time of a tick with and without it, by turns; bytes per simulated minute; time of a seek.

usage: recording.py BIN [SCENE] [--ticks N] [--turns N] [--compression zstd|lz4|none]

BIN is the folder of the programs. The two kinds of runs are done by turns, so that what else the machine does
falls on both. Times: the run's own summary, and the processor time of the program with its controllers.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]


def run(program, scene, ticks, summary, *options):
    """Seconds per tick: on the wall; on the run's thread in its recording phase; of the processor in all processes."""
    before = os.times()
    subprocess.run([program, "run", scene, f"--ticks={ticks}", "--quiet", f"--summary={summary}", *options],
                   check=True, stdout=subprocess.DEVNULL)
    after = os.times()
    told = json.loads(pathlib.Path(summary).read_text())
    processor = after.children_user - before.children_user + after.children_system - before.children_system
    return told["wall_s"] / ticks, told["wall_time_s"]["recording"] / ticks, processor / ticks


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("scene", nargs="?", default=str(ROOT / "scenes/construction/staircase.argos"))
    parser.add_argument("--ticks", type=int, default=600)
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--compression", default="zstd")
    given = parser.parse_args()
    program = given.bin / "ziggurat"
    with tempfile.TemporaryDirectory() as folder:
        summary, record = os.path.join(folder, "summary.json"), os.path.join(folder, "run.mcap")
        plain, recorded = [], []
        for _ in range(given.turns):
            plain.append(run(program, given.scene, given.ticks, summary))
            recorded.append(run(program, given.scene, given.ticks, summary, "--record", record,
                                "--record-compression", given.compression))
        names = ["wall", "recording", "processor"]
        for i, name in enumerate(names):
            a, b = (statistics.median(row[i] for row in rows) for rows in (plain, recorded))
            extra = statistics.median((y[i] - x[i]) / x[0 if name == "recording" else i]
                                      for x, y in zip(plain, recorded))
            print(f"{name:10} {1e6 * a:9.1f} us a tick, recorded {1e6 * b:9.1f} us; median of the turns: "
                  f"{100 * extra:+.1f} % of {'a tick' if name == 'recording' else 'it'}")
        info = json.loads(subprocess.run([program, "info", record, "--json"], check=True, capture_output=True).stdout)
        print(f"{info['bytes'] / info['length_s'] * 60e-6:.2f} MB per simulated minute, "
              f"{info['uncompressed_bytes'] / info['length_s'] * 60e-6:.2f} MB before compression")


if __name__ == "__main__":
    main()
