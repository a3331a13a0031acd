"""What the share of others means for those it should protect: resets in a loop, controllers that come back at
once, and floods beside a tick of 10 ms.

    PYTHONPATH=build/release/python:tests/scenes/disturbances python3 bench/shares.py build/release/bin/ziggurat

Resets: each episode of an environment with 500 boxes is reset; then a supervisor reads, takes a snapshot and restores
it, while the same program owes the command. Returns: 64 controllers of a run lose their connection at once, with and
without --hil. Floods: a controller answers each tick after 10 ms, beside one connection that does what the line says.
"""

import argparse
import contextlib
import multiprocessing
import pathlib
import re
import socket
import statistics
import subprocess
import tempfile
import threading
import time

import ziggurat
from zmtp import RawPeer
from ziggurat import protocol_pb2 as v1

ROOT = pathlib.Path(__file__).parents[1]
SCENE = ROOT / "tests/scenes/arms.argos"
FOOT_BOT = ROOT / "clients/python/examples/avoid.argos"
PING = b"\x04\x07\x04PING\0\0"


def write_scene(folder, robots, boxes):
    """So many arms with an external controller, and boxes that lie on the floor."""
    text = SCENE.read_text().replace("lua_controller", "external_controller").replace(' script="swing.lua"', "")
    arms = re.findall(r'<prototype id="r\d">.*?</prototype>', text, re.DOTALL)
    for arm in arms[1:]:
        text = text.replace(arm, "")
    more = "".join(arms[0].replace('"r0"', f'"r{i}"').replace('position="0,0,0" orientation="0,0,0" />',
                                                             f'position="{i % 8},{i // 8},0" orientation="0,0,0" />', 1)
                   for i in range(1, robots))
    more += "".join(f'<box id="b{i}" size="0.1,0.1,0.1" movable="true" mass="1">'
                    f'<body position="{-1 - 0.2 * (i % 25)},{-1 - 0.2 * (i // 25)},0" orientation="0,0,0" /></box>'
                    for i in range(boxes))
    text = text.replace('<arena size="4,4,1"', '<arena size="40,40,2"').replace("</arena>", more + "</arena>")
    path = pathlib.Path(folder, "scene.argos")
    path.write_text(text)
    return path


def write_foot_bots(folder, count=64):
    text = FOOT_BOT.read_text()
    bot = re.search(r'<foot-bot id="fb">.*?</foot-bot>', text, re.DOTALL)[0]
    bots = "".join(bot.replace('"fb"', f'"r{i}"').replace("-0.6,-0.9,0", f"{3 + i % 8},{i // 8},0") for i in range(count))
    path = pathlib.Path(folder, "bots.argos")
    path.write_text(text.replace(bot, bots).replace('size="4,4,1"', 'size="40,40,1"'))
    return path


@contextlib.contextmanager
def server(program, scene, *options):
    with subprocess.Popen([program, "serve", scene, "--endpoint", "tcp://127.0.0.1:*", "--duration", "0", "--quiet", *options],
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
        try:
            yield process.stdout.readline().split()[1]
        finally:
            process.kill()


def timed(action):
    begin = time.monotonic()
    result = action()
    return 1e3 * (time.monotonic() - begin), result


def resets(program, folder, boxes=500, count=40):
    scene = write_scene(folder, 1, boxes)
    with contextlib.closing(ziggurat.parallel_env(str(scene), command=str(program))) as env:
        env.reset(seed=1)
        env.step({})
        time.sleep(0.5)
        times = []
        for seed in range(1, count + 1):
            times.append(timed(lambda: env.reset(seed=seed))[0])
            env.step({})
        print(f"reset, {boxes} boxes: first {times[0]:.1f} ms, median in a loop {statistics.median(times):.1f} ms, "
              f"longest {max(times):.1f} ms", flush=True)
        supervisor = ziggurat.Supervisor(env.session.endpoint)
        for name, action in (("read", lambda: supervisor.read("b1*")), ("snapshot", lambda: supervisor.snapshot("s"))):
            times = [timed(action)[0] for _ in range(count)]
            print(f"{name} while the command is owed: first {times[0]:.2f} ms, median {statistics.median(times):.2f} ms, "
                  f"longest {max(times):.2f} ms")
        times = []
        for _ in range(count):
            times.append(timed(lambda: supervisor.restore("s"))[0])
            env.session.expect_reset()
            next(env.session)
        print(f"restore likewise: first {times[0]:.2f} ms, median {statistics.median(times):.2f} ms, longest {max(times):.2f} ms", flush=True)


class Controller:
    """Answers each tick on a thread of its own, and comes back when it is cut off."""

    def __init__(self, endpoint, robot, deadline=None):
        self.endpoint, self.robot, self.deadline, self.token = endpoint, robot, deadline, b""
        self.back = threading.Event()
        self.is_over = self.is_refused = False
        self.join()
        threading.Thread(target=self.answer, daemon=True).start()

    def join(self):
        peer = RawPeer(self.endpoint)
        hello = v1.Hello(version=v1.Version(major=1), role=v1.ROLE_CONTROLLER, robots=[self.robot], deadline_policy=self.deadline)
        if self.token:
            hello.session_token = self.token
        peer.send_message(v1.ClientMessage(hello=hello).SerializeToString())
        while True:
            message = v1.ServerMessage.FromString(peer.receive_message())
            if message.HasField("welcome"):
                self.peer, self.token = peer, message.welcome.session_token
                return self.back.set()
            self.is_refused |= message.HasField("refusal")

    def answer(self):
        while not self.is_over:
            try:
                message = v1.ServerMessage.FromString(self.peer.receive_message())
                if message.HasField("observation"):
                    command = v1.Command(tick=message.observation.tick)
                    self.peer.send_message(v1.ClientMessage(command=command).SerializeToString())
            except OSError:
                if not self.is_over:
                    self.join()

    def cut(self):
        self.back.clear()
        self.peer.socket.shutdown(socket.SHUT_RDWR)


def returns(program, folder, *options):
    with server(program, write_foot_bots(folder), "--lease", "60", *options) as endpoint:
        controllers = [Controller(endpoint, f"r{i}") for i in range(64)]
        time.sleep(1)
        begin = time.monotonic()
        for each in controllers:
            each.cut()
        back = sum(each.back.wait(max(0.01, begin + 20 - time.monotonic())) for each in controllers)
        seconds = time.monotonic() - begin
        time.sleep(0.5)
        with ziggurat.Supervisor(endpoint) as supervisor:
            gone = len(supervisor.status().gone_robots)
        for each in controllers:
            each.is_over = True
        print(f"{' '.join(options) or 'no options':30} {back} of 64 came back in {seconds:.2f} s, {gone} are gone", flush=True)


def raw(endpoint):
    host, port = endpoint.removeprefix("tcp://").rsplit(":", 1)
    return socket.create_connection((host, int(port)))


def send_without_end(peer, data):
    """And reads the answers, so that it is not closed for not reading."""
    def read():
        with contextlib.suppress(OSError):
            while peer.recv(1 << 20):
                pass
    threading.Thread(target=read, daemon=True).start()
    with contextlib.suppress(OSError):
        while True:
            peer.sendall(data)


def nothing(endpoint):
    time.sleep(3600)


def pings(endpoint):
    send_without_end(RawPeer(endpoint).socket, PING * 10_000)


def pings_of_a_controller(endpoint):
    """Which answers no tick: each goes on without it after 5 ms."""
    hold = v1.DeadlinePolicy(action=v1.DeadlinePolicy.HOLD, wall_deadline_ms=5)
    controller = Controller(endpoint, "r1", hold)
    controller.is_over = True
    send_without_end(controller.peer.socket, PING * 10_000)


def frames_without_end(endpoint):
    send_without_end(RawPeer(endpoint).socket, b"\x01\x01x" * 10_000)


def greetings(endpoint):
    while True:
        with contextlib.suppress(OSError), raw(endpoint) as peer:
            peer.sendall(b"\xff" + bytes(7) + b"\x01\x7f\x03\x01" + b"NULL".ljust(52, b"\0"))


def observers(endpoint):
    peers = [RawPeer(endpoint) for _ in range(10)]
    for peer in peers:
        hello = v1.Hello(version=v1.Version(major=1), role=v1.ROLE_OBSERVER)
        peer.send_message(v1.ClientMessage(hello=hello).SerializeToString())
        peer.receive_message()
    question = v1.ClientMessage(request=v1.Request(id=1, read=v1.ReadRequest())).SerializeToString()
    while True:
        for peer in peers:
            peer.send_message(question)
        for peer in peers:
            peer.receive_message()


FLOODS = (nothing, pings, pings_of_a_controller, frames_without_end, greetings, observers)


def floods(program, folder, seconds=3):
    for flood in FLOODS:
        scene = write_scene(folder, 1 + (flood is pings_of_a_controller), 0)
        with server(program, scene) as endpoint:
            attacker = multiprocessing.Process(target=flood, args=(endpoint,), daemon=True)
            with ziggurat.connect(endpoint, robots=["r0"]) as session:
                attacker.start()
                time.sleep(0.5)
                intervals, last, end = [], time.monotonic(), time.monotonic() + seconds
                for _ in session:  # the answer is sent when the next tick is asked for
                    now = time.monotonic()
                    intervals.append(1e3 * (now - last))
                    last = now
                    if now > end:
                        break
                    time.sleep(0.010)
            attacker.kill()
            attacker.join()
            intervals = intervals[1:] or [float("inf")]
            print(f"{flood.__name__:26} a tick takes {statistics.median(intervals):6.1f} ms in the median, "
                  f"{max(intervals):6.1f} ms at most", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("ziggurat", type=pathlib.Path)
    parser.add_argument("what", nargs="*", default=["resets", "returns", "floods"])
    options = parser.parse_args()
    program = options.ziggurat.resolve()
    with tempfile.TemporaryDirectory() as folder:
        if "resets" in options.what:
            resets(program, folder)
        if "returns" in options.what:
            for arguments in ((), ("--hil",), ("--hil", "--deadline", "drop:40:5")):
                returns(program, folder, *arguments)
        if "floods" in options.what:
            floods(program, folder)


if __name__ == "__main__":
    main()
