# SPDX-License-Identifier: MIT
"""The kit counts the fields of a message as a server does."""

import unittest

import protocol_pb2 as protocol
from ziggurat_conformance.rules.cost import MOST_FIELDS, has_too_many_fields


def _logs(lines: int, text: str = "") -> protocol.ClientMessage:
    """Has a field of its own, and for each line one, and one of its text."""
    command = protocol.Command(log=[protocol.LogLine(text=text)] * lines)
    return protocol.ClientMessage(command=command)


class Cost(unittest.TestCase):
    def test_each_field_counts(self):
        self.assertFalse(has_too_many_fields(_logs(MOST_FIELDS - 1).SerializeToString()))
        self.assertTrue(has_too_many_fields(_logs(MOST_FIELDS).SerializeToString()))
        self.assertTrue(has_too_many_fields(_logs(MOST_FIELDS // 2, "x").SerializeToString()))

    def test_text_counts_by_its_length(self):
        self.assertFalse(has_too_many_fields(_logs(1, "x" * (15 * MOST_FIELDS)).SerializeToString()))
        self.assertTrue(has_too_many_fields(_logs(1, "x" * (16 * MOST_FIELDS)).SerializeToString()))

    def test_numbers_of_fixed_size_count_as_one(self):
        command = protocol.Command(joint_targets=[0.5] * (4 * MOST_FIELDS))
        self.assertFalse(has_too_many_fields(protocol.ClientMessage(command=command).SerializeToString()))

    def test_brackets_and_commas_in_texts_do_not_count(self):
        text = b'{"command":{"log":[{"text":"%s"}]}}'
        self.assertFalse(has_too_many_fields(text % (b"," * (2 * MOST_FIELDS))))
        self.assertTrue(has_too_many_fields(b'{"x":[' + b"0," * MOST_FIELDS + b"0]}"))


if __name__ == "__main__":
    unittest.main()
