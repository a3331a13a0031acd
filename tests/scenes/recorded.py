# SPDX-License-Identifier: MIT
"""What tests of recordings share."""

import pathlib
import re
import zlib

from harness import FINISHED, SceneTest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DIFFERS, DAMAGED = 5, 6


class Recorded(SceneTest):
    def record(self, *arguments, name="run.mcap", scene=None):
        """Records a run; the hash line of its end."""
        recording = self.folder / name
        outcome = self.run_scene("--record", recording, "--hash", "--quiet", *arguments, scene=scene)
        return recording, outcome.lines[-1]

    def record_a_command(self):
        """Records a run whose scene names a command, which makes a file. Returns the recording and the file's path."""
        marker = self.folder / "started"
        self.change("<lua_controller", "<external_controller")
        self.change("</lua_controller", "</external_controller")
        self.scene.write_text(re.sub(r"(<external_controller id=\"[^\"]*\")",
                                     rf'\1 command="touch {marker}; sleep 100"', self.text))
        recording = self.folder / "run.mcap"
        process = self.start("run", self.scene, "--record", recording)
        self.wait_for(marker.exists, bool, "start of the command")
        self.interrupt(process)
        self.finish(process)
        marker.unlink()
        return recording, marker

    def ask(self, *arguments, code=FINISHED):
        outcome = self.ziggurat(*arguments)
        self.assertEqual(outcome.code, code, f"{arguments}\n{outcome.out}\n{outcome.err}")
        return outcome


def change_inputs(path, old, new):
    """Replaces bytes in the first /inputs message that has them, in a file without compression, and
    corrects the chunk's CRC: all is in order, but for what it says."""
    data = bytearray(path.read_bytes())
    at = 8
    while at < len(data) - 8:
        op, length = data[at], int.from_bytes(data[at + 1:at + 9], "little")
        begin, at = at + 9, at + 9 + length
        if op != 0x06:  # a chunk: times, size, CRC, name of the compression, records
            continue
        assert data[begin + 28:begin + 32] == bytes(4), "it is compressed"
        records = begin + 40
        found = data.find(old, records, at)
        if found < 0:
            continue
        data[found:found + len(old)] = new
        data[begin + 24:begin + 28] = zlib.crc32(data[records:at]).to_bytes(4, "little")
        path.write_bytes(data)
        return
    raise AssertionError("no chunk has these bytes")
