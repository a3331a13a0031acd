# SPDX-License-Identifier: MIT
"""What `connect` and others take from the environment, and keys, against a fake server."""

import os
import pathlib
import tempfile
import unittest
import unittest.mock

import zmq

import ziggurat
from ziggurat import protocol_pb2 as v1

from fake_server import welcome
from session_case import SessionCase, open_with

NAMES = ("ENDPOINT", "CONTROLLER", "SESSION_TOKEN", "SERVER_KEY", "CURVE_SECRET")


class Environment(SessionCase):
    def hello(self, client, **environment):
        """The Hello of a client in that environment."""
        def part(server):
            self.received = open_with(server)
            server.receive()

        def join():
            with client():
                pass

        names = {f"ZIGGURAT_{name}": environment.get(name, "") for name in NAMES}
        with unittest.mock.patch.dict(os.environ, names):
            self.play(part, join)
            self.left = os.environ.get("ZIGGURAT_SESSION_TOKEN")
        return self.received

    def test_the_controller_is_that_of_the_environment(self):
        at = self.server.endpoint
        hello = self.hello(ziggurat.connect, ENDPOINT=at, CONTROLLER="swing")
        self.assertEqual((hello.controller, list(hello.robots), hello.client_name), ("swing", [], "swing"))
        hello = self.hello(lambda: ziggurat.connect(at), CONTROLLER="swing")
        self.assertEqual((hello.controller, list(hello.robots)), ("swing", []))
        hello = self.hello(lambda: ziggurat.connect(robots="arm*"), ENDPOINT=at, CONTROLLER="swing")
        self.assertEqual((hello.controller, list(hello.robots)), ("swing", ["arm*"]))
        hello = self.hello(lambda: ziggurat.connect(controller="other"), ENDPOINT=at, CONTROLLER="swing")
        self.assertEqual(hello.controller, "other")

    def test_without_any_they_are_all_robots(self):
        at = self.server.endpoint
        hello = self.hello(ziggurat.connect, ENDPOINT=at)
        self.assertEqual((hello.controller, list(hello.robots)), ("", ["*"]))
        hello = self.hello(lambda: ziggurat.connect(at, environment={}), ENDPOINT=at, CONTROLLER="swing",
                           SESSION_TOKEN="00ff")
        self.assertEqual((hello.controller, list(hello.robots), hello.session_token), ("", ["*"], b""))

    def test_an_empty_environment_names_no_endpoint(self):
        with tempfile.TemporaryDirectory() as folder:
            names = {"ZIGGURAT_ENDPOINT": "tcp://127.0.0.1:1", "XDG_RUNTIME_DIR": folder}
            with unittest.mock.patch.dict(os.environ, names):
                self.assertEqual(ziggurat.find_server(), "tcp://127.0.0.1:1")
                with unittest.mock.patch("pathlib.Path.iterdir", lambda _: iter(())):  # servers of this user below /tmp
                    for look in (lambda: ziggurat.find_server({}), lambda: ziggurat.connect(environment={})):
                        with self.assertRaisesRegex(ValueError, "no server of this user runs here"):
                            look()

    def test_the_token_is_of_a_session_at_the_endpoint_of_the_environment(self):
        at = self.server.endpoint
        for client, token, left in ((ziggurat.connect, b"\0\xff", None), (lambda: ziggurat.connect(at), b"\0\xff", None)):
            self.assertEqual(self.hello(client, ENDPOINT=at, SESSION_TOKEN="00ff").session_token, token)
            self.assertEqual(self.left, left)
        hello = self.hello(lambda: ziggurat.connect(at), ENDPOINT="tcp://127.0.0.1:1", SESSION_TOKEN="00ff")
        self.assertEqual((hello.session_token, self.left), (b"", "00ff"))


class Keys(SessionCase):
    def setUp(self):
        super().setUp()
        self.server.close()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.public, secret = (key.decode() for key in zmq.curve_keypair())
        server_public, server_secret = zmq.curve_keypair()
        self.file = pathlib.Path(folder.name, "alice")
        self.file.write_text(secret + "\n")
        self.secret = secret
        self.server = type(self.server)(server_secret)
        self.addCleanup(self.server.close)
        self.server_key = server_public.decode()
        names = {"ZIGGURAT_SERVER_KEY": self.server_key, "ZIGGURAT_CURVE_SECRET": str(self.file)}
        patch = unittest.mock.patch.dict(os.environ, names)
        patch.start()
        self.addCleanup(patch.stop)

    def test_those_of_the_environment_are_used_at_a_given_endpoint(self):
        at = self.server.endpoint

        def part(server):
            hello = server.receive()
            server.send(welcome=welcome(role=hello.role))
            server.receive()

        for client in (lambda: ziggurat.connect(at), lambda: ziggurat.resume(at, b"token"),
                       lambda: ziggurat.supervise(at), lambda: ziggurat.direct("judge", at)):
            def run(client=client):
                with client():
                    pass
            self.play(part, run)

    def wrong(self, make, *told):
        with self.assertRaises(ValueError) as caught:
            make()
        for each in told:
            self.assertIn(each, str(caught.exception))
        self.assertNotIn(self.secret, str(caught.exception))

    def test_a_file_in_place_of_a_key_is_told(self):
        path = str(self.file)
        self.wrong(lambda: ziggurat.Curve(path, self.public, self.secret), "server_key is the path of a file", path)
        self.wrong(lambda: ziggurat.Curve(self.server_key, self.public, self.file), "secret_key is the path", path)
        self.wrong(lambda: ziggurat.Curve(self.server_key, "short", self.secret), "public_key is no key", "keygen")
        os.environ["ZIGGURAT_SERVER_KEY"] = path
        self.wrong(lambda: ziggurat.connect(self.server.endpoint), "ZIGGURAT_SERVER_KEY is the path of a file", path)

    def test_a_key_in_place_of_its_file_is_told_and_not_printed(self):
        os.environ["ZIGGURAT_CURVE_SECRET"] = self.secret
        self.wrong(lambda: ziggurat.connect(self.server.endpoint), "ZIGGURAT_CURVE_SECRET is a key", "path")


if __name__ == "__main__":
    unittest.main()
