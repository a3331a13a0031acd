# SPDX-License-Identifier: MIT
"""Recordings whose messages would take far more memory than they have bytes: no command takes more than is stated."""

import os
import struct
import subprocess
import sys
import unittest

from harness import FAULT, FINISHED
from recorded import DAMAGED, Recorded

CHANNEL, CHUNK, DATA_END, MESSAGE = 0x04, 0x06, 0x0F, 0x05
# Stated in docs/recordings.md, "The file" [bytes].
MOST = {"info": 1.0e9, "diff": 4.0e9, "export --csv": 3.0e9, "export --jsonl": 2.0e9, "verify": 2.0e9, "replay": 2.0e9,
        "replay --from-poses": 2.0e9, "fork": 2.0e9, "try": 2.0e9}


def records_of(data):
    """The op, the place and the content of each record."""
    at = 8
    while at < len(data) - 8:
        op, length = struct.unpack_from("<BQ", data, at)
        yield op, at, data[at + 9:at + 9 + length]
        at += 9 + length


def with_messages(recording, path, *messages):
    """The recording, cut where its messages end, with more messages: topic, piece, how often, and what stands before it. As a
    run that was killed leaves it. Nothing of it is kept here: a child's memory is counted from that of its parent on."""
    data = recording.read_bytes()
    channels, end = {}, 0
    for op, at, content in records_of(data):
        if op == DATA_END:
            end = at
            break
        if op == CHANNEL:
            size = struct.unpack_from("<I", content, 4)[0]
            channels[content[8:8 + size].decode()] = content[:2]
    with open(path, "wb") as file:
        file.write(data[:end])
        for topic, piece, count, before in messages:
            times = struct.pack("<QQ", 10**15, 10**15)
            message = channels[topic] + bytes(4) + times + before
            size = len(message) + len(piece) * count
            head = times + struct.pack("<QIIQ", 9 + size, 0, 0, 9 + size)  # the CRC is not computed
            file.write(struct.pack("<BQ", CHUNK, len(head) + 9 + size) + head + struct.pack("<BQ", MESSAGE, size) + message)
            for at in range(0, count, 100_000):
                file.write(piece * min(100_000, count - at))
    return path


class RecordingMemory(Recorded):
    def setUp(self):
        super().setUp()
        self.recording, _ = self.record("--ticks", 3, "--record-compression", "none")
        self.hostile = self.folder / "hostile.mcap"

    def check(self, command, *arguments):
        """Its exit code and errors, if it took no more than is stated."""
        with open(self.folder / "errors", "w+", errors="replace") as errors:
            out = subprocess.DEVNULL if arguments[0] == "export" else errors
            process = self.start(*arguments, stdout=out, stderr=errors, limit=200)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            errors.seek(0)
            said = errors.read()
        print(f"{command}: {usage.ru_maxrss * 1024e-6:.0f} MB, exit code {process.returncode}", file=sys.stderr)
        self.assertLess(usage.ru_maxrss * 1024, MOST[command], f"{arguments} {said}")
        self.assertNotRegex(said, "no memory|terminate|Sanitizer")
        return process.returncode, said

    def commands(self):
        """Words of commands that read the hostile recording."""
        file = self.hostile
        return {"info": ["info", file], "diff": ["diff", file, file], "export --csv": ["export", file, "--csv", "-"],
                "export --jsonl": ["export", file, "--jsonl", "-"], "verify": ["verify", file], "replay": ["replay", file],
                "replay --from-poses": ["replay", file, "--from-poses"],
                "fork": ["fork", file, "--at", 100, "--ticks", 110],
                "try": ["try", file, "--robot", "r0", "--script", "swing.lua"]}

    def test_messages_of_many_small_parts_are_told(self):
        for topic, piece, count, readers in (
                ("/world", b"\x62\0", 60_000_000, ("diff", "export --csv", "export --jsonl")),
                ("/inputs", b"\x22\x02\x3a\0", 8_000_000,
                 ("diff", "export --jsonl", "verify", "replay", "replay --from-poses", "fork", "try")),
                ("/inputs", b"\x22\0", 15_000_000, ("diff", "export --jsonl", "verify")),
                ("/state", b"\x7a\0", 15_000_000, ("diff", "export --csv", "export --jsonl", "verify")),
                ("/contacts", b"\x7a\0", 30_000_000, ("export --jsonl",))):
            with_messages(self.recording, self.hostile, (topic, piece, count, b""))
            for name in readers:
                with self.subTest(topic, command=name):
                    code, said = self.check(name, *self.commands()[name])
                    self.assertIn(code, (FAULT, DAMAGED), said)
                    self.assertRegex(said, rf"hostile\.mcap: a message of {topic} at .* s, in the chunk at byte \d+, has parts "
                                     r"that take more than \d+ MiB of memory.*; take another copy")
            self.check("info", *self.commands()["info"])

    def test_long_messages_are_told(self):
        for topic, size in (("/state", 33 << 20), ("/inputs", 33 << 20), ("/contacts", 65 << 20), ("/world", 129 << 20)):
            with_messages(self.recording, self.hostile, (topic, b"\0", size, b""))
            with self.subTest(topic):
                code, said = self.check("export --jsonl", *self.commands()["export --jsonl"])
                self.assertEqual(code, FAULT, said)
                self.assertRegex(said, rf"a message of {topic} at .* has {size} bytes; at most \d+ are read")

    def test_what_is_read_takes_what_is_stated(self):
        """Messages that just stay below the bounds, and are decoded."""
        def world(piece, count):
            return "/world", piece, count, b""

        one_link = b"\x10\x09\x18\x01\x2a\x68" + bytes(104)  # at tick 9
        inputs = [("/inputs", b"\x22\x02\x3a\0", 1_300_000, bytes([0x10, tick])) for tick in range(100, 104)]
        for name, messages, expected in (
                ("diff", [world(b"\x62\0", 5_000_000), *inputs], FINISHED), ("export --csv", [world(b"\x62\0", 5_000_000)], FAULT),
                ("export --csv", [world(b"\x62\0\x6a\0", 2_400_000)], FINISHED),
                ("export --csv", [("/world", b"\x62\0", 5_000_000, b"\x6a\0"), ("/state", b"", 0, one_link)], FINISHED),
                ("diff", [world(b"\x6a\0", 4_500_000), *inputs], FINISHED),
                ("export --jsonl", [world(b"\x62\0", 5_000_000)], FINISHED), ("info", inputs, FAULT),
                ("verify", inputs, None), ("replay --from-poses", inputs, None), ("fork", inputs, None), ("try", inputs, None)):
            with_messages(self.recording, self.hostile, *messages)
            with self.subTest(name):
                code, said = self.check(name, *self.commands()[name])
                self.assertNotRegex(said, "more than .* MiB")
                if expected is not None:
                    self.assertEqual(code, expected, said)


if __name__ == "__main__":
    unittest.main()
