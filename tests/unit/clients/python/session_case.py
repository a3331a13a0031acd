# SPDX-License-Identifier: MIT
"""What tests of sessions share: a client beside a fake server."""

import threading
import unittest

import ziggurat

from fake_server import HANG, FakeServer, equipped, welcome


class SessionCase(unittest.TestCase):
    """`self.play(server, client)` runs the client in this thread beside the server's part."""

    def setUp(self):
        self.server = FakeServer()
        self.addCleanup(self.server.close)

    def play(self, part, client):
        faults = []

        def run():
            try:
                part(self.server)
            except Exception as fault:
                faults.append(fault)

        thread = threading.Thread(target=run)
        thread.start()
        try:
            return client()
        finally:
            thread.join(HANG)
            if faults:
                raise faults[0]

    def connect(self, *robots, **options):
        return ziggurat.connect(self.server.endpoint, *robots, wait_timeout=HANG, **options)


def open_with(server, *robots, **fields):
    hello = server.receive()
    server.send(welcome=welcome(*(robots or [equipped("one")]), **fields))
    return hello
