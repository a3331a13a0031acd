#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs a construction scene many times, each time set up differently, and judges every run.

    tests/scenes/construction/perturb.py --runs 100
    tests/scenes/construction/perturb.py --wide --runs 100
    tests/scenes/construction/perturb.py --staircase --runs 20 --least 0.8
    tests/scenes/construction/perturb.py --steps rules_cross --runs 20 --least 0.9
    tests/scenes/construction/perturb.py --steps rules_cross --kills 2 --runs 20 --least 0.9
    tests/scenes/construction/perturb.py --pyramid --lose --runs 5

Perturbation number K is always the same. Stacking scene: the robot up to 3 cm farther back and turned
by up to 3 degrees, both blocks shifted by up to 1 cm in x and in y and turned by up to 3 degrees, another
seed, and half, the same or twice the number of iterations. With --wide: robot and blocks shifted by up to
3 cm in x and y and turned by up to 12 degrees instead. Staircase: the robot shifted by up to 2 cm and
turned by up to 5 degrees, every block shifted by up to 1.5 cm and turned by up to 8 degrees, another seed.
With --steps RULES: robots and blocks anywhere between 0.4 and 0.8 m from the structure's first block, which
stays, all turned by any angle, and half, the same or twice the number of iterations; with --pyramid and
--robots N between 0.48 and 0.95 m.
"""

import argparse
import concurrent.futures
import copy
import dataclasses
import math
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import judge
import structure

ROOT = pathlib.Path(__file__).resolve().parents[3]
STACKING = ROOT / "scenes/prototype_srocs_system.argos"
STAIRCASE = ROOT / "scenes/construction/staircase.argos"
STEPS = ROOT / "scenes/construction/steps.argos"
PYRAMID = ROOT / "scenes/construction/pyramid.argos"
BIN = pathlib.Path(os.environ.get("ZIGGURAT_BIN", ROOT / "build/release/bin"))
TAKES_ALL = os.environ.get("ZIGGURAT_TEST_ALL") == "1"  # all runs of the tests, not a few of each


def move(body, x=0.0, y=0.0, turn=0.0):
    """Moves a <body> in the plane [m] and turns it about z [degrees]."""
    place = [float(part) for part in body.get("position", "0,0,0").split(",")]
    turns = [float(part) for part in body.get("orientation", "0,0,0").split(",")]
    body.set("position", f"{place[0] + x:.6f},{place[1] + y:.6f},{place[2]:.6f}")
    body.set("orientation", f"{turns[0] + turn:.4f},{turns[1]},{turns[2]}")


def perturb(tree, number, wide=False):
    """Applies a perturbation to the scene; 0 changes nothing. Returns a description."""
    if number == 0:
        return "unchanged"
    draw = random.Random(number)
    changes = []
    for entity in tree.getroot().find("arena").iter("prototype"):
        if wide:
            x, y, turn = draw.uniform(-0.03, 0.03), draw.uniform(-0.03, 0.03), draw.uniform(-12, 12)
            move(entity.find("body"), x, y, turn)
            changes.append(f"{entity.get('id')} {1000 * x:+.0f}, {1000 * y:+.0f} mm, {turn:+.1f} deg")
        elif entity.get("id").startswith("robot"):
            back, turn = draw.uniform(0, 0.03), draw.uniform(-3, 3)
            move(entity.find("body"), x=-back, turn=turn)
            changes.append(f"robot {1000 * back:.0f} mm back, {turn:+.1f} deg")
        else:
            x, y, turn = draw.uniform(-0.01, 0.01), draw.uniform(-0.01, 0.01), draw.uniform(-3, 3)
            move(entity.find("body"), x, y, turn)
            changes.append(f"block {1000 * x:+.0f}, {1000 * y:+.0f} mm, {turn:+.1f} deg")
    tree.find("framework/experiment").set("random_seed", str(1000 + number))
    engine = tree.find("physics_engines/dynamics3d")
    factor = draw.choice([0.5, 1, 2])
    engine.set("iterations", str(round(factor * int(engine.get("iterations")))))
    changes.append(f"iterations x {factor:g}")
    return "; ".join(changes)


def perturb_widely(tree, number):
    return perturb(tree, number, wide=True)


def perturb_staircase(tree, number):
    if number == 0:
        return "unchanged"
    draw = random.Random(number)
    for entity in tree.getroot().find("arena").iter("prototype"):
        off, turn = (0.02, 5) if entity.get("id").startswith("robot") else (0.015, 8)
        move(entity.find("body"), draw.uniform(-off, off), draw.uniform(-off, off),
             draw.uniform(-turn, turn))
    tree.find("framework/experiment").set("random_seed", str(1000 + number))
    return f"perturbation {number}"


def scatter(draw, count, reach, apart, others=()):
    """Random points between two distances from the origin, each with its least distance from the others [m]."""
    points = list(others)
    while len(points) < count + len(others):
        angle, distance = draw.uniform(0, 2 * math.pi), draw.uniform(*reach)
        point = (distance * math.cos(angle), distance * math.sin(angle))
        if all(math.dist(point, other) > apart for other in points):
            points.append(point)
    return points[len(others):]


def perturb_steps(rules):
    """The change for the scene of two robots with a rule table."""
    def change(tree, number):
        arena = tree.getroot().find("arena")
        tree.find("parameters").set("rules", rules)
        if number == 0:
            return "unchanged"
        draw = random.Random(number)
        entities = list(arena.iter("prototype"))
        robots = [entity for entity in entities if entity.get("id").startswith("robot")]
        blocks = [entity for entity in entities if entity not in robots]
        nearest, farther = (0.48, 0.15) if len(blocks) > 8 else (0.4, 0)
        places = scatter(draw, len(blocks) - 1, (nearest, 0.8 + farther), 0.25)
        places += scatter(draw, len(robots), (nearest, 0.9 + farther), 0.3, places)
        for entity, place in zip(blocks + robots, [(0, 0), *places]):
            entity.find("body").set("position", f"{place[0]:.6f},{place[1]:.6f},0")
            entity.find("body").set("orientation", f"{draw.uniform(0, 360):.4f},0,0")
        tree.find("framework/experiment").set("random_seed", str(1000 + number))
        engine = tree.find("physics_engines/dynamics3d")
        factor = draw.choice([0.5, 1, 2])
        engine.set("iterations", str(round(factor * int(engine.get("iterations")))))
        return f"scattered, iterations x {factor:g}"
    change.rules, change.scene = rules, STEPS
    return change


def perturb_pyramid(tree, number, robots=None):
    """The change for the pyramid; robots: how many, if not as in the scene."""
    arena = tree.getroot().find("arena")
    if robots:
        first, *others = [entity for entity in arena.iter("prototype") if entity.get("id").startswith("robot")]
        for other in others:
            arena.remove(other)
        for index in range(1, robots):
            arena.append(copy.deepcopy(first))
            arena[-1].set("id", f"robot{index}")
    return perturb_steps("rules_pyramid")(tree, number)


perturb_pyramid.rules, perturb_pyramid.scene = "rules_pyramid", PYRAMID


def with_robots(count):
    """The change for the pyramid with so many robots."""
    def change(tree, number):
        return perturb_pyramid(tree, number, int(count))
    change.rules, change.scene = "rules_pyramid", PYRAMID
    return change


def last_words_fault(log, robots):
    """A fault if a robot's last log line is not 'done'; None if all are."""
    last = {line.split("] ")[0].split()[-1]: line for line in log if "] " in line}
    for robot in robots:
        if not last.get(robot, "").split("] ")[-1].startswith("done"):
            return f"the last log line of {robot} is not 'done': {last.get(robot)}"
    return None


@dataclasses.dataclass
class Outcome:
    returncode: int
    stdout: str
    stderr: str
    victims: list   # "robot0 killed at 'claim'"


def last_hash(scene, seconds, *options):
    """The last line of a run as the scene is."""
    with tempfile.TemporaryDirectory(prefix="zc", dir="/tmp") as folder:
        return subprocess.run(
            [BIN / "ziggurat", "run", scene, "--duration", str(seconds), "--hash", "--quiet", *options],
            check=True, capture_output=True, text=True,
            env=dict(os.environ, XDG_RUNTIME_DIR=folder)).stdout.splitlines()[-1]


def process_of(folder, index):
    """The process of a robot, in Lua by its place in the scene, in C++ that of all; its runtime folder tells it from
    other runs'."""
    for entry in pathlib.Path("/proc").iterdir():
        try:
            command = (entry / "cmdline").read_text().split("\0") if entry.name.isdigit() else [""]
            in_cpp = command[0].endswith("example_assembly") and \
                f"XDG_RUNTIME_DIR={folder}" in (entry / "environ").read_text().split("\0")
        except OSError:
            continue
        if in_cpp or any("ziggurat-lua" in word for word in command) and \
           any(folder in word and word.endswith(f"/robots-{index}") for word in command):
            return int(entry.name)
    return None


def endpoint(folder):
    return f"ipc://{folder}/supervisor"


def remove_from(scene_file, entity):
    """What the judge reads has only the robots that are there at the end."""
    tree = ElementTree.parse(scene_file)
    arena = tree.find("arena")
    arena.remove(next(element for element in arena if element.get("id") == entity))
    tree.write(scene_file)


# A robot's process ends itself in the tick after one of its lines, so that a run with kills is the same each time.
DYING = """
do
  local say, walk, die, kept = log, step, false, "{folder}/lines-"
  local deaths = {{{deaths}}}
  function log(...)
    say(...)
    local lines = io.open(kept .. robot.id, "a+")
    lines:write(".")
    lines:flush()
    die = deaths[robot.id .. " " .. lines:seek("end")]
    lines:close()
  end
  function step()
    if die then os.execute("kill -9 $PPID") end
    walk()
  end
end
"""


def run_and_kill(command, folder, draw, robots, kills, lose=False, script=None):
    """Runs a command; ends so many robots' processes with SIGKILL, each when that robot has logged a random line. With
    lose, removes one robot from the world when it has come to a dark block. robots: their places in the scene by id;
    script: theirs, if it is in Lua, which is changed."""
    plans = set()
    while len(plans) < kills:
        plans.add((draw.choice(sorted(robots)), draw.randint(4, 30)))
    if script and plans:
        deaths = ", ".join(f'["{robot} {line}"] = true' for robot, line in sorted(plans))
        script.write_text(script.read_text() + DYING.format(folder=folder, deaths=deaths))
    lost = lose and (draw.choice(sorted(robots)), draw.randint(1, 3))
    with open(pathlib.Path(folder) / "stderr", "w+") as errors, subprocess.Popen(
            [str(word) for word in command], stdout=subprocess.PIPE, stderr=errors, text=True,
            env=dict(os.environ, XDG_RUNTIME_DIR=folder)) as process:
        lines, counts, victims = [], {}, []
        for line in process.stdout:
            lines.append(line)
            if "] " not in line:
                continue
            robot = line.split("]")[0].split()[-1]
            counts[robot] = counts.get(robot, 0) + 1
            aims = line.rstrip().endswith("] aim")
            counts[robot, "aim"] = counts.get((robot, "aim"), 0) + aims
            if aims and (robot, counts[robot, "aim"]) == lost:
                subprocess.run([command[0], "ctl", endpoint(folder), "remove", robot], check=True)
                victims.append(f"{robot} removed at '{line.split('] ')[-1].strip()}'")
            victim = (robot, counts[robot]) in plans and (script or process_of(folder, robots[robot]))
            if victim:
                if not script:
                    os.kill(victim, signal.SIGKILL)
                victims.append(f"{robot} killed at '{line.split('] ')[-1].strip()}'")
        code = process.wait()
        errors.seek(0)
        return Outcome(code, "".join(lines), errors.read(), victims)


def run(number, options=(), change=perturb, keep=None, kills=0, lose=False):
    """Runs and judges one perturbation: (verdict, description of the changes, log lines). kills: robots' processes
    that are killed and started again; lose: one robot is removed for good, and the others finish."""
    rules = getattr(change, "rules", None)
    scene = change.scene if rules else STAIRCASE if change is perturb_staircase else STACKING
    with tempfile.TemporaryDirectory(prefix="zc", dir="/tmp") as folder:
        shutil.copytree(ROOT / "scenes", pathlib.Path(folder) / "scenes")
        scene_file = pathlib.Path(folder) / scene.relative_to(ROOT)
        tree = ElementTree.parse(scene_file)
        changes = change(tree, number)
        if rules:
            shutil.copy(pathlib.Path(__file__).parent / "parked.lua", scene_file.parent)
            for director in tree.getroot().findall("director"):  # that of the scene ends a run earlier
                tree.getroot().remove(director)
            tree.getroot().append(ElementTree.Element("director", id="end", script="parked.lua"))
        tree.write(scene_file)
        trace, readings = (pathlib.Path(folder) / name for name in ("trace.csv", "readings.jsonl"))
        robots = {entity.get("id"): index for index, entity in
                  enumerate(tree.find("arena").iter("prototype")) if entity.get("id").startswith("robot")}
        outcome = run_and_kill(
            [BIN / "ziggurat", "run", scene_file, "--trace", trace, *options,
             *(["--readings", readings] if scene == STACKING else []),
             *(["--lua-processes", "0", "--restart", "robot=9", "--trust-scripts"] if kills else []),
             *(["--endpoint", endpoint(folder)] if lose else [])],
            folder, random.Random(number), robots, kills, lose,
            None if any("--controller" in str(option) for option in options) else scene_file.parent / "assembler.lua")
        changes += "".join(f", {victim}" for victim in outcome.victims)
        if lose and outcome.victims:
            lost = outcome.victims[0].split()[0]
            remove_from(scene_file, lost)
            del robots[lost]
        if outcome.returncode != 0:
            verdict = judge.Verdict([f"exit code {outcome.returncode}: {outcome.stderr[-500:]}"])
        elif rules:
            verdict = structure.judge_structure(scene_file, trace, rules)
            changes += f", finished at {verdict.finished:.0f} s, turned {math.degrees(verdict.turn):.2f} deg"
        else:
            verdict = (judge.judge_stairs if scene == STAIRCASE else judge.judge)(scene_file, trace, readings)
        if len(outcome.victims) < max(kills, lose):
            verdict.faults.append(f"only {len(outcome.victims)} of {max(kills, lose)} robots were killed or removed")
        log = outcome.stdout.splitlines()
        fault = outcome.returncode == 0 and last_words_fault(log, robots)
        if fault:
            verdict.faults.append(fault)
        if keep and not verdict.good:
            shutil.copytree(folder, pathlib.Path(keep) / str(number), dirs_exist_ok=True)
            (pathlib.Path(keep) / str(number) / "log").write_text(outcome.stdout)
        return verdict, changes, log


def table_line(number, verdict, changes):
    return (f"{number:3d} {'good' if verdict.good else 'BAD '} "
            f"aside {1000 * verdict.aside:5.2f} mm, step {1000 * verdict.height:+.3f} mm, "
            f"moved {1000 * verdict.moved:.3f} mm, depth {1000 * verdict.depth:.3f} mm, "
            f"drift {1000 * verdict.drift:.4f} mm, energy {1000 * verdict.energy:.2f} mJ | {changes}"
            + "".join(f"\n      {fault}" for fault in verdict.faults))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--first", type=int, default=1, help="number of the first perturbation")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--least", type=float, default=0.95, help="least share of good runs")
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument("--wide", dest="change", action="store_const", const=perturb_widely,
                      default=perturb, help="larger perturbations of the stack")
    kind.add_argument("--staircase", dest="change", action="store_const", const=perturb_staircase,
                      help="the staircase, not the stack")
    kind.add_argument("--steps", dest="change", type=perturb_steps, metavar="RULES",
                      help="two robots with the rule table rules_cross or rules_stairs")
    kind.add_argument("--pyramid", dest="change", action="store_const", const=perturb_pyramid,
                      help="the pyramid of four robots, scattered in the same way")
    kind.add_argument("--robots", dest="change", type=with_robots, metavar="N",
                      help="the pyramid with N robots instead of four")
    parser.add_argument("--controller", action="append", default=[], metavar="ID=CMD",
                        help="passed on to ziggurat run")
    parser.add_argument("--kills", type=int, default=0,
                        help="robots' processes to kill in each run; they are started again")
    parser.add_argument("--lose", action="store_true",
                        help="remove one robot in each run for good: the others finish")
    parser.add_argument("--keep", metavar="DIR", help="keep scene and trace of bad runs")
    arguments = parser.parse_args()
    options = [f"--controller={controller}" for controller in arguments.controller]
    numbers = range(arguments.first, arguments.first + arguments.runs)
    good = 0
    worst = judge.Verdict([], 0, 0, 0)
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        runs = pool.map(
            lambda number: run(number, options, arguments.change, arguments.keep, arguments.kills,
                               arguments.lose), numbers)
        for number, (verdict, changes, _) in zip(numbers, runs):
            print(table_line(number, verdict, changes), flush=True)
            good += verdict.good
            if verdict.good:
                for name in ("aside", "height", "moved", "depth", "drift", "energy"):
                    setattr(worst, name, max(getattr(worst, name), abs(getattr(verdict, name))))
    print(f"{good} of {len(numbers)} good; worst of these:")
    print(table_line(0, worst, "").split("|")[0].replace("  0 good ", ""))
    return 0 if good >= arguments.least * len(numbers) else 1


if __name__ == "__main__":
    sys.exit(main())
