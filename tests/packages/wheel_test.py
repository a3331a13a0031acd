# SPDX-License-Identifier: MIT
"""The Python package as a wheel and as a source package: typed, whole, and used in a fresh environment."""

import os
import pathlib
import shutil
import subprocess
import tarfile
import tempfile
import unittest
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["ZIGGURAT_BUILD"])
PYTHON = "/usr/bin/python3"  # which has pyzmq and protobuf of Debian


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, **options)
    if done.returncode != 0:
        raise AssertionError(f"{command} failed:\n{done.stdout}")
    return done.stdout


class Wheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        top = pathlib.Path(cls.folder.name)
        # Building writes beside the sources.
        shutil.copytree(ROOT / "clients/python", top / "clients/python", ignore=shutil.ignore_patterns("build", "*.egg-info"))
        shutil.copytree(ROOT / "protocol/ziggurat", top / "protocol/ziggurat")
        shutil.copy(ROOT / "LICENSE", top)
        # A source package first, then the wheel from that alone, as `python3 -m build` does.
        run(PYTHON, "-m", "build", "--no-isolation", "--outdir", top / "dist", top / "clients/python")
        cls.wheel, = (top / "dist").glob("*.whl")
        cls.source, = (top / "dist").glob("*.tar.gz")
        cls.version = (ROOT / "VERSION").read_text().strip()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_files_and_metadata(self):
        self.assertEqual(self.wheel.name, f"ziggurat-{self.version}-py3-none-any.whl")
        with zipfile.ZipFile(self.wheel) as wheel:
            names = wheel.namelist()
            metadata = wheel.read(f"ziggurat-{self.version}.dist-info/METADATA").decode()
        for name in ("py.typed", "protocol_pb2.py", "protocol_pb2.pyi", "devices/joint.py"):
            self.assertIn(f"ziggurat/{name}", names)
        self.assertTrue(any(name.endswith("dist-info/LICENSE") for name in names), names)
        for line in ("License: MIT", "Requires-Python: >=3.9", "Requires-Dist: pyzmq", "Requires-Dist: protobuf",
                     "Classifier: Typing :: Typed", "# Ziggurat: the Python client"):
            self.assertIn(line, metadata)
        with tarfile.open(self.source) as source:
            self.assertIn(f"ziggurat-{self.version}/protocol.proto", source.getnames())

    def test_a_fresh_environment_installs_and_runs_it(self):
        with tempfile.TemporaryDirectory() as folder:
            # No package index: pyzmq, protobuf and numpy are those of the system.
            run(PYTHON, "-m", "venv", "--system-site-packages", f"{folder}/venv")
            python = f"{folder}/venv/bin/python3"
            run(python, "-m", "pip", "install", "--no-index", self.wheel)
            environment = {"PATH": f"{folder}/venv/bin:{BUILD}/bin:/usr/bin:/bin", "HOME": folder}
            where = run(python, "-c", "import ziggurat; print(ziggurat.__file__, ziggurat.__version__)", cwd=folder,
                        env=environment)
            self.assertTrue(where.startswith(f"{folder}/venv/"), where)
            self.assertEqual(where.split()[1], self.version)
            # A server of its own, as for learning: nothing of this checkout is on the path of Python.
            out = run(python, "-c", "import ziggurat\nenv = ziggurat.vector_env('drive.argos', 1, robots='robot')\n"
                      "env.reset(seed=1)\nprint(env.step([[1.0, 1.0]])[0].shape)\nenv.close()",
                      cwd=self.scene(folder), env=environment)
            self.assertRegex(out, r"\(1, \d+\)")

    def scene(self, folder):
        text = (ROOT / "clients/templates/python/scene.argos").read_text().replace(' command="python3 controller.py"', "")
        (pathlib.Path(folder) / "drive.argos").write_text(text)
        return folder

    @unittest.skipUnless(shutil.which("mypy"), "mypy is not installed")
    def test_it_is_typed_strictly_also_for_its_users(self):
        with tempfile.TemporaryDirectory() as cache:
            run("mypy", "--cache-dir", cache, "ziggurat", cwd=ROOT / "clients/python")
            user = pathlib.Path(cache) / "user.py"
            user.write_text("import ziggurat\n\nwith ziggurat.connect() as session:\n    for tick in session:\n"
                            "        seconds: float = tick.time\n        robot = session.robot('fb')\n"
                            "        robot.log(f'{seconds}')\n")
            run("mypy", "--strict", "--cache-dir", cache, user, env={**os.environ, "MYPYPATH": str(ROOT / "clients/python")})
            user.write_text("import ziggurat\n\nziggurat.find_server().nothing()\n")
            with self.assertRaises(AssertionError):
                run("mypy", "--strict", "--cache-dir", cache, user, env={**os.environ, "MYPYPATH": str(ROOT / "clients/python")})


if __name__ == "__main__":
    unittest.main()
