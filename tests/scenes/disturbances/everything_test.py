# SPDX-License-Identifier: MIT
"""Everything at once: viewers, recorder, metrics port, director, supervisor, snapshots, resets, Ctrl-C. The
recording repeats the run. By the thread sanitizer's build (docs/testing.md) it finds what threads share.

everything_test.py         3 s
everything_test.py --full  a minute
"""

import collections
import contextlib
import json
import pathlib
import random
import signal
import subprocess
import sys
import threading
import time
import unittest
import urllib.request
from unittest import mock

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import ziggurat  # noqa: E402
from harness import INTERRUPTED, LUA, SceneTest  # noqa: E402
from waiting import wait_until  # noqa: E402
from websocket import MOVE, PAUSE, RawViewer, REMOVE, RESUME, SPAWN, SPEED, STEP  # noqa: E402
from zmtp import free_port  # noqa: E402

SECONDS = 60 if "--full" in sys.argv else 3
BOX = '<box id="{}" size="0.1,0.1,0.1" movable="true" mass="1"><body position="{},{},1" orientation="0,0,0"/></box>'


def box(draw, name):
    return BOX.format(name, draw.uniform(-1, 1), draw.uniform(-1, 1))


class Everything(SceneTest):
    def test_at_once_is_repeated(self):
        self.endpoint, self.metrics_port = f"ipc://{self.folder}/e", free_port()
        (self.folder / "kept").mkdir()
        process = self.start(
            "run", self.scene, "--duration", 0, "--quiet", "--lua-processes", 2, "--real-time", 20,
            "--view=127.0.0.1:0", "--record", "run.mcap", "--metrics", f"127.0.0.1:{self.metrics_port}",
            "--endpoint", self.endpoint, "--allow-director", "--trace", "t.csv", "--hash-file", "hashes",
            "--readings", "r.jsonl", "--snapshot-folder", "kept", "--report-card", "card.json")
        found = self.read_until(process.stderr, r"http://127\.0\.0\.1:(\d+)/\?token=(\S+)")
        self.viewers_at = int(found[1]), found[2]
        self.over = threading.Event()
        self.done = collections.Counter()
        threads = [threading.Thread(target=self.again_and_again, args=(target, seed), daemon=True)
                   for seed, target in enumerate([self.view, self.view, self.view, self.supervise, self.direct,
                                                  self.ask_metrics])]
        for thread in threads:
            thread.start()
        time.sleep(SECONDS)  # elapsed time is the subject: all act at random
        self.wait_for(lambda: (dict(self.done), self.ticks()), lambda seen: len(seen[0]) == 4 and seen[1] > 10,
                      "act of each client")
        self.interrupt(process)
        outcome = self.finish(process)
        self.over.set()
        for thread in threads:
            thread.join()
        self.assertEqual(outcome.code, INTERRUPTED, outcome.err)
        outcome = self.ziggurat("verify", "run.mcap")
        self.assertEqual(outcome.code, 0, outcome.out + outcome.err)

    def ticks(self):
        hashes = self.folder / "hashes"
        return len(hashes.read_text().splitlines()) if hashes.exists() else 0

    def again_and_again(self, target, seed):
        """Until it is over: connections end in any way."""
        draw = random.Random(seed)
        while not self.over.is_set():
            with contextlib.suppress(ziggurat.ZigguratError, OSError, ValueError, KeyError):
                target(draw)

    def view(self, draw):
        """All channels, and calls of services, then another connection."""
        with RawViewer(*self.viewers_at) as viewer:
            viewer.socket.settimeout(2)
            channels = viewer.hear_operation("advertise")["channels"]
            for number, channel in enumerate(channels):
                viewer.say(op="subscribe", subscriptions=[{"id": number + 1, "channelId": channel["id"]}])
            calls = {PAUSE: {}, RESUME: {}, STEP: {"ticks": 2}, SPEED: {"factor": 20}, REMOVE: {"entity": "v"},
                     MOVE: {"entity": "r0", "position": [0, 0, 1]}, SPAWN: {"xml": box(draw, f"v{draw.randrange(9)}")}}
            for number in range(draw.randrange(100)):
                viewer.hear()
                if number % 10 == 0:
                    service = draw.choice([*calls, RESUME, RESUME])
                    viewer.call(service, number, json.dumps(calls[service]).encode())
                    self.done["view"] += 1
                    viewer.say(op="unsubscribe", subscriptionIds=[1 + number % len(channels)])

    def supervise(self, draw):
        with ziggurat.supervise(self.endpoint, connect_timeout=2, wait_timeout=5) as supervisor:
            while not self.over.is_set():
                act = draw.choice([
                    lambda: supervisor.spawn(box(draw, f"s{draw.randrange(9)}")), supervisor.status,
                    lambda: supervisor.remove(f"s{draw.randrange(9)}"), lambda: supervisor.move("r1", (0, 1, 0.5)),
                    lambda: supervisor.snapshot("a"), lambda: supervisor.restore("a"), supervisor.resume,
                    lambda: supervisor.reset() if draw.random() < 0.1 else supervisor.resume()])
                with contextlib.suppress(ziggurat.ProtocolError):
                    act()
                    self.done["supervise"] += 1
                time.sleep(0.01)  # so often it acts

    def direct(self, draw):
        with ziggurat.direct("d", self.endpoint, tell=("poses", "links", "joints", "contacts"), takeover=True,
                             can_restore=True, connect_timeout=2, wait_timeout=5) as world:
            for tick in world:
                if "r0" in world.entities:
                    world.entities["r0"].push(force=(draw.random(), 0, 0))
                world.metric("tick", tick.number)
                self.done["direct"] += 1
                if draw.random() < 0.001:
                    return world.abandon()

    def ask_metrics(self, draw):
        path = draw.choice(["metrics", "status"])
        urllib.request.urlopen(f"http://127.0.0.1:{self.metrics_port}/{path}", timeout=5).read()
        self.done["metrics"] += 1
        time.sleep(0.05)  # so often it asks


class TwoSupervisors(SceneTest):
    def test_a_snapshot_that_meets_a_restore_of_its_name_is_repeated(self):
        """Both arrive while the server stands, so that it sees them at once."""
        process = self.start("serve", self.scene, "--json", "--record", "run.mcap", "--ticks", 5)
        url = json.loads(process.stdout.readline())["endpoint"]
        with ziggurat.supervise(url) as one, ziggurat.supervise(url) as other:
            one.move("r1", (0, 1, 0.5))
            one.snapshot("a")
            one.move("r1", (0.2, 1, 0.5))
            process.send_signal(signal.SIGSTOP)
            threads = [threading.Thread(target=act, args=("a",)) for act in (one.restore, other.snapshot)]
            for client, thread in zip((one, other), threads):
                with mock.patch.object(client._connection, "receive", side_effect=client._connection.receive) as receive:
                    thread.start()
                    wait_until(lambda: receive.called, "it has sent, and waits for the answer")
            process.send_signal(signal.SIGCONT)
            for thread in threads:
                thread.join()
        subprocess.run([LUA, "--connect", url, "--quiet"], cwd=self.folder, env=self.environment)
        self.assertEqual(self.finish(process).code, 0)
        outcome = self.ziggurat("verify", "run.mcap")
        self.assertEqual(outcome.code, 0, outcome.out + outcome.err)


if __name__ == "__main__":
    sys.argv = [each for each in sys.argv if each != "--full"]
    unittest.main(verbosity=2, warnings="ignore")
