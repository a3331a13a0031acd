# SPDX-License-Identifier: MIT
"""A server that runs for long: ticks, sessions that come and leave or vanish, spawns and resets. Its memory
stays what it was.

endurance_test.py         some seconds
endurance_test.py --full  a million ticks and 10 000 sessions, about ten minutes
"""

import ctypes
import os
import pathlib
import re
import subprocess
import sys
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from harness import INTERRUPTED, LUA, SceneTest  # noqa: E402
from zmtp import RawPeer  # noqa: E402
from ziggurat import protocol_pb2 as v1  # noqa: E402

IS_FULL = "--full" in sys.argv
TICKS, SESSIONS = (1_000_000, 10_000) if IS_FULL else (5_000, 400)
BETWEEN_RESETS = 100  # sessions
# [KiB] from a fifth of the run on. The allocator's pages are reused in another order each time: a few hundred
# of it come and go. Less than 500 bytes of each session of a full run.
MOST_GROWTH = 4096 if IS_FULL else 8192

PR_SET_THP_DISABLE = 41  # <linux/prctl.h>

GUEST = """<external_controller id="guest" deadline="hold" deadline_ms="1"><actuators>
<joints implementation="default"><joint id="shoulder" mode="velocity" max_impulse="0.01"/></joints></actuators>
<sensors><joints implementation="default"><joint id="shoulder" mode="velocity"/></joints></sensors>
</external_controller>"""


def disable_huge_pages():
    """In the child process. A huge page of 2 MiB would hide what is measured."""
    ctypes.CDLL(None).prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0)


def message(**kind):
    return v1.ClientMessage(**kind).SerializeToString()


def hello(role, **fields):
    return message(hello=v1.Hello(version=v1.Version(major=1, minor=1), role=role, **fields))


class Endurance(SceneTest):
    def setUp(self):
        super().setUp()
        [first] = re.findall(r'<prototype id="r0">.*?</prototype>', self.text, re.DOTALL)
        self.robot = (first.replace('config="swing"', 'config="guest"')
                      .replace('position="0,0,0"', 'position="1.5,0,0"', 1))
        self.change("</controllers>", GUEST + "</controllers>")
        self.change("</arena>", self.robot.replace('"r0"', '"guest0"') + "</arena>")
        self.write("swing.lua", "function init() end\nfunction step() end\n"
                                "function reset() end\nfunction destroy() end\n")

    def hear(self, peer, *kinds):
        """The next message of one of these kinds; skips others."""
        while True:
            heard = v1.ServerMessage.FromString(peer.receive_message())
            if heard.WhichOneof("message") in kinds:
                return getattr(heard, heard.WhichOneof("message"))

    def ask(self, peer, **request):
        peer.send_message(message(request=v1.Request(id=1, **request)))
        return self.hear(peer, "response")

    def begin(self, peer, role, **fields):
        peer.send_message(hello(role, **fields))
        return self.hear(peer, "welcome", "refusal")

    # ---- sessions ----

    def polite(self, peer):
        self.begin(peer, v1.ROLE_SUPERVISOR, client_name="polite")
        self.ask(peer, status=v1.StatusRequest())
        peer.send_message(message(leave=v1.Leave(reason=v1.Leave.DONE)))

    def vanishing_observer(self, peer):
        self.begin(peer, v1.ROLE_OBSERVER)
        for _ in range(20):
            peer.send_message(message(request=v1.Request(id=1, read=v1.ReadRequest(entities=["*"]))))

    def drive(self, peer, ticks):
        for _ in range(ticks):
            observation = self.hear(peer, "observation", "end", "displaced")
            if not isinstance(observation, v1.Observation):
                return
            peer.send_message(message(command=v1.Command(
                tick=observation.tick, joint_targets=[0.5], log=[v1.LogLine(text="here")])))

    def vanishing_controller(self, peer):
        if isinstance(self.begin(peer, v1.ROLE_CONTROLLER, robots=["guest0"], takeover=True), v1.Welcome):
            self.drive(peer, 5)

    def returning_controller(self, peer):
        welcome = self.begin(peer, v1.ROLE_CONTROLLER, robots=["guest0"], takeover=True)
        self.drive(peer, 2)
        with RawPeer(self.endpoint) as again:
            self.begin(again, v1.ROLE_CONTROLLER, session_token=welcome.session_token)
            self.drive(again, 2)

    def nonsense(self, peer):
        peer.send_message(b"\xff" * 1000)
        self.hear(peer, "error")
        peer.send_half(hello(v1.ROLE_CONTROLLER, robots=["*"]))

    def box(self, peer):
        self.begin(peer, v1.ROLE_SUPERVISOR)
        xml = ('<box id="late" size="0.1,0.1,0.1" movable="true" mass="1"><body position="0.6,0.6,1"/></box>')
        self.assertFalse(self.ask(peer, spawn=v1.SpawnRequest(xml=xml)).HasField("error"))
        self.ask(peer, read=v1.ReadRequest(entities=["late"]))
        self.assertFalse(self.ask(peer, remove=v1.RemoveRequest(entity="late")).HasField("error"))

    def robot_of_a_guest(self, peer):
        self.begin(peer, v1.ROLE_SUPERVISOR)
        xml = self.robot.replace('"r0"', '"late"').replace("1.5,0,0", "1.5,1,0")
        self.assertFalse(self.ask(peer, spawn=v1.SpawnRequest(xml=xml)).HasField("error"))
        with RawPeer(self.endpoint) as driver:
            welcome = self.begin(driver, v1.ROLE_CONTROLLER, robots=["late"])
            self.assertIsInstance(welcome, v1.Welcome, welcome)
            self.drive(driver, 3)
            driver.send_message(message(leave=v1.Leave(reason=v1.Leave.DONE)))
        self.assertFalse(self.ask(peer, remove=v1.RemoveRequest(entity="late")).HasField("error"))

    def in_json(self, peer):
        peer.send_message(b'{"hello":{"version":{"major":1},"role":"ROLE_OBSERVER"}}')
        peer.receive_message()
        peer.send_message(b'{"request":{"id":"1","read":{"entities":["*"]}}}')
        peer.receive_message()

    KINDS = (polite, vanishing_observer, vanishing_controller, returning_controller, nonsense, box,
             robot_of_a_guest, in_json)

    # ---- the run ----

    def measure(self, process):
        """Open files, and memory [KiB]."""
        status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
        return len(os.listdir(f"/proc/{process.pid}/fd")), int(re.search(r"VmRSS:\s*(\d+)", status)[1])

    def test_memory_stays_what_it_was(self):
        process = self.start("serve", self.scene, "--endpoint", "tcp://127.0.0.1:*", "--quiet",
                             "--duration", 0, stderr=subprocess.DEVNULL,
                             limit=7200 if IS_FULL else 250, preexec_fn=disable_huge_pages)
        self.endpoint = process.stdout.readline().split()[1]
        self.started.append(subprocess.Popen(
            [str(LUA), "--connect", self.endpoint, "--controller", "swing", "--quiet"], cwd=self.folder,
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        watcher = RawPeer(self.endpoint)
        self.begin(watcher, v1.ROLE_SUPERVISOR)
        self.begin_ticks()
        ticks = sessions = resets = 0
        first = None
        while ticks + self.tick(watcher) < TICKS or sessions < SESSIONS:
            if sessions < SESSIONS:
                with RawPeer(self.endpoint) as peer:
                    self.KINDS[sessions % len(self.KINDS)](self, peer)
                sessions += 1
            else:
                time.sleep(0.05)  # so often it is asked
            if sessions % BETWEEN_RESETS == 0 and sessions < SESSIONS:
                ticks += self.tick(watcher)
                resets += 1
                self.assertFalse(self.ask(watcher, reset=v1.ResetRequest()).HasField("error"))
                self.begin_ticks()
            if first is None and sessions >= SESSIONS / 5:
                first = self.measure(process)
        ticks += self.tick(watcher)
        files, memory = self.measure(process)
        print(f"  {ticks} ticks, {sessions} sessions, {resets} resets, {sessions // 4} spawns: "
              f"{first[1]} KiB after a fifth, {memory} KiB at the end; {files} files", flush=True)
        self.assertLess(memory - first[1], MOST_GROWTH)
        self.assertLess(files, first[0] + 20)
        watcher.socket.close()
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)

    def begin_ticks(self):
        """Tick 0 waits for all robots."""
        with RawPeer(self.endpoint) as peer:
            self.vanishing_controller(peer)

    def tick(self, watcher):
        return self.ask(watcher, status=v1.StatusRequest()).tick


if __name__ == "__main__":
    sys.argv = [each for each in sys.argv if each != "--full"]
    unittest.main(verbosity=2, warnings="ignore")
