# SPDX-License-Identifier: MIT
"""Connections that are cut between a server and its controllers: the run has the states of an undisturbed one."""

import json
import socket
import subprocess
import threading

from harness import FINISHED, LUA, SceneTest, main
from waiting import wait_until

TICKS = 2000
CUTS = 6
BETWEEN_CUTS = 10_000  # [bytes]

# Each step changes the state, so a step too many or too few changes the hash.
SCRIPT = """
local steps = 0
function init() end
function step()
   steps = steps + 1
   robot.joints.shoulder.set_target(math.sin(steps))
end
"""


class Relay:
    """Between clients and a server; cut() closes all connections."""

    def __init__(self, server):
        self._server = server
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.endpoint = f"tcp://127.0.0.1:{self._listener.getsockname()[1]}"
        self._ends = []
        self.passed = 0  # bytes
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        while True:
            try:
                client, _ = self._listener.accept()
                host, port = self._server.removeprefix("tcp://").rsplit(":", 1)
                server = socket.create_connection((host, int(port)))
            except OSError:
                return
            self._ends += [client, server]
            for source, sink in ((client, server), (server, client)):
                threading.Thread(target=self._pass, args=(source, sink), daemon=True).start()

    def _pass(self, source, sink):
        try:
            while data := source.recv(1 << 16):
                self.passed += len(data)
                sink.sendall(data)
        except OSError:
            pass
        for end in (source, sink):
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass
        source.close()

    def cut(self):
        ends, self._ends = self._ends, []
        for end in ends:
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass

    def close(self):
        self._listener.close()
        self.cut()


class Reconnect(SceneTest):
    def run_with_cuts(self, *command):
        """The outcome of a run whose controllers lose their connections; how often that was done."""
        server = self.start("serve", self.scene, "--json", "--endpoint", "tcp://127.0.0.1:*", "--lease", 30,
                            "--ticks", TICKS, "--hash", "--quiet")
        relay = Relay(json.loads(server.stdout.readline())["endpoint"])
        client = subprocess.Popen([*map(str, command)], cwd=self.folder, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                  env=dict(self.environment, ZIGGURAT_ENDPOINT=relay.endpoint))
        self.started.append(client)
        cuts = 0
        while cuts < CUTS and server.poll() is None:
            before = relay.passed
            wait_until(lambda: relay.passed - before >= BETWEEN_CUTS or server.poll() is not None, "messages pass")
            relay.cut()
            cuts += 1
        outcome = self.finish(server)
        self.assertEqual(client.wait(timeout=60), 0, client.stderr.read())
        client.stderr.close()
        relay.close()
        return outcome, cuts

    def test_no_step_is_lost_or_done_twice(self):
        self.write("swing.lua", SCRIPT)
        expected = self.hash_of("--ticks", TICKS)
        outcome, cuts = self.run_with_cuts(LUA, "--quiet")
        self.assertEqual(outcome.code, FINISHED, outcome.err)
        self.assertEqual(cuts, CUTS)
        self.assertEqual(outcome.lines[-1], expected, "the states are others")


if __name__ == "__main__":
    main()
