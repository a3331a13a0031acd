# SPDX-License-Identifier: MIT
"""Faults of an author: each gives one clear message and exit code 1, never a hang or a crash."""

import os
import socket
import subprocess

from harness import FAULT, FINISHED, LUA, ZIGGURAT, SceneTest, main


class BrokenScene(SceneTest):
    def fails(self, pattern, *arguments):
        checked = self.ziggurat("check", self.scene)
        self.assertEqual(checked.code, FAULT, checked.err)
        self.assert_is_sentence(checked, pattern)
        ran = self.run_scene(*arguments, code=FAULT)
        self.assert_is_sentence(ran, pattern)
        self.assertEqual(ran.out, "", "no tick ran")

    def test_the_unchanged_scene_is_valid(self):
        outcome = self.ziggurat("check", self.scene)
        self.assertEqual((outcome.code, outcome.err), (FINISHED, ""))

    def test_unknown_attribute(self):
        self.change('movable="true" mass="0.05">', 'movable="true" mass="0.05" colour="red">', 1)
        self.fails(r"arms\.argos:\d+:\d+: .*colour")
        outcome = self.ziggurat("check", self.scene, "--lenient")
        self.assertEqual(outcome.code, FINISHED, outcome.err)
        self.assertRegex(outcome.err, r"notice: .*colour")

    def test_lenient_runs_scenes_of_libraries(self):
        self.change("</argos-configuration>", '<loop_functions library="libx" label="x"><a b="1"/></loop_functions>\n</argos-configuration>')
        self.change("<arena", '<arena positional_index="grid"', 1)
        self.fails(r"arms\.argos:\d+:\d+: <loop_functions>.*--lenient")
        for command in (["check"], ["run", "--ticks", "2"], ["render", "--out", self.folder / "a.png"]):
            outcome = self.ziggurat(*command, "--lenient", self.scene)
            self.assertEqual(outcome.code, FINISHED, outcome.err)
            self.assertRegex(outcome.err, r"notice: .*<loop_functions> has no effect: libraries are not loaded")

    def test_a_root_that_is_misspelt_and_an_encoding_that_is_not_read(self):
        self.change("argos-configuration", "argos-config")
        outcome = self.ziggurat("check", self.scene)
        self.assertEqual(outcome.code, FINISHED)
        self.assert_is_sentence(outcome, "<argos-config>; did you mean <argos-configuration>")
        self.scene.write_text('<?xml version="1.0" encoding="EBCDIC"?>\n' + self.text.partition("?>")[2].lstrip())
        self.assert_is_sentence(self.ziggurat("check", self.scene), 'arms.argos:1:31: encoding="EBCDIC" is not read')

    def test_huge_file(self):
        with open(self.scene, "w") as file:
            file.write("<argos-configuration>")
            file.write(" " * (100 << 20))
        self.fails(r"arms\.argos.*(64|--max-scene-size)")

    def test_entity_bomb(self):
        bomb = '<!DOCTYPE x [<!ENTITY a0 "ha">'
        for i in range(1, 30):
            bomb += f'<!ENTITY a{i} "&a{i - 1};&a{i - 1};">'
        self.change('<?xml version="1.0" ?>', '<?xml version="1.0" ?>' + bomb + "]>")
        self.change('speed="2"', 'speed="&a29;"')
        self.fails(r"arms\.argos:\d+")

    def test_no_file_at_that_path(self):
        outcome = self.run_scene(code=FAULT, scene="missing.argos")
        self.assert_is_sentence(outcome, r"missing\.argos")

    def test_folder_instead_of_a_file(self):
        outcome = self.run_scene(code=FAULT, scene=self.folder)
        self.assert_is_sentence(outcome, str(self.folder))

    def test_all_faults_at_once(self):
        self.change('mass="2"', 'mass="-2"', 1)
        self.change('<box id="box1"', '<box id="box0"')
        self.change('script="swing.lua" speed="2"', 'script="missing.lua" speed="2"')
        outcome = self.run_scene(code=FAULT)
        for pattern in (r"-2", r"box0", r"missing\.lua"):
            self.assertRegex(outcome.err, pattern)

    def test_crowded_arena(self):
        self.change('quantity="5"', 'quantity="5000"')
        self.fails(r"arms\.argos:\d+:\d+: .*can")


class BrokenScript(SceneTest):
    def fails(self, pattern):
        for command in ("check", "run"):
            outcome = self.ziggurat(command, self.scene)
            self.assertEqual(outcome.code, FAULT, outcome.err)
            self.assert_is_sentence(outcome, pattern)

    def test_missing(self):
        (self.folder / "swing.lua").unlink()
        line = self.text[:self.text.index("<params")].count("\n") + 1
        self.fails(rf"arms\.argos:{line}:\d+: .*'swing\.lua'")

    def test_syntax_error(self):
        self.write("swing.lua", "function init()\nend\nfunction step( end\n")
        line = self.text[:self.text.index("<params")].count("\n") + 1
        self.fails(rf"arms\.argos:{line}:\d+: .*swing\.lua:3:")


class BrokenArguments(SceneTest):
    def refuses(self, pattern, *arguments):
        outcome = self.ziggurat(*arguments)
        self.assertEqual(outcome.code, FAULT, outcome.out)
        self.assert_is_sentence(outcome, pattern)
        return outcome

    def test_unknown_commands_options_and_values(self):
        self.refuses(r"no command 'rnu'; did you mean 'run'", "rnu", self.scene)
        self.refuses(r"'--tikcs'; did you mean '--ticks'", "run", self.scene, "--tikcs", "3")
        self.refuses(r"--ticks.*'many'", "run", self.scene, "--ticks", "many")
        self.refuses(r"no scene is given", "run")
        self.refuses(r"'swong'.*did you mean 'swing'", "run", self.scene, "--controller", "swong=x")
        self.refuses(r"no controller or director 'xyzzy'; it has: swing", "run", self.scene,
                     "--deadline", "xyzzy=hold:5")
        url = "tcp://127.0.0.1:1"  # not reached: the words are wrong
        self.refuses(r"write: ziggurat ctl \[URL\] pause$", "ctl", url, "pause", "now")
        self.refuses(r"write: ziggurat ctl \[URL\] step \[TICKS\]", "ctl", url, "step", "3", "4")
        self.refuses(r"write: ziggurat ctl \[URL\] remove ENTITY", "ctl", url, "remove")
        self.refuses(r"--seed is for reset", "ctl", url, "pause", "--seed", "3")

    def test_files_that_cannot_be_written(self):
        for option, ending in (("--trace", ".csv"), ("--readings", ".jsonl"), ("--hash-file", ""), ("--summary", ".json"),
                               ("--report-card", ".json")):
            outcome = self.refuses(r"/no/such/folder/x.*No such file", "run", self.scene, option,
                                   "/no/such/folder/x" + ending)
            self.assertEqual(outcome.out, "", "no controller has been started")

    def test_outputs_with_a_wrong_ending(self):
        for option, path, right in (("--trace", "t.json", r"\.csv"), ("--readings", "r.csv", r"\.jsonl"),
                                    ("--rays", "r.json", r"\.jsonl"), ("--summary", "s.txt", r"\.json"),
                                    ("--report-card", "c.png", r"\.json or \.svg")):
            self.refuses(rf"{option} is '{path}'; its name must end with {right}", "run", self.scene,
                         option, path)
        self.refuses(r"--out is 'x.mp4'.*\.png", "render", self.scene, "--out", "x.mp4")

    def test_an_output_that_is_another_file_of_the_run(self):
        before = self.scene.read_bytes()
        self.refuses(r"--hash-file is .*the file of the scene too", "run", self.scene, "--hash-file",
                     self.scene)
        link = self.folder / "link"
        link.symlink_to(self.scene)
        self.refuses(r"--hash-file is .*the file of the scene too", "run", self.scene, "--hash-file", link)
        self.assertEqual(self.scene.read_bytes(), before)
        self.refuses(r"--hash-file is .*the file of --trace too", "run", self.scene, "--trace", "t.csv",
                     "--hash-file", f"../{self.folder.name}/t.csv")
        self.assertFalse((self.folder / "t.csv").exists())

    def test_an_output_that_is_an_include_or_a_script_of_the_scene(self):
        models = self.write("models.xml", "<models/>")
        self.change("<arena ", '<include file="models.xml"/><arena ')
        for path in (models, self.folder / "swing.lua"):
            before = path.read_bytes()
            self.refuses(r"--hash-file is .*(a file of the scene|a Lua script)", "run", self.scene, "--hash-file", path)
            self.assertEqual(path.read_bytes(), before)

    def test_a_list_of_clients_that_all_can_write(self):
        for name in ("k.secret", "clients"):
            self.write(name, "")
        clients = self.folder / "clients"
        clients.chmod(0o646)
        self.refuses(r"--curve-clients is 'clients', which all users can write.*chmod o-w", "serve",
                     self.scene, "--curve-secret", "k.secret", "--curve-clients", "clients")

    def test_files_that_nothing_can_be_read_from(self):
        """To open a pipe without writer would wait without end, and a device has none."""
        self.run_scene("--ticks", 2, "--quiet", "--record", "run.mcap")
        subprocess.run([str(ZIGGURAT), "keygen", "--out", "k"], cwd=self.folder, check=True, capture_output=True)
        key = (self.folder / "k.public").read_text().strip()
        self.write("clients", f"{key} controller\n").chmod(0o600)
        os.mkfifo(self.folder / "pipe", 0o600)
        os.mkfifo(self.folder / "pipe.toml")
        (self.folder / "folder").mkdir(mode=0o700)
        keys = ("serve", self.scene, "--endpoint", "tcp://127.0.0.1:*", "--curve-secret")
        for path in ("pipe", "folder"):
            for arguments in (("run", path), ("render", path, "--out", "a.png"), ("info", path), ("replay", path),
                              ("verify", path), ("diff", "run.mcap", path), ("fork", path, "--at", 1),
                              ("export", path, "--jsonl", "o.jsonl"), ("export", path, "--html", "o.html"),
                              ("try", "run.mcap", "--robot", "r0", "--script", path),
                              ("fork", "run.mcap", "--at", 1, "--script", f"swing.lua={path}"),
                              (*keys, "k.secret", "--curve-clients", path),
                              (*keys, path, "--curve-clients", "clients"),
                              ("run", self.scene, "--set", f"//params/@script={path}")):
                with self.subTest(arguments):
                    self.refuses("not a regular file|is a folder", *arguments)
            self.refuses("not a file with one secret key", "ctl", "tcp://127.0.0.1:1", "status",
                         "--curve-secret", path, "--server-key", key)
        self.refuses("not a regular file", "sweep", "pipe.toml")
        for option, value in (("--robots-file", "pipe"), ("--curve-secret", "pipe")):
            lua = subprocess.run([str(LUA), "--connect", "tcp://127.0.0.1:1", option, value, "--server-key", key],
                                 cwd=self.folder, timeout=60, capture_output=True, text=True)
            self.assertEqual(lua.returncode, FAULT)
            self.assertIn("pipe", lua.stderr)

    def test_numbers_that_cannot_be_meant(self):
        for value in ("1e-300", "0", "1e300", "nan", "-1"):
            self.refuses(r"--real-time", "run", self.scene, f"--real-time={value}")
        self.refuses("it must be 1e-06 to 1e.06", "run", self.scene, "--real-time=1e-300")

    def test_images_that_no_memory_holds(self):
        camera = ('<cameras implementation="default"><camera id="c" anchor="origin" position="0,0,0.1"'
                  ' orientation="0,0,0" range="0.1:2" focal_length="2000,2000" image="true"'
                  ' principal_point="2048,2048" resolution="4096,4096" /></cameras>')
        self.change("</sensors>", camera + "</sensors>")
        robots = self.text[self.text.index("<prototype"):self.text.index("</prototype>") + 12]
        self.change("</arena>", "".join(
            robots.replace('id="r0"', f'id="x{i}"').replace("0,0,0", f"0,0,{i}", 1) for i in range(30))
            + "</arena>")
        self.refuses(r"cameras take images of 1\.5 GiB at every tick; 1 GiB", "run", self.scene)

    def test_limits_of_the_system(self):
        for option, value, what in (("-n", 8, "8 open files"), ("-v", 200000, "200000 KiB of address"),
                                    ("-s", 256, "256 KiB of stack")):
            outcome = self.finish(subprocess.Popen(
                ["sh", "-c", f'ulimit {option} {value} && exec "$@"', "sh", ZIGGURAT, "run", self.scene],
                cwd=self.folder, env=self.environment, text=True, stdout=subprocess.PIPE,
                stderr=subprocess.PIPE))
            self.assertEqual(outcome.code, FAULT, outcome.err)
            self.assert_is_sentence(outcome, rf"{what}.*it needs \d+ or more; write: ulimit {option}")
        outcome = self.finish(subprocess.Popen(
            ["sh", "-c", 'ulimit -f 2 && exec "$@"', "sh", ZIGGURAT, "run", self.scene, "--trace", "t.csv"],
            cwd=self.folder, env=self.environment, text=True, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE))
        self.assertEqual(outcome.code, FAULT, outcome.err)
        self.assert_is_sentence(outcome, r"t\.csv: cannot be written: File too large")

    def limited(self, option, value, *arguments, stdout=subprocess.PIPE):
        return self.finish(subprocess.Popen(
            ["sh", "-c", f'ulimit {option} {value} && exec "$@"', "sh", ZIGGURAT, *arguments], cwd=self.folder,
            env=self.environment, text=True, stdout=stdout, stderr=subprocess.PIPE))

    def test_a_limit_of_file_sizes_is_an_error_of_writing_for_every_command(self):
        self.assertEqual(self.ziggurat("run", self.scene, "--ticks", 20, "--record", "r.mcap", "--quiet").code, FINISHED)
        for arguments in (("info", "r.mcap", "--repair", "s.mcap"), ("export", "r.mcap", "--csv", "c.csv"),
                          ("export", "r.mcap", "--jsonl", "c.jsonl")):
            with self.subTest(arguments):
                outcome = self.limited("-f", 0, *arguments)
                self.assertEqual(outcome.code, FAULT, outcome.err)
                self.assertIn("File too large", outcome.err)
        for arguments in (("info", "r.mcap"), ("help",), ("--version",), ("check", self.scene, "--json"),
                          ("diff", "r.mcap", "r.mcap", "--json"), ("export", "r.mcap", "--csv", "-")):
            with self.subTest(arguments), open(self.folder / "out", "w") as out:
                outcome = self.limited("-f", 0, *arguments, stdout=out)
                self.assertEqual(outcome.code, FAULT, outcome.err)
                self.assertIn("File too large", outcome.err)
        self.assertEqual([each.name for each in self.folder.glob("[cs].*")], [])

    def test_a_limit_of_the_stack_is_told_by_every_command(self):
        for arguments in (("check", self.scene), ("info", "r.mcap"), ("diff", "r.mcap", "s.mcap")):
            outcome = self.limited("-s", 64, *arguments)
            self.assertEqual(outcome.code, FAULT, outcome.err)
            self.assert_is_sentence(outcome, r"64 KiB of stack; it needs 1024 or more; write: ulimit -s")

    def test_full_disk(self):
        for option in ("--trace", "--readings", "--hash-file", "--summary"):
            self.refuses(r"/dev/full.*No space left", "run", self.scene, option, "/dev/full")

    def test_names_that_are_not_utf8(self):
        odd = os.fsdecode(b"n\xff.argos")
        (self.folder / odd).write_text(self.text)
        self.assertEqual(self.ziggurat("run", odd, "--ticks", 1, "--quiet").code, FINISHED)
        self.refuses(r"n.*\.argos: the name is not UTF-8, as names in a recording are; rename it",
                     "run", odd, "--ticks", 1, "--quiet", "--record", "r.mcap")
        self.refuses(r"not UTF-8, as a manifest must be; rename it",
                     "sweep", self.scene, "--seeds", "1..2", "--out", os.fsdecode(b"o\xff"), "--kubernetes", "job.yaml",
                     "--image", "i", "--claim", "c", "--mount", self.folder)
        served = self.start("serve", self.scene, "--json", "--endpoint", os.fsdecode(b"ipc://s\xff"))
        self.assertIn('"endpoint":"ipc://s\ufffd"', served.stdout.readline())
        self.interrupt(served)
        self.finish(served)

    def test_foreign_address_needs_insecure(self):
        self.refuses(r"0\.0\.0\.0.*--insecure", "run", self.scene, "--endpoint", "tcp://0.0.0.0:0")

    def test_invalid_endpoint(self):
        self.refuses(r"nonsense", "run", self.scene, "--endpoint", "nonsense")

    def test_port_in_use(self):
        with socket.socket() as other:
            other.bind(("127.0.0.1", 0))
            other.listen()
            port = other.getsockname()[1]
            for command in ("run", "serve"):
                self.refuses(rf"127\.0\.0\.1:{port}.*taken", command, self.scene,
                             "--endpoint", f"tcp://127.0.0.1:{port}")


if __name__ == "__main__":
    main()
