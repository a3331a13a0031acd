# SPDX-License-Identifier: MIT
"""Recordings of real runs: whole, harmless when the disk is full, readable after kill -9, without secrets.

ZIGGURAT_KILLS is the number of runs that are killed (4; in ./quickstart test-all 20).
"""

import json
import os
import pathlib
import random
import resource
import signal
import struct
import subprocess
import time
import unittest
import zlib

from harness import FAULT, FINISHED, INTERRUPTED, ZIGGURAT, SceneTest
from waiting import wait_until

KILLS = int(os.environ.get("ZIGGURAT_KILLS", 20 if os.environ.get("ZIGGURAT_TEST_ALL") == "1" else 4))


class RecordingTest(SceneTest):
    def info(self, path, *options, code=None):
        done = subprocess.run([str(ZIGGURAT), "info", str(path), "--json", *map(str, options)],
                              capture_output=True, text=True, timeout=60)
        if code is not None:
            self.assertEqual(done.returncode, code, done.stderr)
        return json.loads(done.stdout)

    def counts(self, info):
        return {each["topic"]: each["messages"] for each in info["topics"]}

    def outcome(self, *arguments, **options):
        process = self.start(*arguments, **options)
        out, err = process.communicate(timeout=120)
        return process.returncode, out, err

    def test_a_pattern_that_fits_no_topic_is_told(self):
        record = ("run", "arms.argos", "--ticks", 1, "--record", "a.mcap", "--record-topics")
        for pattern, told in (("/pose", "'/pose' fits no topic; did you mean '/poses'"), ("/barrier*", "fits no topic; write /poses")):
            code, _, err = self.outcome(*record, pattern)
            self.assertEqual(code, FAULT)
            self.assertIn(told, err)
            self.assertFalse((self.folder / "a.mcap").exists())
        for pattern in ("/robots/new/*", "*/new/observation"):
            code, _, err = self.outcome(*record, pattern, "--record-topics", "/state")
            self.assertEqual(code, FINISHED, err)
            self.assertIn(f"warning: --record-topics: '{pattern}' fits no topic of this world", err)

    def test_a_run_is_recorded_whole(self):
        self.write("part.lua", "part = 1\n")
        (self.folder / "swing.lua").write_text('require "part"\n' + (self.folder / "swing.lua").read_text())
        code, _, err = self.outcome("run", "arms.argos", "--ticks", 20, "--record", "a.mcap", "--trust-scripts")
        self.assertEqual(code, FINISHED, err)
        info = self.info(self.folder / "a.mcap", code=FINISHED)
        self.assertTrue(info["is_whole"])
        self.assertEqual(info["states"], 21)
        self.assertEqual(info["last_tick"], 20)
        self.assertEqual(info["run"]["scene"], "arms.argos")
        counts = self.counts(info)
        for topic in ("/poses", "/state", "/inputs", "/tf", "/contacts"):
            self.assertEqual(counts[topic], 21, topic)
        self.assertEqual(counts["/world"], 1)
        self.assertNotIn("/barrier", counts)
        self.assertNotIn("/phases", counts)
        names = [each["name"] for each in info["attachments"]]
        self.assertEqual(names, ["arms.argos", "swing.lua", "part.lua"])

    def test_the_hash_does_not_depend_on_it(self):
        hashes = []
        for options in ([], ["--record", "a.mcap"], ["--record", "a.mcap", "--record-compression", "none"]):
            code, out, _ = self.outcome("run", "arms.argos", "--ticks", 30, "--hash", *options)
            self.assertEqual(code, FINISHED)
            hashes.append(out.splitlines()[-1])
        self.assertEqual(len(set(hashes)), 1)

    def test_topics_are_chosen(self):
        self.outcome("run", "arms.argos", "--ticks", 5, "--record", "a.mcap", "--record-topics", "/poses",
                     "--record-topics", "/robots/*/command", "--record-compression", "lz4")
        topics = set(self.counts(self.info(self.folder / "a.mcap", code=FINISHED)))
        self.assertTrue({"/run", "/inputs", "/poses"} <= topics)
        self.assertTrue(any(topic.endswith("/command") for topic in topics))
        self.assertFalse({"/state", "/tf", "/world"} & topics)

    def test_tells_of_scripts_that_are_too_many(self):
        script = self.folder / "swing.lua"
        script.write_text(script.read_text() + "\nfunction load_part(name) return require(name) end")
        for i in range(1000):
            (self.folder / f"part{i}.lua").touch()
        outcome = self.run_scene("--record", "run.mcap", "--ticks", "2")
        self.assertIn(f"some Lua files of {self.folder} are not in the recording: ", outcome.err)
        (self.folder / "part999.lua").unlink()
        outcome = self.run_scene("--record", "run.mcap", "--ticks", "2")
        self.assertNotIn("some Lua files", outcome.err)

    def test_wrong_options_are_refused(self):
        for options, word in ((["--record", "a.csv"], ".mcap"), (["--record-strict"], "write --record too"),
                              (["--record", "a.mcap", "--record-compression", "gzip"], "zstd, lz4 or none"),
                              (["--record", "a.mcap", "--record-every", "0"], "1 or more")):
            code, _, err = self.outcome("run", "arms.argos", *options)
            self.assertEqual(code, FAULT)
            self.assertIn(word, err)

    def test_it_never_destroys_its_scene(self):
        scene = self.folder / "scene.mcap"
        scene.write_text(self.text)
        code, _, err = self.outcome("run", "scene.mcap", "--record", "scene.mcap")
        self.assertEqual(code, FAULT)
        self.assertIn("scene", err)
        self.assertEqual(scene.read_text(), self.text)
        (self.folder / "more.mcap").write_text("<include/>")
        self.change("</framework>", '</framework><include file="more.mcap"/>')
        code, _, err = self.outcome("run", "arms.argos", "--record", "more.mcap")
        self.assertEqual(code, FAULT)
        self.assertEqual((self.folder / "more.mcap").read_text(), "<include/>")

    def test_ctrl_c_completes_it(self):
        process = self.start("run", "arms.argos", "--duration", 0, "--record", "a.mcap")
        self.wait_for_size("a.mcap", 20_000)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, INTERRUPTED)
        self.assertTrue(self.info(self.folder / "a.mcap", code=FINISHED)["is_whole"])

    def test_a_file_that_is_removed_or_that_another_run_writes_to_is_told(self):
        process = self.start("run", "arms.argos", "--duration", 0, "--record", "a.mcap", "--trace", "a.csv")
        self.wait_for_size("a.mcap", 20_000)
        for option, file in (("--record", "a.mcap"), ("--trace", "a.csv")):
            code, _, err = self.outcome("run", "arms.argos", "--ticks", 3, option, file)
            self.assertEqual(code, FAULT, err)
            self.assertIn(f"{file}: cannot be written: another program writes to it", err)
        (self.folder / "a.mcap").unlink()
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=60)
        self.assertIn("a.mcap: was removed while it was written, and is lost", err)

    def test_a_file_that_is_shortened_is_told(self):
        process = self.start("run", "arms.argos", "--ticks", 100, "--real-time=5", "--record", "a.mcap")
        self.wait_for_size("a.mcap", 1000)
        os.truncate(self.folder / "a.mcap", 500)
        _, err = process.communicate(timeout=60)
        self.assertIn("finished: 100 ticks", err)
        self.assertRegex(err, r"a\.mcap: was shortened by another program while it was written: \d+ bytes of \d+ are lost; "
                              r"the recording ends before tick \d+, the run goes on")
        self.assertRegex(err, r"\n  not recorded in whole: .*a\.mcap: was shortened")
        self.assertEqual(process.returncode, FAULT)
        self.assertEqual((self.folder / "a.mcap").stat().st_size, 500)

    def wait_for_size(self, name, size):
        path = self.folder / name
        wait_until(lambda: path.exists() and path.stat().st_size >= size, f"{name} has {size} bytes")

    def test_a_full_disk_ends_the_recording_and_not_the_run(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (60_000, 60_000))

        arguments = ("run", "arms.argos", "--ticks", 300, "--record-compression", "none", "--record", "a.mcap")
        code, _, err = self.outcome(*arguments, preexec_fn=limit)
        self.assertEqual(code, FAULT, err)
        self.assertRegex(err, r"a\.mcap: cannot be written: File too large; the recording (ends before tick \d+, the run goes on|lacks its last ticks)")
        self.assertIn("finished: 300 ticks", err)
        self.assertRegex(err, r"\n  not recorded in whole: .*a\.mcap: cannot be written: .*; the recording (ends before|lacks).*\n")
        self.assertLessEqual((self.folder / "a.mcap").stat().st_size, 60_000)
        info = self.info(self.folder / "a.mcap", code=FAULT)
        self.assertEqual(info["damaged_chunks"], 0)
        self.assertEqual(info["run"]["scene"], "arms.argos")
        code, _, err = self.outcome(*arguments, "--record-strict", preexec_fn=limit)
        self.assertEqual(code, FAULT, err)
        self.assertIn("File too large", err)

    def chunks(self, path):
        """How many states each chunk of a file has that was cut off anywhere: by the times in their heads."""
        data, at, states = path.read_bytes(), 8, []
        while at + 9 <= len(data):
            op, length = data[at], int.from_bytes(data[at + 1:at + 9], "little")
            begin, at = at + 9, at + 9 + length
            if op != 0x06 or at > len(data):
                continue
            first, last = struct.unpack_from("<2Q", data, begin)
            states.append(1 + (last - first) // 100_000_000)  # 10 ticks a second
        return states

    def test_a_killed_run_loses_a_chunk_at_most(self):
        """Against the hash file of the same run. A chunk has a second of wall time, 200 states at this pace, or
        more where a run that fell behind catches up. The world waits before more than a chunk could be lost; chunks end
        at three quarters of one, so 4/3 of those in the file may be, and what the hash file is ahead. What was lost is
        printed."""
        choose = random.Random(1)
        second = 200
        lost_chunks = []
        for number in range(KILLS):
            path = self.folder / f"{number}.mcap"
            process = self.start("run", "arms.argos", "--duration", 0, "--quiet", "--real-time", "20",
                                 "--record", path, "--hash-file", f"{number}.hash")
            self.wait_for_size(path.name, 1)
            time.sleep(choose.uniform(0, 2.5))  # the moment is random
            process.kill()
            process.communicate()
            info = self.info(path, code=FAULT)
            self.assertEqual(info["damaged_chunks"], 0, info["faults"])
            self.assertFalse(info["has_end"])
            hashes = [line.split() for line in (self.folder / f"{number}.hash").read_text().splitlines()]
            full = [line for line in hashes if len(line) == 3 and len(line[2]) == 16]
            chunks = self.chunks(path)[1:]  # the first has the start
            self.assertGreaterEqual(sum(chunks), info["states"])  # a chunk may end within a tick
            lost_chunks.append(max(0, len(full) - info["states"]) / max([second, *chunks]))
            self.assertLessEqual(lost_chunks[-1], 1.5, f"run {number}: {info['states']} of {len(full)} states, "
                                                      f"chunks of {chunks}")
            saved = self.folder / "saved.mcap"
            done = subprocess.run([str(ZIGGURAT), "info", str(path), "--repair", str(saved)], capture_output=True)
            self.assertEqual(done.returncode, FINISHED, done.stderr)
            self.assertEqual(self.info(saved, code=FINISHED)["states"], info["states"])
            path.unlink()
        more = sum(1 for each in lost_chunks if each > 1)
        print(f"{KILLS} runs killed: lost {max(lost_chunks):.2f} chunks at most, "
              f"{sum(lost_chunks) / len(lost_chunks):.2f} on average; {more} lost more than one")

    @staticmethod
    def records(data):
        """(op code, begin, end) of the content of each record."""
        at = 8
        while at + 9 <= len(data):
            op, begin = data[at], at + 9
            at = begin + int.from_bytes(data[at + 1:begin], "little")
            yield op, begin, at

    def damaged(self, data, choose):
        """Cut off, or bits flipped, or other contents with the right checksums and no summary."""
        data = bytearray(data)
        kind = choose.choice(["cut", "flip", "contents", "contents"])
        if kind == "cut":
            return data[:choose.randrange(len(data))]
        records = [each for each in self.records(data) if each[0] in (0x03, 0x04, 0x06, 0x09)]
        for _ in range(choose.choice([1, 2, 5])):
            if kind == "flip":
                data[choose.randrange(len(data))] ^= 1 << choose.randrange(8)
                continue
            op, begin, end = choose.choice(records)
            at = choose.randrange(begin + 40 if op == 0x06 else begin, end - 8)
            value = choose.choice([b"\xff" * 4, bytes(8), bytes([choose.randrange(256)]),
                                   struct.pack("<d", choose.choice([float("nan"), 1e308]))])
            data[at:at + len(value)] = value
        if kind == "flip":
            return data
        for op, begin, end in records:
            if op == 0x06:
                data[begin + 24:begin + 28] = zlib.crc32(data[begin + 40:end]).to_bytes(4, "little")
            elif op == 0x09:
                data[end - 4:end] = zlib.crc32(data[begin:end - 4]).to_bytes(4, "little")
        end = next(begin for op, begin, _ in self.records(data) if op == 0x0F)  # the end of the data
        return data[:end - 9]

    def test_damaged_recordings_end_every_command_with_words(self):
        self.outcome("run", "arms.argos", "--ticks", 12, "--record", "a.mcap", "--record-compression", "none")
        whole = (self.folder / "a.mcap").read_bytes()
        choose = random.Random(1)
        for number in range(12):
            (self.folder / "x.mcap").write_bytes(self.damaged(whole, choose))
            for command in (["info", "--repair", "saved.mcap"], ["verify"], ["replay", "--from-poses", "--quiet"],
                            ["export", "--csv", "x.csv"], ["diff", "a.mcap"],
                            ["fork", "--at", "5", "--ticks", "8", "--without-controllers", "--quiet"]):
                with self.subTest(number=number, command=command[0]):
                    code, _, err = self.outcome(command[0], "x.mcap", *command[1:])
                    self.assertIn(code, (FINISHED, FAULT, 5, 6), err)
                    self.assertNotRegex(err, r"terminate called|Assertion|std::|Sanitizer")

    def test_what_is_intact_is_counted_in_words(self):
        self.outcome("run", "arms.argos", "--ticks", 3, "--record", "a.mcap", "--record-compression", "none", "--quiet")
        whole = (self.folder / "a.mcap").read_bytes()
        end = [end for op, _, end in self.records(whole) if op == 0x06][0]  # of the first chunk, which has /run alone
        (self.folder / "x.mcap").write_bytes(whole[:end + 5])
        code, _, err = self.outcome("info", "x.mcap")
        self.assertEqual(code, FAULT)
        self.assertRegex(err, r"; 1 message and \d+ attachments are intact, ")
        code, _, err = self.outcome("export", "x.mcap", "--csv", "x.csv")
        self.assertEqual(code, FAULT)
        self.assertFalse((self.folder / "x.csv").exists())

    def test_secrets_are_not_recorded(self):
        keys = [self.folder / "server", self.folder / "client"]
        for key in keys:
            subprocess.run([str(ZIGGURAT), "keygen", "--out", str(key)], check=True, capture_output=True)
        secret = pathlib.Path(f"{keys[0]}.secret").read_text().split()[-1]
        public = pathlib.Path(f"{keys[1]}.public").read_text().split()[-1]
        self.write("clients", f"{public} supervisor\n").chmod(0o600)
        token = "a-token-that-is-secret"
        process = self.start(
            "run", "arms.argos", "--duration", 0, "--curve-secret", "server.secret", "--curve-clients=clients",
            "--endpoint", "tcp://127.0.0.1:*", "--view", "--view-token", token, "--record", "a.mcap",
            "--record-compression", "none", "--real-time", "100")
        self.wait_for_size("a.mcap", 50_000)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        bytes_of_it = (self.folder / "a.mcap").read_bytes()
        self.assertIn(b"/inputs", bytes_of_it)
        for what in (secret, token, public, "server.secret"):
            self.assertNotIn(what.encode(), bytes_of_it)

    def test_folders_and_the_command_line_of_the_author_are_not_recorded(self):
        scene, folder = str(self.folder / "arms.argos"), str(self.folder).encode()
        for options, is_told in (((), False), (("--record-paths",), True)):
            code, _, err = self.outcome("run", scene, "--ticks", 3, "--record", "a.mcap", "--record-compression", "none", *options)
            self.assertEqual(code, FINISHED, err)
            bytes_of_it = (self.folder / "a.mcap").read_bytes()
            self.assertEqual(folder in bytes_of_it, is_told)
            self.assertEqual(b"--ticks" in bytes_of_it, is_told)
            self.assertEqual(self.outcome("verify", "a.mcap")[0], FINISHED)
            (self.folder / "a.mcap").unlink()

    def test_texts_of_a_recording_are_escaped(self):
        name = "evil\x1b]0;title\x07.argos"
        (self.folder / name).write_text(self.text)
        self.outcome("run", name, "--ticks", 2, "--record", "a.mcap")
        done = subprocess.run([str(ZIGGURAT), "info", str(self.folder / "a.mcap")], capture_output=True)
        self.assertEqual(done.returncode, FINISHED)
        self.assertNotIn(b"\x1b]", done.stdout)
        self.assertIn(b"evil\\u001b", done.stdout)

    def test_what_is_no_recording_gets_one_error(self):
        for text in (b"", b"\x89MCAP0\r", self.text.encode()):
            path = self.folder / "x.mcap"
            path.write_bytes(text)
            done = subprocess.run([str(ZIGGURAT), "info", str(path)], capture_output=True, text=True)
            self.assertEqual(done.returncode, FAULT)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn("no MCAP file", done.stderr)


if __name__ == "__main__":
    unittest.main()
