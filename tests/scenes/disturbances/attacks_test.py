# SPDX-License-Identifier: MIT
"""Hostile requests and servers, each against the real program: a sentence, and it goes on."""

import os
import pathlib
import random
import socket
import subprocess
import sys
import threading
import time
import unittest

import zmq

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from harness import FAULT, FINISHED, INTERRUPTED, LUA, SceneTest, ZIGGURAT  # noqa: E402
from zmtp import RawPeer  # noqa: E402
from ziggurat import protocol_pb2 as v1  # noqa: E402

BOX = ('<box id="{}" size="0.1,0.1,0.1" movable="true" mass="1"><body position="{}" orientation="0,0,0"/></box>')


class Supervisor(RawPeer):
    """A supervisor's session over tcp."""

    def __init__(self, endpoint, name="supervisor"):
        super().__init__(endpoint)
        self.number = 0
        self.send_message(v1.ClientMessage(hello=v1.Hello(
            version=v1.Version(major=1, minor=2), role=v1.ROLE_SUPERVISOR, client_name=name)).SerializeToString())
        self.answer("welcome")

    def answer(self, kind):
        while True:
            message = v1.ServerMessage.FromString(self.receive_message())
            if message.WhichOneof("message") == kind:
                return getattr(message, kind)

    def ask(self, **request):
        """The message of the error, or an empty text."""
        self.number += 1
        self.send_message(v1.ClientMessage(request=v1.Request(id=self.number, **request)).SerializeToString())
        return self.answer("response").error.message


class Attacks(SceneTest):
    def serve(self, *options, **process_options):
        process = self.start("serve", self.scene, "--endpoint", "tcp://127.0.0.1:*", "--ticks", 0, "--paused",
                             *options, **process_options)
        self.endpoint = process.stdout.readline().split()[1]
        return process

    def end(self, process):
        """It is there still, and ends as it is told."""
        self.assertIsNone(process.poll())
        self.interrupt(process)
        outcome = self.finish(process)
        self.assertEqual(outcome.code, INTERRUPTED, outcome.err)
        self.assert_is_sentence(outcome, ".|^$")
        return outcome

    # --- the network ----------------------------------------------------------------------------

    def test_a_path_has_the_permissions_of_the_umask(self):
        path = self.folder / "socket"
        process = self.start("serve", self.scene, "--endpoint", f"ipc://{path}", "--ticks", 0, "--paused",
                             preexec_fn=lambda: os.umask(0o077))
        process.stdout.readline()
        self.assertEqual(path.stat().st_mode & 0o077, 0)
        self.end(process)

    def test_hostile_spawns(self):
        process = self.serve()
        with Supervisor(self.endpoint, name="\x1b]52;c;aGk=\x07\u202eoperator") as supervisor:
            for xml in ("<a>" * 100_000, "<a>" * 100_000 + "</a>" * 100_000, "<!--" + "-" * 100_000, "",
                        '<box id="n" ' + 'x="1" ' * 100_000 + "/>",
                        '<!DOCTYPE x [<!ENTITY a SYSTEM "file:///etc/passwd">]><box id="&a;"/>',
                        BOX.format("\x1b]0;x", "0,0.8,0.5"), BOX.format("b", "inf,0,0"),
                        BOX.format("b", "1e300,0,0"), BOX.format("b", "0,0,2") * 2,
                        '<distribute><entity quantity="100000"/></distribute>',
                        '<include href="/etc/passwd"/>', BOX.format("b", "0,0,2").replace("0.1", "1e-300"),
                        BOX.format("b", "0,0,2").replace('"1"', '"1e999"')):
                told = supervisor.ask(spawn=v1.SpawnRequest(xml=xml))
                self.assertTrue(told, xml[:60])
                self.assertNotIn("root:", told)
            large = BOX.format("large", "0.8,0.8,0.5") + " " * (1 << 20)
            self.assertIn("at most 1048576 are allowed", supervisor.ask(spawn=v1.SpawnRequest(xml=large)))
            for position in ([float("nan"), 0, 0], [1e308, 0, 0], [0] * 2, [0] * 100_000):
                self.assertTrue(supervisor.ask(move=v1.MoveRequest(entity="r0", position=position)))
            self.assertEqual(supervisor.ask(spawn=v1.SpawnRequest(xml=BOX.format("good", "0.8,0.8,0.5"))), "")
        outcome = self.end(process)
        self.assertNotRegex(outcome.err, "[\x00-\x08\x0b-\x1f\x7f-\x9f\u202e]")

    def test_hostile_snapshots(self):
        folder = self.folder / "kept"
        folder.mkdir()
        process = self.serve("--snapshot-folder", folder)
        with Supervisor(self.endpoint) as supervisor:
            for name in ("../x", "..", "", "a/b", "x" * 65, "a\n", "/etc/passwd"):
                self.assertTrue(supervisor.ask(snapshot=v1.SnapshotRequest(name=name)), name)
            self.assertEqual(supervisor.ask(snapshot=v1.SnapshotRequest(name="good")), "")
            [kept] = folder.iterdir()
        self.end(process)
        data = kept.read_bytes()
        draw = random.Random(6)
        hostile = {"cut": data[:len(data) // 2], "none": b"", "long": data * 2, "full": data[:40] + b"\xff" * 4096}
        for number in range(20):
            flipped = bytearray(data)
            flipped[draw.randrange(len(data))] ^= 1 << draw.randrange(8)
            hostile[f"flipped{number}"] = bytes(flipped)
        for name, content in hostile.items():
            (folder / kept.name.replace("good", name)).write_bytes(content)
        os.mkfifo(folder / kept.name.replace("good", "pipe"))
        (folder / kept.name.replace("good", "link")).symlink_to("/etc/passwd")
        process = self.serve("--snapshot-folder", folder)
        with Supervisor(self.endpoint) as supervisor:
            for name in (*hostile, "pipe", "link", "../good"):
                self.assertTrue(supervisor.ask(restore=v1.RestoreRequest(name=name)), name)
            self.assertEqual(supervisor.ask(restore=v1.RestoreRequest(name="good")), "")
        self.end(process)

    # --- HTTP -----------------------------------------------------------------------------------

    def ask_port(self, port, request):
        with socket.create_connection(("127.0.0.1", port), timeout=60) as connection:
            answer = b""
            try:
                connection.sendall(request)
                connection.shutdown(socket.SHUT_WR)
                while part := connection.recv(65536):
                    answer += part
            except OSError:  # closed before it has read all
                pass
            return answer.decode(errors="replace")

    def test_hostile_requests(self):
        process = self.serve("--metrics", "127.0.0.1:0", "--view=127.0.0.1:0")
        view = int(self.read_until(process.stderr, r"watch this run at http://127\.0\.0\.1:(\d+)/")[1])
        metrics = int(self.read_until(process.stderr, r"metrics at http://127\.0\.0\.1:(\d+)")[1])

        def request(line, *headers, host="localhost"):
            return "\r\n".join([line, f"Host: {host}", *headers, "", ""]).encode()

        for port in (metrics, view):
            for host in ("localhost.evil.example", "127.0.0.1.evil.example", "localhost@evil.example", "evil.example"):
                self.assertRegex(self.ask_port(port, request("GET / HTTP/1.1", host=host)), "^HTTP/1.1 403", host)
            for path in ("/../../../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd",
                         "/..\\..\\etc/passwd", "/index.html%00.js", "/%0d%0aSet-Cookie:a=b", "/<script>x</script>",
                         "http://evil.example/metrics"):
                answer = self.ask_port(port, request(f"GET {path} HTTP/1.1"))
                self.assertRegex(answer, "^HTTP/1.1 40[04]", path)
                self.assertNotRegex(answer, "root:|Set-Cookie|<script>")
            for hostile in (request("POST /metrics HTTP/1.1", "Content-Length: 3"), request("TRACE / HTTP/1.1"),
                            request("CONNECT evil.example:443 HTTP/1.1"), b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
                            request("GET /" + "a" * 100_000 + " HTTP/1.1"), b"\x16\x03\x01\x02\0" + b"a" * 500,
                            request("GET / HTTP/1.1", *["a: b"] * 3000), request("GET / HTTP/1.1", "Content-Length: -1"),
                            request("GET / HTTP/1.1", "Content-Length: 5", "Transfer-Encoding: chunked")):
                self.assertRegex(self.ask_port(port, hostile), "^(HTTP/1.1 4|$)", hostile[:60])
        self.assertRegex(self.ask_port(metrics, request("GET /metrics HTTP/1.1")), "^HTTP/1.1 200")
        page = self.ask_port(view, request("GET / HTTP/1.1"))
        self.assertRegex(page, r"(?i)Content-Security-Policy: [^\r]*default-src '(none|self)'")
        self.end(process)

    # --- servers --------------------------------------------------------------------------------

    def test_texts_of_other_clients_are_printable(self):
        """`top` and `ctl` at a server where one calls itself by escape sequences."""
        process = self.serve()
        name = "me\x1b]52;c;aGk=\x07\u009b31m\u202e"
        with RawPeer(self.endpoint) as controller:
            controller.send_message(v1.ClientMessage(hello=v1.Hello(
                version=v1.Version(major=1, minor=2), role=v1.ROLE_CONTROLLER, client_name=name,
                robots=["r0"])).SerializeToString())
            controller.receive_message()
            for words in (("top", self.endpoint, "--once"), ("ctl", self.endpoint, "status")):
                outcome = self.ziggurat(*words)
                self.assertEqual(outcome.code, FINISHED, outcome.err)
                self.assertIn("52;c;aGk=", outcome.out)
                self.assertNotRegex(outcome.err + outcome.out, "[\x00-\x08\x0b-\x1f\x7f-\x9f\u202e]")
        self.end(process)

    def test_texts_of_a_server_are_printable(self):
        """`ctl`, `top` and `ziggurat-lua` at a server that answers with escape sequences."""
        router = zmq.Context.instance().socket(zmq.ROUTER)
        port = router.bind_to_random_port("tcp://127.0.0.1")

        def serve():
            refusal = v1.ServerMessage(refusal=v1.Refusal(error=v1.Error(
                code=v1.Error.FORBIDDEN, message="no\x1b]52;c;aGk=\x07\u009b31m\u202ewon\nziggurat: all is well")))
            for _ in commands:
                if router.poll(20_000):
                    client, _ = router.recv_multipart()
                    router.send_multipart([client, refusal.SerializeToString()])

        endpoint = f"tcp://127.0.0.1:{port}"
        commands = [(ZIGGURAT, "ctl", endpoint, "status"), (ZIGGURAT, "top", endpoint, "--once"),
                    (LUA, "--connect", endpoint, "--script", "swing.lua"),
                    (LUA, "--connect", endpoint, "--script", "swing.lua", "--trust-scripts"),
                    (LUA, "--connect", endpoint, "--director", "d", "--script", "swing.lua", "--trust-scripts")]
        server = threading.Thread(target=serve)
        server.start()
        for words in commands:
            with self.subTest(words):
                outcome = subprocess.run([str(word) for word in words], cwd=self.folder, env=self.environment,
                                         stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60)
                self.assertEqual(outcome.returncode, FAULT)
                self.assertIn("\\u001b]52", outcome.stderr)
                self.assertNotRegex(outcome.stderr + outcome.stdout, "[\x00-\x08\x0b-\x1f\x7f-\x9f\u202e]")
                self.assertIn("all is well", outcome.stderr)
                self.assertNotRegex(outcome.stderr, "(?m)^ziggurat: all is well")
        server.join()
        router.close(linger=0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
