# SPDX-License-Identifier: MIT
"""Hostile viewers at the port of --view: the world, and a viewer with the token, go on; memory is bounded."""

import json
import pathlib
import re
import socket
import sys
import time
import unittest
import urllib.request

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from harness import INTERRUPTED, SceneTest  # noqa: E402
from websocket import (  # noqa: E402
    BINARY, CLOSE, frame, handshake, MOVE, PING, RawViewer, REMOVE, RESUME, SPAWN, SPEED, STEP, TEXT)

MOST_GROWTH = 64  # [MiB] of the server's memory at any time, whatever viewers do
BOX = '<box id="{}" size="0.1,0.1,0.1" movable="true" mass="1"><body position="{}" orientation="0,0,0"/></box>'


class HostileViewers(SceneTest):
    def setUp(self):
        super().setUp()
        self.write("swing.lua", "function init() end function step() end")
        self.process = self.start("run", self.scene, "--quiet", "--duration", 0, "--view=127.0.0.1:0")
        found = self.read_until(self.process.stderr, r"http://127\.0\.0\.1:(\d+)/\?token=(\S+)")
        self.port, self.token = int(found[1]), found[2]
        self.good = RawViewer(self.port, self.token)
        channels = self.good.hear_operation("advertise")["channels"]
        self.channels = {each["topic"]: each["id"] for each in channels}
        self.good.say(op="subscribe", subscriptions=[{"id": 1, "channelId": self.channels["/poses"]}])
        self.hear_tick()
        self.before = self.memory("VmRSS")

    def memory(self, what="VmHWM"):
        """[MiB]"""
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(rf"{what}:\s*(\d+)", status)[1]) / 1024

    def hear_tick(self):
        while self.good.hear()[0] != BINARY:
            pass

    def assert_unharmed(self):
        """New ticks come to the good viewer, which also still steers, and memory has stayed bounded."""
        self.good.call(SPEED, 77, b'{"factor": 1}')
        self.assertTrue(self.good.hear_answer(77)[0])
        for _ in range(3):
            self.hear_tick()
        self.assertLess(self.memory() - self.before, MOST_GROWTH)
        self.good.socket.close()
        self.assertIsNone(self.process.poll())
        self.interrupt(self.process)
        self.assertEqual(self.finish(self.process).code, INTERRUPTED)

    def test_frames_that_the_protocol_does_not_have(self):
        """Each ends its connection."""
        subscription = json.dumps({"op": "subscribeConnectionGraph"}).encode()
        for name, bytes_sent in {
                "unmasked": frame(TEXT, subscription, is_masked=False),
                "compressed": frame(TEXT, b"\x4b\x4c\x04" * 100, first=0xC0),
                "reserved bits": frame(TEXT, subscription, first=0xB0),
                "opcode 3": frame(3, b"x"), "opcode 15": frame(15, b"x"),
                "continuation of nothing": frame(0, b"x"),
                "a message in a message": frame(TEXT, b"{", first=0) + frame(TEXT, b"}"),
                "long ping": frame(PING, b"x" * 126),
                "ping in parts": frame(PING, b"x", first=0),
                "no UTF-8": frame(TEXT, b"\xff\xfe\xfd"),
                "a close of one byte": frame(CLOSE, b"x"),
                "a close for an unknown reason": frame(CLOSE, b"\x00\x01"),
                "2^63 bytes": frame(BINARY, b"x", length=2 ** 63),
                "2^62 bytes": frame(BINARY, b"x", length=2 ** 62),
                "4 GiB in parts": frame(BINARY, b"x" * 60_000, first=0) * 40,
                "HTTP": b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"}.items():
            with self.subTest(name), RawViewer(self.port) as viewer:
                viewer.send(bytes_sent)
                self.assertTrue(viewer.is_closed())
        self.assert_unharmed()

    def test_floods(self):
        """Pings, empty parts, questions and subscriptions without end, of viewers that read nothing."""
        all_channels = [{"id": id, "channelId": id} for id in self.channels.values()]
        ids = [each["id"] for each in all_channels]

        def operations(*all_of):
            return b"".join(frame(TEXT, json.dumps(each).encode()) for each in all_of)

        graph = operations({"op": "subscribeConnectionGraph"}, {"op": "unsubscribeConnectionGraph"})
        anew = operations({"op": "subscribe", "subscriptions": all_channels},
                          {"op": "unsubscribe", "subscriptionIds": ids})
        for name, flood in {
                "pings": frame(PING, b"x" * 125) * 100,
                "empty parts": frame(TEXT, b"{", first=0) + frame(0, b"", first=0) * 5000,
                "parameters": operations({"op": "getParameters", "parameterNames": [], "id": "x"}) * 100,
                "long ids": operations({"op": "getParameters", "parameterNames": [], "id": "x" * 50_000}),
                "graphs": graph * 100, "subscriptions": anew * 20,
                "unknown channels": operations({"op": "subscribe", "subscriptions": [
                    {"id": id, "channelId": 10 ** 9 + id} for id in range(1000)]}),
                "brackets": frame(TEXT, b"[" * 65_000), "objects": frame(TEXT, b'{"a":' * 13_000)}.items():
            with self.subTest(name):
                viewers = [RawViewer(self.port) for _ in range(10)]
                for viewer in viewers:
                    viewer.socket.settimeout(0.05)
                end = time.monotonic() + 0.5
                while viewers and time.monotonic() < end:
                    for viewer in list(viewers):
                        try:
                            viewer.socket.sendall(flood)
                        except OSError:  # it takes no more, or has closed
                            viewers.remove(viewer)
                            viewer.socket.close()
                self.hear_tick()
                for viewer in viewers:
                    viewer.socket.close()
        self.assert_unharmed()

    def test_who_asks_without_end_waits(self):
        begin = time.monotonic()
        with RawViewer(self.port) as viewer:
            question = json.dumps({"op": "getParameters", "parameterNames": ["phase"], "id": "x"}).encode()
            viewer.send(frame(TEXT, question) * 1200)
            heard = 0
            while heard < 1050:
                viewer.hear_operation("parameterValues")
                heard += 1
            self.assertLess(heard, 1000 + 51 * (time.monotonic() - begin) + 2)
        self.assert_unharmed()

    def test_who_has_the_token_asks_ten_times_as_much(self):
        """Both are read as they come for a thousand messages; then 500 a second, and 50."""
        question = json.dumps({"op": "getParameters", "parameterNames": ["phase"], "id": "x"}).encode()
        begin = time.monotonic()
        with RawViewer(self.port) as looker, RawViewer(self.port, self.token) as owner:
            for viewer in (looker, owner):
                viewer.send(frame(TEXT, question) * 1600)
            for heard in range(1, 1501):
                owner.hear_operation("parameterValues")
                self.assertLess(heard, 1000 + 501 * (time.monotonic() - begin) + 2)
            looker.socket.setblocking(False)
            heard = 0
            with self.assertRaises(BlockingIOError):
                while heard < 1600:
                    looker.hear_operation("parameterValues")
                    heard += 1
            self.assertLess(heard, 1000 + 51 * (time.monotonic() - begin) + 2)
        self.assert_unharmed()

    def test_messages_without_token_have_64_KiB(self):
        longest = json.dumps({"op": "getParameters", "parameterNames": [], "id": "x"}).encode().ljust(64 << 10)
        with RawViewer(self.port) as viewer:
            viewer.send(frame(TEXT, longest))
            viewer.hear_operation("parameterValues")
            viewer.send(frame(TEXT, longest + b" "))
            opcode, content = viewer.hear()
            while opcode != CLOSE:
                opcode, content = viewer.hear()
            self.assertEqual(content[:2], b"\x03\xf1", "1009: too big")
        with RawViewer(self.port, self.token) as viewer:
            viewer.send(frame(TEXT, longest + b" "))
            viewer.hear_operation("parameterValues")
        self.assert_unharmed()

    def test_there_are_48_viewers_without_token_and_128_connections(self):
        lookers = [RawViewer(self.port) for _ in range(60)]
        taken = 0
        for each in lookers:
            opcode, content = each.hear()
            taken += opcode == TEXT
            if opcode == CLOSE:
                self.assertEqual(content[:2], b"\x03\xf5", "1013: try again later")
        self.assertEqual(taken, 47, "48 with the good viewer of this test")
        for each in lookers:
            each.socket.close()
        half = [socket.create_connection(("127.0.0.1", self.port), timeout=60) for _ in range(200)]
        for each in half[-127:]:
            each.sendall(b"GET / HTTP/1.1\r\nHost: local")
        for each in half[:200 - 127]:
            self.assertEqual(each.recv(1), b"", "the oldest makes place")
        for each in half[-127:]:
            each.sendall(b"host\r\nConnection: close\r\n\r\n")
            self.assertRegex(each.recv(1000), b"^HTTP/1.1 200")
            each.close()
        self.assert_unharmed()

    def test_places_are_kept_for_those_with_the_token(self):
        """Any number of connections without token, with and without handshake, that do not go when they are told."""
        lookers = [RawViewer(self.port, request=handshake()) for _ in range(300)]
        half = [socket.create_connection(("127.0.0.1", self.port)) for _ in range(300)]
        for each in half:
            try:
                each.sendall(b"GET / HTTP/1.1\r\nHost: local")
            except OSError:  # it made place
                pass
        with RawViewer(self.port, self.token) as owner:
            self.assertEqual(owner.status, 101)
            self.assertEqual(owner.hear_operation("serverInfo")["metadata"]["may_steer"], "true")
        with socket.create_connection(("127.0.0.1", self.port), timeout=60) as page:
            page.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
            self.assertRegex(page.recv(1000), b"^HTTP/1.1 200")
        for each in [looker.socket for looker in lookers] + half:
            each.close()
        self.assert_unharmed()

    def test_pages_that_are_not_read(self):
        with urllib.request.urlopen(f"http://127.0.0.1:{self.port}/", timeout=60) as page:
            script = re.search(rb"page-\w+\.js", page.read())[0]
        request = b"GET /" + script + b" HTTP/1.1\r\nHost: localhost\r\n\r\n"
        connections = []
        for _ in range(300):
            each = socket.socket()
            each.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
            each.connect(("127.0.0.1", self.port))
            connections.append(each)
            try:
                each.sendall(request * 50)
            except OSError:
                pass
        self.hear_tick()
        for each in connections:
            each.close()
        self.assert_unharmed()

    def test_names_origins_and_tokens(self):
        here = f"http://localhost:{self.port}"
        host = f"localhost:{self.port}"
        for origin in (f"{here}.evil.example", f"http://localhost:{self.port}@evil.example", "http://localhost",
                       f"https://localhost:{self.port}", f"http://LOCALHOST:{self.port}x", "file://", "null", "",
                       f"{here}/", f"{here} http://evil.example", "http://127.0.0.1:1"):
            with self.subTest(origin), RawViewer(self.port, request=handshake("/", host, f"Origin: {origin}")) as viewer:
                self.assertEqual(viewer.status, 403)
        token = self.token
        flipped = token[:-1] + ("A" if token[-1] != "A" else "B")
        for query in ("?token=", f"?token={flipped}", f"?token={token}x", f"?token={token[:-1]}",
                      f"?token={token.swapcase()}", f"?token=x&token={token}", f"?token={token}%00",
                      "?token=" + "x" * 5000, "?token=*"):
            with self.subTest(query), RawViewer(self.port, request=handshake("/" + query, host)) as viewer:
                self.assertEqual(viewer.status, 403)
        for name in ("evil.example", f"{host}.evil.example", "localhost@evil.example", "127.0.0.1.evil.example"):
            with RawViewer(self.port, request=handshake(f"/?token={token}", name)) as viewer:
                self.assertEqual(viewer.status, 403, name)
        for more in ("Sec-WebSocket-Extensions: permessage-deflate; client_max_window_bits",
                     "Sec-WebSocket-Extensions: permessage-deflate; server_no_context_takeover"):
            with RawViewer(self.port, request=handshake("/", host, more)) as viewer:
                self.assertEqual(viewer.status, 101)
                self.assertNotIn("deflate", viewer.answer)
        self.assert_unharmed()

    def test_requests_that_a_proxy_could_read_otherwise(self):
        host, evil = f"Host: localhost:{self.port}", "http://evil.example"
        page = "\r\n".join(["GET / HTTP/1.1", host, "{}", "", "GET /page.js HTTP/1.1", host, "", ""])
        for request in (page.format("Host: evil.example"), page.format("Transfer-Encoding: xchunked"),
                        page.format("Transfer-Encoding: gzip, identity"),
                        handshake("/", f"localhost:{self.port}", "Host: evil.example").decode(),
                        handshake("/", f"localhost:{self.port}", f"Origin: http://localhost:{self.port}",
                                  f"Origin: {evil}").decode(),
                        handshake("/", f"localhost:{self.port}", "Content-Length: 5").decode()):
            with self.subTest(request), socket.create_connection(("127.0.0.1", self.port), timeout=60) as client:
                client.sendall(request.encode())
                answer = b""
                while part := client.recv(65536):
                    answer += part
                self.assertRegex(answer, b"^HTTP/1.1 400")
                self.assertEqual(answer.count(b"HTTP/1.1 "), 1)
        self.assert_unharmed()

    def test_services_called_with_garbage(self):
        good = [b"{", b"[]", b"null", b'"x"', b"\xff", b"[" * 2_000_000, b'{"a":' * 300_000, b'{"ticks":-1}',
                b'{"ticks":1e99}', b'{"ticks":0}', b'{"seed":-1}', b'{"seed":1.5}', b'{"factor":1e300}', b'{"factor":"x"}',
                b'{"factor":-1}', b'{"entity":1}', b'{"entity":"r0"}', b'{"entity":"ghost"}',
                b'{"entity":"r0","position":[1e300,0,0]}', b'{"entity":"r0","position":[0]}',
                b'{"entity":"r0","position":[0,0,"x"]}', b'{"entity":"r0","position":[0,0,1],"orientation":[0,0,0,0]}',
                b'{"entity":"r0","position":[' + b"0," * 500_000 + b"0]}", b'{"xml":1}', b'{"xml":""}', b'{"xml":"<"}']
        number = 0
        for service in (0, STEP, SPEED, MOVE, SPAWN, REMOVE, 2 ** 31):
            for payload in good:
                number += 1
                fits = (service == STEP and payload in (b'{"entity":"r0"}', b'{"entity":1}', b'{"entity":"ghost"}'))
                if fits or (service == REMOVE and b'"r0"' in payload):
                    continue
                with self.subTest(service=service, payload=payload[:60]):
                    self.good.call(service, number, payload)
                    self.good.hear_answer(number)
        self.good.call(MOVE, 9999, b"{}", encoding=b"cdr")
        self.assertIn("encoding", self.good.hear_answer(9999)[1])
        self.good.call(RESUME, 10_000, b"{}")
        self.assertTrue(self.good.hear_answer(10_000)[0])
        self.assert_unharmed()

    def test_spawns_obey_the_rules(self):
        (self.folder / "secret.txt").write_text("root:x:0:0\n")
        [robot] = re.findall(r'<prototype id="r0">.*?</prototype>', self.text, re.DOTALL)
        named = re.sub(r"<params[^>]*/>", "", robot).replace('"r0"', '"late"').replace("0,0,0", "2,2,0", 1)
        hostile = [
            named.replace('config="swing"', f'config="swing"><params script="{self.folder}/secret.txt"/></controller', 1)
                 .replace("</controller />", "</controller>").replace("</controller/>", "</controller>"),
            f'<prototype id="h"><body position="0,0,2" orientation="0,0,0"/><links ref="b"><link id="b" mass="1" '
            f'geometry="hull" file="{self.folder}/secret.txt"/></links></prototype>',
            '<include file="/etc/passwd"/>', '<!DOCTYPE x [<!ENTITY a SYSTEM "file:///etc/passwd">]><box id="&a;"/>',
            BOX.format("b", "nan,0,0"), BOX.format("b", "1e9,0,0"), BOX.format("r0", "0,0,2"), "<a>" * 100_000,
            BOX.format("b", "0,0,2") * 2, "x" * 1_900_000]
        for number, xml in enumerate(hostile):
            with self.subTest(xml[:70]):
                self.good.call(SPAWN, number, json.dumps({"xml": xml}).encode())
                done, told = self.good.hear_answer(number)
                self.assertFalse(done)
                self.assertNotIn("root:", told)
                self.assertLess(len(told), 5000)
        self.good.call(SPAWN, 100, json.dumps({"xml": BOX.format("good", "2,2,2")}).encode())
        self.assertTrue(self.good.hear_answer(100)[0])
        self.assert_unharmed()

    def test_calls_that_wait_take_little_memory(self):
        """64 spawns of 2 MB each, before any is answered, by several viewers."""
        xml = json.dumps({"xml": "<!--" + "x" * 1_900_000 + "-->"}).encode()
        viewers = [RawViewer(self.port, self.token) for _ in range(4)]
        for number in range(30):
            for viewer in viewers:
                viewer.call(SPAWN, number, xml)
        for viewer in viewers:
            self.assertFalse(viewer.hear_answer(0)[0])
            viewer.socket.close()
        self.assert_unharmed()


if __name__ == "__main__":
    unittest.main(verbosity=2)
