# SPDX-License-Identifier: MIT
"""Measurements of the rows of bench/run: functions that return a figure, or one and its yardstick's."""

import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile
import time

import scenes

ROOT = pathlib.Path(__file__).resolve().parents[1]


class Missing(Exception):
    """What a row needs is not there; the text says what, and what gives it."""


class Place:
    """Programs, and a folder with copies of the scenes, where made scenes find their scripts."""

    def __init__(self, programs):
        self.programs = pathlib.Path(programs).resolve()
        self.phases = {}  # of the last run, by name [s]
        self.folder = tempfile.TemporaryDirectory(prefix="zb", dir="/tmp")
        self.scenes = pathlib.Path(self.folder.name) / "scenes"
        shutil.copytree(scenes.SCENES, self.scenes)
        (self.scenes / "wander.lua").write_text(scenes.WANDER)
        (self.scenes / "look.lua").write_text(scenes.LOOK)
        (self.scenes / "blink.lua").write_text(scenes.BLINK)
        self.environment = dict(os.environ, XDG_RUNTIME_DIR=self.folder.name,
                                PYTHONPATH=str(self.programs.parent / "python"))

    def program(self, name):
        found = self.programs / name
        if not found.exists():
            why = ("it is built only where MuJoCo is installed (apt-get install libmujoco-dev)"
                   if name == "bench_yardstick" else "cmake --preset bench, then ninja -C build/release")
            raise Missing(f"{found} is not there; {why}")
        return found

    def output(self, *command):
        """What a command prints. Its faults go to stderr."""
        return subprocess.run([str(word) for word in command], check=True, stdout=subprocess.PIPE, text=True,
                              env=self.environment).stdout

    def run(self, tree, ticks, options=()):
        """The summary of a run of a scene; besides, processor time of all its processes and time of the whole [s]."""
        scene, summary = self.scenes / "bench.argos", pathlib.Path(self.folder.name) / "summary.json"
        tree.write(scene)
        before, begin = processor_time(), time.monotonic()
        self.output(self.program("ziggurat"), "run", scene, "--quiet", "--ticks", ticks, "--summary", summary, *options)
        told = json.loads(summary.read_text())
        told["processor_s"] = processor_time() - before
        told["all_s"] = time.monotonic() - begin
        self.phases = told["phases_s"]
        return told


def processor_time():
    """Processor time of all child processes that have ended [s]."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


# Figures of a summary [s].
def wall(told):
    return told["wall_s"]


def exchange(told):
    return told["wall_time_s"]["exchange"]


def sensing(told):
    return told["phases_s"]["sensing"]


def processor(told):
    return told["processor_s"]


def load(told):
    return told["all_s"] - told["wall_s"]


def per_tick(make, ticks, skip=0, options=(), of=wall, scale=1.0):
    """A figure of a scene's run per tick, times scale. With skip it is the difference between a run of `skip`
    ticks and one of so many more: for what needs some time to come to rest."""
    def measure(place, quick):
        first, more = (min(skip, 2), 5) if quick else (skip, ticks)
        tree = make()
        before = of(place.run(tree, first, options)) if first else 0
        return scale * (of(place.run(tree, first + more, options)) - before) / more
    return measure


def once(make, ticks, of, scale=1.0):
    """A figure of a scene's whole run, times scale."""
    return lambda place, quick: scale * of(place.run(make(), ticks))


def printed(program, *arguments):
    """The number that a program prints."""
    return lambda place, quick: float(place.output(place.program(program), *arguments))


def cells(program, arguments, *columns):
    """Numbers in the only row of the table that a program prints."""
    def measure(place, quick):
        lines = place.output(place.program(program), *arguments).splitlines()
        table = [[word.strip(" *") for word in line.strip().strip("|").split("|")] for line in lines if line.startswith("|")]
        return tuple(float(table[2][table[0].index(column)]) for column in columns)
    return measure


def python_with_numpy():
    for program in (sys.executable, "/usr/bin/python3"):
        if subprocess.run([program, "-c", "import numpy"], stderr=subprocess.DEVNULL).returncode == 0:
            return program
    raise Missing("vector_env needs numpy; apt-get install python3-numpy")


def environments(worlds):
    """Steps a second of the Python client's vector_env."""
    def measure(place, quick):
        lines = place.output(python_with_numpy(), ROOT / "bench/vector_env.py", place.program("ziggurat"), "--seconds",
                             1 if quick else 4, "--scene", "foot-bot", "--worlds", worlds).splitlines()
        return float(lines[-1].split("|")[3])
    return measure


def anonymous_memory(pid):
    """RssAnon of a process, and its program's name; 0 if it has ended [kB]."""
    try:
        lines = pathlib.Path(f"/proc/{pid}/status").read_text().splitlines()
    except OSError:
        return "", 0
    fields = dict(line.split(":", 1) for line in lines)
    return fields["Name"].strip(), int(fields.get("RssAnon", "0").split()[0])


def memory_of(place, count, program):
    """Largest private memory of a program in a run of the swarm [kB]."""
    scene = place.scenes / "bench.argos"
    scenes.swarm(count).write(scene)
    command = [str(place.program("ziggurat")), "run", str(scene), "--quiet", "--ticks", "20", "--lua-processes", "1"]
    run = subprocess.Popen(command, stdout=subprocess.DEVNULL, env=place.environment, start_new_session=True)
    most = 0
    try:
        while run.poll() is None:
            for folder in pathlib.Path("/proc").iterdir():
                if not folder.name.isdigit():
                    continue
                try:
                    session = int((folder / "stat").read_text().rsplit(")", 1)[1].split()[3])
                except OSError:
                    continue
                if session != run.pid:
                    continue
                name, size = anonymous_memory(folder.name)
                if name == program and (program != "ziggurat" or folder.name == str(run.pid)):
                    most = max(most, size)
            time.sleep(0.02)
    finally:
        if run.poll() is None:
            run.terminate()
            run.wait()
    if run.returncode != 0:
        raise subprocess.CalledProcessError(run.returncode, run.args)
    return most


def memory(program):
    """Memory of a two-wheeled robot in a program: the difference between two sizes of the swarm [kB]."""
    def measure(place, quick):
        few, many = (16, 48) if quick else (64, 512)
        return (memory_of(place, many, program) - memory_of(place, few, program)) / (many - few)
    return measure
