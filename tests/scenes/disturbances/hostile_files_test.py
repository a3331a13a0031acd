# SPDX-License-Identifier: MIT
"""Hostile files and settings, each against the real program: a sentence that names them."""

import contextlib
import os
import pathlib
import random
import shutil
import socket
import sqlite3
import subprocess
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from harness import FAULT, SceneTest, ZIGGURAT  # noqa: E402


class HostileFiles(SceneTest):
    def refuses(self, *arguments, pattern="."):
        outcome = self.ziggurat(*arguments)
        self.assertEqual(outcome.code, FAULT, f"{arguments}\n{outcome.out[:2000]}\n{outcome.err[:2000]}")
        self.assert_is_sentence(outcome, pattern)
        self.assertNotRegex(outcome.err, "[\x00-\x08\x0b-\x1f\x7f-\x9f]")
        self.assertLess(len(outcome.err), 500_000, "long texts are quoted in part")

    def test_hostile_scenes(self):
        os.mkfifo(self.folder / "pipe")
        for path in ("pipe", "/dev/zero", "/proc/self/mem", "."):
            self.refuses("check", path, pattern="not a regular file|is a folder|cannot be read")
        deep = "<a>" * 100_000 + "</a>" * 100_000
        for name, text in {
                "deep": f"<argos-configuration>{deep}</argos-configuration>",
                "attributes": self.text.replace("<arena ", "<arena " + 'x="1" ' * 1_200_000),
                "long": self.text.replace('id="r0"', f'id="{"x" * 1_000_000}"'),
                "entities": '<!DOCTYPE a [<!ENTITY x "yy"><!ENTITY y "&x;&x;">]>' + self.text,
                "colors": self.text.replace('id="r0"', 'id="\x1b]0;x\x07\u009b31m"'),
                "nul": self.text.replace('id="r0"', 'id="r\0"'),
                "crowd": self.text.replace("</arena>", "<distribute>" * 5000 + "</arena>")}.items():
            with self.subTest(name):
                self.refuses("check", self.write(name, text))

    def test_hostile_settings(self):
        for setting in ("//nowhere/@x=1", "//*[.='nothing']/@x=1", "//*[" * 300 + "1" + "]" * 300 + "/@id=1",
                        "/=1", "=", "//@id[=1", "//@*=\x1b[2J"):
            with self.subTest(setting[:40]):
                self.refuses("check", self.scene, "--set", setting)
        for parameter in ("x=${x}", "=", "x"):
            self.refuses("check", self.scene, "--param", parameter)

    def test_mistakes_at_the_terminal(self):
        self.run_scene("--ticks", 5, "--quiet", "--record", "run.mcap")
        for arguments, pattern in (
                (("run", ""), "no scene is given"), (("run", self.scene, "--paused"), "needs --endpoint.* or --view"),
                (("fork", "run.mcap", "--at", 2, "--paused"), "needs --endpoint"),
                (("try", "run.mcap", "--robot", "r0", "--", ""), "COMMAND: it names no program"),
                (("run", self.scene, "--hil", "--gate", "late<0"), "'late<0' is never met: nothing is below 0; write late<1"),
                (("export", "run.mcap", "--csv", "-", "--jsonl", "-"), "'-', the file of another format too"),
                *[(("sweep", self.scene, "--out", "y", "--seeds", seeds), "write for example 1..30 or 1,2,5..9")
                  for seeds in ("1..", "..5", "1,,2")],
                (("serve", self.scene, "--curve-secret", "", "--curve-clients", ""), "the value of --curve-.* is empty")):
            with self.subTest(arguments):
                self.refuses(*arguments, pattern=pattern)

    def test_a_controller_without_params_is_told_with_its_line(self):
        self.change('<params script="swing.lua" speed="2" />', "")
        self.refuses("check", self.scene, pattern=r"arms\.argos:\d+:\d+: <params> names no script")

    def test_options_that_would_do_nothing(self):
        self.run_scene("--ticks", 5, "--quiet", "--record", "run.mcap")
        self.write("c", "").chmod(0o600)
        open_sweep = ("sweep", self.scene, "--out", "y", "--seeds", "1..2", "--ticks", 2)
        self.assertEqual(self.ziggurat(*open_sweep, "--quiet").code, 0)
        for arguments, pattern in (
                (("run", self.scene, "--ticks", 2, "--gate", "p99<9s,misses<1%"), "'misses<1%' is always met.*add --hil, or"),
                (("run", self.scene, "--ticks", 2, "--gate", "run<3"), "'run<3' is always met.*--deadline hold:50"),
                (("run", self.scene, "--ticks", 2, "--deadline", "hold:9000", "--gate", "late<1"),
                 "'late<1' is always met: nothing paces.*add --hil or --real-time"),
                (("run", self.scene, "--curve-secret", "k.secret", "--curve-clients", "c"), "none is given; write --endpoint URL"),
                (("run", self.scene, "--insecure"), "--insecure has no effect.*write --endpoint tcp://HOST:PORT"),
                (("serve", self.scene, "--insecure", "--endpoint", "ipc://x"), "--insecure has no effect"),
                (("render", self.scene, "--out", "x.png", "--without-controllers", "--lua-memory", 1),
                 "--lua-memory has no effect with --without-controllers"),
                (("render", self.scene, "--video", "x.mp4", "--at", 1), "--at has no effect without --out"),
                (("replay", "run.mcap", "--insecure"), "--insecure has no effect.*write --view=HOST:PORT too"),
                (("replay", "run.mcap", "--until", 6), "--until is 6, and run.mcap has the ticks 0 to 5; write one"),
                (("try", "run.mcap", "--robot", "r0", "--until", 6, "--", "true"), "--until is 6, and run.mcap has the ticks"),
                (("fork", "run.mcap", "--at", 2, "--without-controllers", "--controller", "swing=true"),
                 "--controller has no effect with --without-controllers"),
                (("verify", "run.mcap", "--controller", "swing=true"), "--controller has no effect without --controllers"),
                (("verify", "run.mcap", "--controllers", "--json"), "--json has no effect with --controllers"),
                (("check", self.scene, "--json", "--quiet"), "--quiet has no effect with --json"),
                (("try", "run.mcap", "--robot", "r0", "--differences", 0, "--", "true"), "--differences is 0; write 1 or more"),
                *[(("keygen", "--out", out), f"'{out}', a folder; write .* as {where}/server")
                  for out, where in ((".", "."), ("x/..", "x/.."), ("run/", "run"))],
                (("run", self.scene, "--snapshot-folder", "."), "--snapshot-folder has no effect.*write --endpoint URL too"),
                (("run", self.scene, "--allow-director"), "--allow-director has no effect.*write --endpoint URL too"),
                (("run", self.scene, "--allow-spawned-scripts", "."), "--allow-spawned-scripts has no effect.* or --view too"),
                (("run", self.scene, "--hil", "--allow-drops"), "--allow-drops has no effect.*write --deadline drop:1000"),
                (("export", "run.mcap", "--csv", "x.csv", "--topics", "/poses"), "--topics has no effect without --jsonl"),
                (("sweep", "results", "y", "--runs", "--by", "seed"), "--by has no effect with --runs"),
                ((*open_sweep, "--slurm", "--kubernetes", "x.yaml"), "--slurm has no effect with --kubernetes"),
                (("top", "tcp://127.0.0.1:1", "--once", "--interval", 2), "--interval has no effect with --once"),
                (("--version", "junk"), "--version takes no 'junk'"), (("--help", "junk"), "no command 'junk'")):
            with self.subTest(arguments):
                self.refuses(*arguments, pattern=pattern)
        for name in ("x.csv", "x.png", "x.mp4", "x.yaml"):
            self.assertFalse((self.folder / name).exists())
        self.assertIn("usage: ziggurat run SCENE", self.ziggurat("--help", "run").out)
        self.assertEqual(self.ziggurat("replay", "run.mcap", "--until", 5, "--quiet").code, 0)

    def test_hostile_lists_of_clients(self):
        subprocess.run([str(ZIGGURAT), "keygen", "--out", "k"], cwd=self.folder, check=True, capture_output=True)
        key = (self.folder / "k.public").read_text().strip()
        for name, text in {"long": "x" * 30_000_000, "none": "# nothing\n", "twice": f"{key} controller\n" * 2,
                           "glob": f"{key} controller robots={'*a' * 1000}\n", "bytes": "\x1b[2J\0\n",
                           "role": f"{key} root\n"}.items():
            clients = self.write(name, text)
            clients.chmod(0o600)
            with self.subTest(name), socket.create_server(("127.0.0.1", 0)) as taken:
                # It is told of its list, and not that the port is taken: it has not listened yet.
                self.refuses("serve", self.scene, "--endpoint", f"tcp://127.0.0.1:{taken.getsockname()[1]}",
                             "--curve-secret", "k.secret", "--curve-clients", clients, pattern=str(clients))

    def test_hostile_recordings(self):
        recording = self.folder / "run.mcap"
        self.run_scene("--ticks", 5, "--quiet", "--record", recording)
        data = recording.read_bytes()
        draw = random.Random(4)
        for number in range(8):
            copy = bytearray(data)
            for _ in range(1 + 5 * number):
                copy[draw.randrange(8, len(copy))] ^= 1 << draw.randrange(8)
            hostile = self.folder / "hostile.mcap"
            hostile.write_bytes(copy[:draw.choice([len(copy), len(copy) * 2 // 3])])
            command = ("info", "verify", "replay", "diff", "export", "try", "info", "verify")[number]
            more = {"diff": [recording], "export": ["--jsonl", "out.jsonl"],
                    "try": ["--robot", "r0", "--script", "swing.lua"]}.get(command, [])
            outcome = self.ziggurat(command, hostile, *more)
            self.assertIn(outcome.code, range(7), f"{command} {outcome.err}")
            self.assert_is_sentence(outcome, ".|^$")

    def test_hostile_sweep_folders(self):
        self.assertEqual(self.ziggurat("sweep", self.scene, "--seeds", 1, "--ticks", 2, "--out", "whole", "--quiet").code, 0)
        kept = (self.folder / "whole" / "experiment.json").read_text()
        for file in ("experiment.json", "sweep.sqlite"):
            for name, make in {"pipe": os.mkfifo, "folder": os.mkdir, "none": lambda path: None,
                               "device": lambda path: path.symlink_to("/dev/zero"),
                               "brackets": lambda path: path.write_text("[" * 1_000_000),
                               "cut": lambda path: path.write_text(kept[:len(kept) // 2]),
                               "colors": lambda path: path.write_text(kept.replace('"axes": []', '"axes": "\x1b[31m"')),
                               }.items():
                hostile = self.folder / f"{file}-{name}"
                shutil.copytree(self.folder / "whole", hostile)
                (hostile / file).unlink()
                make(hostile / file)
                for command in ("status", "results", "resume"):
                    with self.subTest(file=file, name=name, command=command):
                        outcome = self.ziggurat("sweep", command, hostile)
                        self.assertIn(outcome.code, (0, 1), outcome.err)
                        self.assertEqual(outcome.code, 1 if file == "experiment.json" else outcome.code)
                        self.assert_is_sentence(outcome, ".|^$")
                        self.assertNotRegex(outcome.out + outcome.err, "[\x00-\x08\x0b-\x1f\x7f-\x9f]|basic_")

    def test_hostile_ledgers_of_sweeps(self):
        """Rows that the sweep does not have, values without bound, and SQL that would run when it is read."""
        self.assertEqual(self.ziggurat("sweep", self.scene, "--seeds", 1, "--ticks", 2, "--out", "whole", "--quiet").code, 0)
        endless = "WITH RECURSIVE c(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM c) SELECT n"
        for name, code, statements in (
                ("beyond", FAULT, ["UPDATE runs SET run = 2"]), ("none", FAULT, ["UPDATE runs SET run = 0"]),
                ("negative", FAULT, ["UPDATE runs SET run = -9223372036854775807"]),
                ("long", FAULT, ["UPDATE runs SET hash = zeroblob(100000000)"]),
                ("view", FAULT, ["ALTER TABLE runs RENAME TO kept", f"CREATE VIEW runs AS {endless} AS run, 1, 1 FROM c"]),
                ("trigger", 0, [f"CREATE TRIGGER t BEFORE INSERT ON runs BEGIN INSERT INTO metrics {endless}, 1, 1 FROM c; END",
                                "DELETE FROM runs"]),
                ("numbers", 0, ["UPDATE runs SET ticks = 1e999, wall_s = 'nan', seed = 'x', exit_code = 1e300"]),
                ("names", 0, ["INSERT INTO metrics VALUES (1, 'a' || char(10, 27) || '[2J\"', 1)"])):
            folder = self.folder / name
            shutil.copytree(self.folder / "whole", folder)
            with contextlib.closing(sqlite3.connect(folder / "sweep.sqlite", isolation_level=None)) as ledger:
                for statement in statements:
                    ledger.execute(statement)
            for command in ("status", "results", "resume"):
                with self.subTest(name=name, command=command):
                    outcome = self.ziggurat("sweep", command, folder)
                    self.assertEqual(outcome.code, code, outcome.err)
                    self.assert_is_sentence(outcome, ".|^$")
                    self.assertNotRegex(outcome.out + outcome.err, "[\x00-\x08\x0b-\x1f\x7f-\x9f]")

    def test_links_without_end(self):
        loop = self.folder / "loop.argos"
        loop.symlink_to(loop)
        for command in (("run", loop), ("check", loop), ("sweep", self.scene, "--seeds", "1", "--out", loop), ("verify", loop)):
            self.refuses(*command, pattern=r"loop\.argos.*: .*(symbolic links|read)")
            self.assertNotIn("filesystem error", self.ziggurat(*command).err)

    def test_hostile_experiments(self):
        usual = {"scene": '"arms.argos"', "ticks": "1", "seeds": "[1]"}
        for changes in ({"scene": '""'}, {"scene": '"/dev/zero"'}, {"scene": "[1]"}, {"seeds": "[[1]]"}, {"seeds": "[-1]"},
                        {"seeds": '"1..18446744073709551615"'}, {"jobs": "nan"}, {"timeout": "-1"}, {"out": '""'},
                        {"out": '"arms.argos"'}, {"out": '"/dev/null"'}, {"run": '["a\\u0000b"]'},
                        {"run": '["--trace", "arms.argos"]'}, {"run": '["--summary", "x"]'},
                        {"run": "[" + '"--quiet", ' * 100_000 + "]"}, {"k" * 1_000_000: "1"}, {"a": "[" * 100_000},
                        {"seeds": '"' + "s" * 1_000_000 + '"'}, {"scene": '"' + "s" * 1_000_000 + '"'},
                        {"parameters": "[nan]"}, {"parameters": '{"x\\u001b[2J" = 1}'}):
            text = "".join(f"{key} = {value}\n" for key, value in (usual | changes).items())
            with self.subTest(text[-80:]):
                more = () if "out" in changes else ("--out", "results")
                self.refuses("sweep", self.write("e.toml", text), *more)


if __name__ == "__main__":
    unittest.main(verbosity=2)
