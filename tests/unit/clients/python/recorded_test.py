# SPDX-License-Identifier: MIT
"""The messages of protocol/recorded, read by the Python client; and the document that explains them."""

import importlib.util
import json
import pathlib
import unittest

from google.protobuf import json_format

from ziggurat import protocol_pb2 as v1
from ziggurat.exchange import Exchange
from ziggurat.robot import Robot

ROOT = pathlib.Path(__file__).resolve().parents[4]
RECORDED = ROOT / "protocol" / "recorded"


def messages():
    """(path, message) of all recorded messages."""
    for path in sorted(RECORDED.glob("*/*.bin")):
        kind = v1.ClientMessage if "client_" in path.name else v1.ServerMessage
        yield path, kind.FromString(path.read_bytes())


def is_subset(old, today):
    if isinstance(old, dict):
        return all(name in today and is_subset(old[name], today[name]) for name in old)
    if isinstance(old, list):
        return len(old) == len(today) and all(map(is_subset, old, today))
    return old == today


class Recorded(unittest.TestCase):
    def test_every_message_equals_its_json(self):
        seen = list(messages())
        self.assertGreaterEqual(len(seen), 37)
        for path, message in seen:
            with self.subTest(path.stem):
                self.assertEqual(message.SerializeToString(deterministic=True), path.read_bytes())
                text = path.with_suffix(".json").read_text()
                self.assertEqual(json_format.Parse(text, type(message)()), message)
                today = json_format.MessageToDict(message, including_default_value_fields=True)
                self.assertTrue(is_subset(json.loads(text), today))

    def test_the_client_reads_the_recorded_messages(self):
        folder = RECORDED / "1.0"
        welcome = v1.ServerMessage.FromString((folder / "server_welcome.bin").read_bytes()).welcome
        seen = v1.ServerMessage.FromString((folder / "server_observation.bin").read_bytes())
        exchange = Exchange()
        robots = [Robot(exchange, position, given, lambda *_: None)
                  for position, given in enumerate(welcome.robots)]
        exchange.observe(seen.observation)
        self.assertEqual(robots[0].id, "id é")
        self.assertEqual(robots[0].joints[0].encoder, 3.25)
        self.assertEqual(robots[0].params, {"name é": "value é"})

    def test_the_document_explains_them(self):
        spec = importlib.util.spec_from_file_location("explain", RECORDED / "explain.py")
        explain = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(explain)
        document = (ROOT / "docs" / "protocol.md").read_text()
        self.assertEqual(len(explain.BLOCK.findall(document)), 8)
        self.assertEqual(explain.explained(document), document,
                         "protocol/recorded/explain.py --document docs/protocol.md --update")
        for path, _ in messages():  # and any other can be explained, to its last byte
            lines = explain.explain_file(path).splitlines()
            shown = "".join(line[:explain.COLUMN] for line in lines).replace(" ", "")
            self.assertEqual(bytes.fromhex(shown), path.read_bytes(), path.stem)


if __name__ == "__main__":
    unittest.main()
