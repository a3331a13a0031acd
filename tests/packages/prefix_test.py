# SPDX-License-Identifier: MIT
"""An installation below a prefix, moved to another place: programs find what belongs to them, and `new` makes what runs."""

import gzip
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

BUILD = pathlib.Path(os.environ["ZIGGURAT_BUILD"])


class Prefix(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        first = pathlib.Path(cls.folder.name) / "first"
        subprocess.run(["cmake", "--install", str(BUILD), "--prefix", str(first)], check=True, stdout=subprocess.DEVNULL)
        cls.prefix = first.rename(first.parent / "prefix")  # no file may know where it was installed
        libraries = next(cls.prefix.rglob("libziggurat.so")).parent
        python = next(cls.prefix.rglob("dist-packages"))
        # `python3` is the one that has pyzmq and protobuf.
        interpreter = cls.prefix.parent / "interpreter"
        interpreter.mkdir()
        (interpreter / "python3").symlink_to("/usr/bin/python3")
        cls.environment = dict(
            os.environ, PATH=f"{cls.prefix}/bin:{interpreter}:{os.environ['PATH']}", PYTHONPATH=str(python),
            CMAKE_PREFIX_PATH=str(cls.prefix), LD_LIBRARY_PATH=str(libraries), CXX=os.environ["ZIGGURAT_COMPILER"],
            CXXFLAGS=f"-fsanitize={os.environ['ZIGGURAT_SANITIZE']}" if os.environ["ZIGGURAT_SANITIZE"] else "")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_in(self, folder, *command):
        done = subprocess.run([str(word) for word in command], cwd=folder, env=self.environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(done.returncode, 0, done.stdout)
        return done.stdout

    def test_scenes_are_found_by_name(self):
        out = self.run_in("/", "ziggurat", "run", "vehicle", "--ticks", "2", "--hash")
        source = BUILD / "share/ziggurat/scenes/vehicle.argos"
        self.assertEqual(out.split()[-1], self.run_in("/", "ziggurat", "run", source, "--ticks", "2", "--hash").split()[-1])
        self.run_in("/", "ziggurat", "check", "stacking", "construction/pyramid", "--quiet")

    def test_each_scene_is_listed_once_with_a_sentence(self):
        scenes = json.loads(self.run_in("/", "ziggurat", "scenes", "--json"))
        files = {str(pathlib.Path(each["path"]).resolve()) for each in scenes}
        there = {str(each.resolve()) for each in (self.prefix / "share/ziggurat/scenes").rglob("*.argos")
                 if each.parent.name != "models"}
        self.assertEqual(files, there)
        self.assertEqual(len(scenes), len(files))
        for each in scenes:
            self.assertRegex(each["sentence"], r"^[A-Z].{20,}[.?)]$", each["name"])
        self.assertIn("vehicle", [each["name"] for each in scenes])

    def test_an_unknown_name_gets_advice(self):
        done = subprocess.run(["ziggurat", "run", "vehicl"], env=self.environment, stderr=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("no scene of that name is installed; did you mean 'vehicle'?", done.stderr)

    def test_new_makes_what_its_readme_says(self):
        for language in ("lua", "python", "cpp"):
            with self.subTest(language), tempfile.TemporaryDirectory() as folder:
                self.run_in(folder, "ziggurat", "new", "explorer", f"--{language}")
                readme = (pathlib.Path(folder) / "explorer/README.md").read_text()
                self.assertNotIn("@", readme)
                commands = readme.split("```sh\n")[1].split("```")[0]
                self.assertIn("./test", commands)
                out = self.run_in(folder, "bash", "-euc", commands)
                self.assertRegex(out, r"good: drove \d\.\d\d m, twice the same")
                self.run_in(pathlib.Path(folder) / "explorer", "ziggurat", "check", "scene.argos", "--strict")

    def test_new_replaces_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "there").mkdir()
            for name, complaint in (("there", "it exists"), ("a/b", "No such file"), ("a b", "is no name")):
                done = subprocess.run(["ziggurat", "new", name], cwd=folder, env=self.environment, text=True,
                                      stderr=subprocess.PIPE)
                self.assertEqual(done.returncode, 1)
                self.assertIn(complaint, done.stderr)
            self.assertEqual(os.listdir(pathlib.Path(folder) / "there"), [])

    def test_each_command_has_a_manual_page(self):
        text = self.run_in("/", "ziggurat", "help")
        commands = [line.split()[0] for line in text.split("\n\n")[2].splitlines()]
        self.assertIn("run", commands)
        for name in ["ziggurat", "ziggurat-lua", "ziggurat-conformance", *(f"ziggurat-{each}" for each in commands)]:
            page = gzip.decompress((self.prefix / f"share/man/man1/{name}.1.gz").read_bytes()).decode()
            for section in ("NAME", "SYNOPSIS", "DESCRIPTION"):
                self.assertIn(f".SH {section}\n", page, name)
        page = gzip.decompress((self.prefix / "share/man/man1/ziggurat-run.1.gz").read_bytes()).decode()
        self.assertIn("\\fB\\-\\-seed\\fR \\fIN\\fR\n", page)
        if shutil.which("man"):
            shown = self.run_in("/", "man", "--warnings", self.prefix / "share/man/man1/ziggurat-run.1.gz")
            self.assertNotIn("warning", shown)

    def test_no_file_has_the_path_of_the_build(self):
        for path in self.prefix.rglob("*"):
            if path.is_file() and path.stat().st_size < 1 << 20 and not path.is_symlink():
                self.assertNotIn(str(BUILD).encode(), path.read_bytes(), path)
        for program in ("ziggurat", "ziggurat-lua"):
            out = self.run_in("/", "readelf", "-d", self.prefix / "bin" / program)
            self.assertNotRegex(out, "RPATH|RUNPATH")

    def test_the_library_shows_only_its_own_names(self):
        library = next(self.prefix.rglob("libziggurat.so")).resolve()
        self.assertRegex(library.name, r"^libziggurat\.so\.\d+\.\d+\.\d+$")
        names = self.run_in("/", "nm", "-DC", "--defined-only", library).splitlines()
        shown = [line.split(maxsplit=2)[2] for line in names]
        self.assertTrue(any(name.startswith("ziggurat::Session::next") for name in shown))
        own = re.compile(r"((typeinfo|typeinfo name|vtable) for )?ziggurat::(?!v1)")
        self.assertEqual([name for name in shown if not own.match(name)], [])


if __name__ == "__main__":
    unittest.main()
