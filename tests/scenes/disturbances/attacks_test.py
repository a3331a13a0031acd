"""Hostile files, settings, requests and servers, each against the real program: a sentence, and it goes on."""

import contextlib
import os
import pathlib
import random
import shutil
import socket
import sqlite3
import subprocess
import sys
import tempfile
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

    def refuses(self, *arguments, pattern="."):
        outcome = self.ziggurat(*arguments)
        self.assertEqual(outcome.code, FAULT, f"{arguments}\n{outcome.out[:2000]}\n{outcome.err[:2000]}")
        self.assert_is_sentence(outcome, pattern)
        self.assertNotRegex(outcome.err, "[\x00-\x08\x0b-\x1f\x7f-\x9f]")
        self.assertLess(len(outcome.err), 500_000, "long texts are quoted in part")

    # --- files and settings ---------------------------------------------------------------------

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
                        BOX.format("b", "0,0,2").replace('"1"', '"1e300"')):
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

    def test_a_restore_that_repeats_a_run_is_not_silent(self):
        """Rule M6: without solver="newton" all ticks are computed again."""
        boxes = "".join(BOX.format(f"b{i}", f"{i},0,0") for i in range(10))
        self.scene = self.write("slow.argos", f"""<argos>
            <framework><experiment length="0" ticks_per_second="10" random_seed="1" /></framework><controllers />
            <arena size="50,50,10" center="0,0,5">{boxes}</arena>
            <physics_engines><dynamics3d id="d" solver="sweeps" iterations="3000"><floor /><gravity g="9.8" /></dynamics3d>
            </physics_engines><media /></argos>""")
        process = self.start("serve", self.scene, "--endpoint", "tcp://127.0.0.1:*", "--duration", 0, "--paused")
        self.endpoint = process.stdout.readline().split()[1]
        with Supervisor(self.endpoint) as supervisor, Supervisor(self.endpoint) as other:
            begin = time.monotonic()
            while time.monotonic() - begin < 8:  # repeating them takes less
                self.assertEqual(supervisor.ask(step=v1.StepRequest(ticks=1)), "")
            self.assertEqual(supervisor.ask(snapshot=v1.SnapshotRequest(name="late")), "")
            other.number = 1
            other.send_message(v1.ClientMessage(request=v1.Request(
                id=1, restore=v1.RestoreRequest(name="late"))).SerializeToString())
            silences, begin = [], time.monotonic()
            while not silences or kind != "response":
                before = time.monotonic()
                kind = v1.ServerMessage.FromString(other._receive_frame()).WhichOneof("message")
                silences.append(time.monotonic() - before)
            self.assertGreater(time.monotonic() - begin, 2)
            self.assertLess(max(silences), 1.8)
        self.end(process)

    # --- HTTP -----------------------------------------------------------------------------------

    def ask_port(self, port, request):
        with socket.create_connection(("127.0.0.1", port), timeout=20) as connection:
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
                code=v1.Error.FORBIDDEN, message="no\x1b]52;c;aGk=\x07\u009b31m\u202ewon")))
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
        server.join()
        router.close(linger=0)

    def test_a_message_without_end_of_frames_is_not_kept(self):
        """By `ctl`, `top` and `ziggurat-lua`, at a server that they have no key of."""
        listener = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(listener.close)
        endpoint = f"tcp://127.0.0.1:{listener.getsockname()[1]}"
        ready = b"\x05READY\x0bSocket-Type\0\0\0\x06ROUTER"
        greeting = b"\xff" + bytes(8) + b"\x7f\x03\x01" + b"NULL".ljust(52, b"\0") + bytes([4, len(ready)]) + ready

        def serve():
            for _ in commands:
                with listener.accept()[0] as connection:
                    connection.sendall(greeting)
                    frames = b"\x01\x07a frame" * 100_000
                    try:
                        for _ in range(500):
                            connection.sendall(frames)
                    except OSError:
                        pass  # the client has left

        commands = [(ZIGGURAT, "ctl", endpoint, "status"), (ZIGGURAT, "top", endpoint, "--once"),
                    (LUA, "--connect", endpoint, "--script", "swing.lua")]
        server = threading.Thread(target=serve)
        server.start()
        for words in commands:
            with self.subTest(words), tempfile.TemporaryFile("w+") as messages:
                program = subprocess.Popen([str(word) for word in words], cwd=self.folder, env=self.environment,
                                           stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=messages)
                _, status, used = os.wait4(program.pid, 0)
                program.returncode = os.waitstatus_to_exitcode(status)
                messages.seek(0)
                self.assertEqual(program.returncode, FAULT)
                self.assertIn("not a message of ziggurat.v1", messages.read())
                self.assertLess(used.ru_maxrss, 100 << 10)  # [KiB]
        server.join()


if __name__ == "__main__":
    unittest.main(verbosity=2)
