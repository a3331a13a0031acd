"""Makes ziggurat/protocol_pb2.py from the protocol's .proto while the package is built."""

import pathlib
import subprocess

from setuptools import setup
from setuptools.command.build_py import build_py

HERE = pathlib.Path(__file__).resolve().parent
MESSAGES = HERE.parents[1] / "protocol" / "ziggurat" / "v1"


class BuildMessages(build_py):
    """Needs protoc (Debian: protobuf-compiler)."""

    def run(self):
        super().run()
        target = pathlib.Path(self.build_lib) / "ziggurat"
        target.mkdir(parents=True, exist_ok=True)
        subprocess.run(["protoc", f"-I{MESSAGES}", f"--python_out={target}", "protocol.proto"],
                       check=True)


setup(cmdclass={"build_py": BuildMessages})
