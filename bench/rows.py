# SPDX-License-Identifier: MIT
"""The rows of bench/run: what is measured, beside which yardstick. A benchmark is added by a line here."""

from typing import Callable, NamedTuple, Optional

from measure import cells, environments, exchange, load, memory, once, per_tick, printed, processor, sensing, wall
import scenes


class Row(NamedTuple):
    name: str
    text: str
    unit: str
    ours: Callable  # (Place, quick) -> figure in the unit, or that and the yardstick's
    yardstick: str = ""  # what stands beside it
    theirs: Optional[Callable] = None  # the same of the yardstick
    plot: str = ""  # of PLOTS
    curve: str = ""
    x: float = 0  # its place in the plot


class Plot(NamedTuple):
    title: str
    x_label: str


PLOTS = {
    "robots": Plot("Two-wheeled robots with radio and eight rays", "robots"),
    "bodies": Plot("Pile of boxes, first second", "boxes"),
    "rest": Plot("Boxes at rest", "boxes"),
    "magnets": Plot("Magnetic boxes, a tick of 20 substeps", "boxes"),
    "cameras": Plot("Robots with a camera and five tags, exchange of a tick", "robots"),
    "lockstep": Plot("Lock-step tick without physics", "processes"),
    "worlds": Plot("vector_env, foot-bot", "worlds"),
}

substeps = 10  # of the swarm's tick


def swarm(count, threads, processes=1):
    options = ("--threads", threads, "--lua-processes", processes)
    more = f", {processes} Lua processes" if processes > 1 else ""
    curve = f"{threads} thread{'s' * (threads > 1)}" + (f", {processes} Lua" if processes > 1 else "")
    return Row(f"swarm-{count}-threads-{threads}{f'-lua-{processes}' if processes > 1 else ''}",
               f"{count} two-wheeled robots, {threads} thread{'s' * (threads > 1)}{more}", "µs per robot and substep",
               per_tick(lambda: scenes.swarm(count), 40, options=options, scale=1e6 / count / substeps),
               plot="robots", curve=curve, x=count)


def pile(count):
    return Row(f"pile-{count}", f"pile of {count} boxes, first second", "µs per substep",
               printed("bench_bodies", "pile", count, "ours"), "bare Bullet",
               printed("bench_bodies", "pile", count, "bullet"), "bodies", "", count)


def fall(count):
    return Row(f"fall-{count}", f"{count} falling boxes and cylinders", "µs per substep",
               printed("bench_bodies", "fall", count, "ours"), "bare Bullet", printed("bench_bodies", "fall", count, "bullet"))


def rest(count):
    return Row(f"rest-{count}", f"{count} boxes at rest", "ns per box and substep",
               per_tick(lambda: scenes.boxes(count), 4000 if count < 10_000 else 200, skip=20, scale=1e9 / count / substeps),
               plot="rest", curve="at rest", x=count)


def construction(count):
    return Row(f"construction-{count}", f"{count} robot{'s' * (count > 1)} that stack{'s' * (count == 1)} blocks", "ms per tick",
               per_tick(lambda: scenes.stacking(count, 25), 200, scale=1e3))


def magnets(columns, rows):
    count = columns * rows
    return Row(f"magnets-{count}", f"{count} magnetic boxes", "ms per tick",
               per_tick(lambda: scenes.magnets(columns, rows), 40, scale=1e3), plot="magnets", curve="", x=count)


def cameras(count):
    return Row(f"cameras-{count}", f"{count} robot{'s' * (count > 1)} with a camera and five tags, exchange", "µs per tick",
               per_tick(lambda: scenes.cameras(count), 400, of=exchange, scale=1e6),
               plot="cameras", curve="exchange", x=count)


def pictures(count):
    return Row(f"pictures-{count}", f"a picture of {count} box{'es' * (count > 1)}{' with a tag each' if count > 1 else ' with a tag'}, 640 × 480", "ms per picture",
               per_tick(lambda: scenes.pictures(count), 100, of=sensing, scale=1e3))


def lockstep(processes, robots):
    return Row(f"lockstep-{processes}x{robots}",
               f"lock-step tick, {processes} process{'es' * (processes > 1)} × {robots} robot{'s' * (robots > 1)}", "µs per tick",
               cells("bench_lockstep", (1, "ipc", processes, robots), "Ours [µs]", "Bare [µs]"), "bare ZeroMQ",
               plot="lockstep" if robots == 1 else "", x=processes)


def worlds(count):
    return Row(f"vector-env-{count}", f"vector_env, foot-bot, {count} world{'s' * (count > 1)}", "steps per second",
               environments(count), plot="worlds", curve="", x=count)


def mujoco(count):
    return Row(f"driving-{count}", f"{count} driving robot{'s' * (count > 1)}, physics alone", "µs per robot and substep",
               printed("bench_yardstick", "robots", count, "ours"), "MuJoCo",
               printed("bench_yardstick", "robots", count, "mujoco"))


ROWS = [
    *(swarm(count, threads) for count in (16, 64, 256, 1024) for threads in (1, 2)),
    swarm(1024, 2, 2),
    *(mujoco(count) for count in (1, 16, 64)),
    *(pile(count) for count in (50, 100, 200, 400)),
    *(fall(count) for count in (100, 400)),
    *(rest(count) for count in (400, 1600, 40_000)),
    Row("load-40000", "40 000 boxes, load", "s", once(lambda: scenes.boxes(40_000), 1, load)),
    Row("first-tick-40000", "40 000 boxes, first tick", "s", once(lambda: scenes.boxes(40_000), 1, wall)),
    Row("chain-20", "chain of 20 spherical links with 100 kg, processor time of a second", "s",
        per_tick(scenes.chain, 20, of=processor, scale=10)),
    *(construction(count) for count in (1, 4, 16)),
    *(magnets(*layout) for layout in ((5, 4), (10, 10), (20, 20))),
    Row("vehicle", "vehicle", "ms per tick",
        per_tick(lambda: scenes.report("dynamics3d_multi_body_test", 25), 500, scale=1e3)),
    Row("foot-bot-cameras", "foot-bot with two cameras, exchange", "µs per tick",
        per_tick(lambda: scenes.report("footbot_camera_prototype_example"), 1000, of=exchange, scale=1e6)),
    *(cameras(count) for count in (1, 16, 64)),
    *(pictures(count) for count in (1, 50, 500)),
    *(lockstep(*size) for size in ((1, 1), (4, 1), (16, 1), (1, 256))),
    *(worlds(count) for count in (1, 8)),
    Row("memory-server", "memory of a two-wheeled robot in the server", "kB", memory("ziggurat")),
    Row("memory-lua", "the same in its Lua process", "kB", memory("ziggurat-lua")),
]
