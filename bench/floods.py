# SPDX-License-Identifier: MIT
"""What floods by unknown peers take from four Lua controllers: ticks per second under each flood, in percent of
those just before and just after it, in the mean of many short turns and with the standard error of that mean.

    PYTHONPATH=build/release/python:tests/scenes/disturbances python3 bench/floods.py build/release/bin/ziggurat

Each flood is a process of its own, begun anew for each turn. Two have no connection and show what the machine does by
itself: `nothing` sleeps, `wakes` computes for 0.2 ms in every 10. The server has a processor of its own and the controllers
have another one: where the system moves them about, ticks per second change twofold by themselves. `server` is its
processor time for a tick.
"""

import argparse
import contextlib
import multiprocessing
import os
import pathlib
import re
import socket
import statistics
import struct
import subprocess
import tempfile
import time

from zmtp import RawPeer, free_port
from ziggurat import protocol_pb2 as v1

SCENE = pathlib.Path(__file__).parents[1] / "tests/scenes/arms.argos"
SCRIPT = "function init() end\nfunction step() end\nfunction reset() end\nfunction destroy() end\n"


def request(number, **fields):
    return v1.ClientMessage(request=v1.Request(id=number, **fields)).SerializeToString()


def observer(endpoint):
    peer = RawPeer(endpoint)
    peer.send_message(v1.ClientMessage(hello=v1.Hello(version=v1.Version(major=1), role=v1.ROLE_OBSERVER)).SerializeToString())
    peer.receive_message()
    return peer


def nothing(endpoint, port):
    time.sleep(3600)


def wakes(endpoint, port):
    while True:
        end = time.monotonic() + 0.0002
        while time.monotonic() < end:
            pass
        time.sleep(0.01)


def observers_ask(endpoint, port, count=20):
    """Each asks again as soon as it is answered."""
    peers = [observer(endpoint) for _ in range(count)]
    for peer in peers:
        peer.send_message(request(1, read=v1.ReadRequest()))
    while True:
        for peer in peers:
            peer.receive_message()
            peer.send_message(request(1, read=v1.ReadRequest()))


def observers_never_read(endpoint, port):
    question = request(1, read=v1.ReadRequest())
    while True:
        with contextlib.suppress(OSError):
            peers = [observer(endpoint) for _ in range(20)]
            for _ in range(3000):
                for peer in peers:
                    peer.socket.setblocking(False)
                    with contextlib.suppress(BlockingIOError):
                        peer.socket.send(bytes([0, len(question)]) + question)
                time.sleep(0.01)


def garbage(endpoint, port):
    frames = (b"\x02" + struct.pack(">Q", 30_000) + bytes(30_000)) * 10
    while True:
        with contextlib.suppress(OSError), RawPeer(endpoint) as peer:
            peer.socket.settimeout(0.2)
            peer.socket.sendall(frames)


def connections(endpoint, port):
    """Half of a greeting each, 1000 at a time."""
    address = ("127.0.0.1", int(endpoint.rsplit(":", 1)[1]))
    while True:
        kept = []
        for _ in range(1000):
            with contextlib.suppress(OSError):
                kept.append(socket.create_connection(address, timeout=0.2))
                kept[-1].sendall(b"\xff\0\0\0")
        for each in kept:
            each.close()


def metrics(endpoint, port):
    while True:
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), timeout=0.5) as connection:
            connection.sendall(b"GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n")
            while connection.recv(65536):
                pass


FLOODS = (nothing, wakes, observers_ask, observers_never_read, garbage, connections, metrics)


def used(process):
    """Processor time of the server [s]."""
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def rate(process, watcher, seconds):
    """Ticks per second, and the server's processor time for a tick [us]."""
    def tick():
        watcher.send_message(request(1, status=v1.StatusRequest()))
        while True:
            message = v1.ServerMessage.FromString(watcher.receive_message())
            if message.HasField("response"):
                return message.response.tick

    first, begun, before = tick(), time.monotonic(), used(process)
    time.sleep(seconds)
    last, ended, after = tick(), time.monotonic(), used(process)
    return (last - first) / (ended - begun), 1e6 * (after - before) / max(1, last - first)


def turn(process, watcher, flood, places, seconds):
    """Ticks per second and processor time for a tick, each in proportion to what they are without the flood."""
    before = rate(process, watcher, seconds)
    attacker = multiprocessing.Process(target=flood, args=places, daemon=True)
    attacker.start()
    time.sleep(0.2)
    under = rate(process, watcher, seconds)
    attacker.kill()
    attacker.join()
    time.sleep(0.2)
    after = rate(process, watcher, seconds)
    return [2 * with_flood / (first + second) for with_flood, first, second in zip(under, before, after)]


def pin(process):
    """The server on one processor, its controllers on another."""
    first, *rest = sorted(os.sched_getaffinity(0))
    controllers = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    os.sched_setaffinity(process.pid, {first})
    for each in controllers:
        os.sched_setaffinity(int(each), {rest[0] if rest else first})


def write_scene(folder):
    """Four arms: one more than those of the tests' scene."""
    text = SCENE.read_text()
    arm = re.search(r'<prototype id="r2">.*?</prototype>', text, re.DOTALL)[0]
    arm = arm.replace('"r2"', '"r3"', 1).replace('position="0,-1,0"', 'position="-1,-1,0"', 1)
    pathlib.Path(folder, "arms.argos").write_text(text.replace("</arena>", arm + "</arena>"))
    pathlib.Path(folder, "swing.lua").write_text(SCRIPT)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("ziggurat", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=0.5, help="of each look at the ticks (default 0.5)")
    parser.add_argument("--turns", type=int, default=20, help="of each flood, at least 2 (default 20: five minutes for all)")
    options = parser.parse_args()
    if options.turns < 2:
        parser.error("--turns must be at least 2: the mean has no error otherwise")
    places = f"tcp://127.0.0.1:{free_port()}", free_port()
    with tempfile.TemporaryDirectory() as folder:
        write_scene(folder)
        process = subprocess.Popen(
            [options.ziggurat.resolve(), "run", "arms.argos", "--duration", "0", "--quiet", "--lua-processes", "4",
             "--endpoint", places[0], "--metrics", f"127.0.0.1:{places[1]}"], cwd=folder, stdout=subprocess.DEVNULL)
        try:
            time.sleep(1)
            pin(process)
            watcher = observer(places[0])
            for flood in FLOODS:
                turns = [turn(process, watcher, flood, places, options.seconds) for _ in range(options.turns)]
                ticks, costs = zip(*turns)
                error = statistics.stdev(ticks) / len(ticks) ** 0.5
                print(f"{flood.__name__:22} {100 * statistics.mean(ticks):5.1f} +- {100 * error:.1f} % of the ticks, "
                      f"median {100 * statistics.median(ticks):.0f}; server {statistics.mean(costs):.2f} times", flush=True)
        finally:
            process.terminate()
            process.wait()


if __name__ == "__main__":
    main()
