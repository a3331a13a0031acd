"""Which of five gains keeps the block from slipping? From one recorded run: docs/recordings.md, Fork.

usage: gains.py ZIGGURAT OUT.svg
"""

import csv
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
GAINS = [2, 4, 6, 8, 10]  # [1/s]
AT, END = 400, 800  # ticks of 1/200 s: the sledge has its speed; it stands again
COLORS = ["#1b9e77", "#7570b3", "#386cb0", "#d95f02", "#b30000"]
WIDTH, HEIGHT, LEFT, BOTTOM = 640, 360, 60, 50  # of the picture, and its margins [pixels]


def slips(trace):
    """Time [s] and how far the block has slipped on the bed since the fork [mm], of each tick."""
    bed, block, times = [], [], []
    with open(trace) as file:
        for row in csv.DictReader(file):
            if row["link"] == "bed":
                bed.append(float(row["x"]))
                times.append(float(row["time_s"]))
            elif row["entity"] == "block":
                block.append(float(row["x"]))
    offsets = [b - a for a, b in zip(bed, block)]
    return [(time, 1000 * (offset - offsets[0])) for time, offset in zip(times, offsets)]


def plot(curves, path):
    """Each curve a line, in SVG."""
    times = [time for time, _ in curves[GAINS[0]]]
    top = 1.05 * max(slip for curve in curves.values() for _, slip in curve)
    x = lambda time: LEFT + (time - times[0]) / (times[-1] - times[0]) * (WIDTH - LEFT - 110)
    y = lambda slip: HEIGHT - BOTTOM - slip / top * (HEIGHT - BOTTOM - 20)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
           'font-family="sans-serif" font-size="13"><rect width="100%" height="100%" fill="white"/>']
    text = lambda at, down, words, more="": out.append(f'<text x="{at:.0f}" y="{down:.0f}" {more}>{words}</text>')
    for number in range(6):
        time, slip = times[0] + number / 5 * (times[-1] - times[0]), number / 5 * top
        text(x(time), HEIGHT - BOTTOM + 18, f"{time:.1f}", 'text-anchor="middle"')
        text(LEFT - 8, y(slip) + 4, f"{slip:.0f}", 'text-anchor="end"')
        out.append(f'<path d="M{LEFT} {y(slip):.1f}H{x(times[-1]):.1f}" stroke="#ddd"/>')
    text((x(times[0]) + x(times[-1])) / 2, HEIGHT - 12, "simulated time [s]", 'text-anchor="middle"')
    text(-(HEIGHT - BOTTOM) / 2, 16, "slip of the block [mm]", 'text-anchor="middle" transform="rotate(-90)"')
    for number, (gain, curve) in enumerate(curves.items()):
        points = " ".join(f"{x(time):.1f},{y(slip):.1f}" for time, slip in curve[::4])
        out.append(f'<polyline points="{points}" fill="none" stroke="{COLORS[number]}" stroke-width="2"/>')
        text(WIDTH - 100, 30 + 20 * number, f"gain {gain}: {abs(curve[-1][1]):.1f} mm", f'fill="{COLORS[number]}"')
    out.append("</svg>\n")
    pathlib.Path(path).write_text("\n".join(out))


def main():
    ziggurat, picture = sys.argv[1:]
    run = lambda *words: subprocess.run([ziggurat, *map(str, words), "--quiet"], check=True)
    with tempfile.TemporaryDirectory() as folder:
        recording, trace = pathlib.Path(folder, "run.mcap"), pathlib.Path(folder, "trace.csv")
        run("run", HERE / "sledge.argos", "--ticks", AT + 20, "--record", recording)
        curves = {}
        for gain in GAINS:
            run("fork", recording, "--at", AT, "--param", f"gain={gain}", "--ticks", END, "--trace", trace)
            curves[gain] = slips(trace)
            print(f"gain {gain:2}: the block slips {abs(curves[gain][-1][1]):5.2f} mm")
    plot(curves, picture)


main()
