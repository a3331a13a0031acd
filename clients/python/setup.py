# SPDX-License-Identifier: MIT
"""Makes ziggurat/protocol_pb2.py from the protocol's .proto while the package is built. A source package has the .proto."""

import pathlib
import shutil
import subprocess

from setuptools import setup
from setuptools.command.build_py import build_py
from setuptools.command.sdist import sdist

HERE = pathlib.Path(__file__).resolve().parent
CHECKOUT = HERE.parents[1] if len(HERE.parents) > 1 else HERE


def file_of(name, in_checkout):
    """A file beside this one, as in a source package, or at its place in the checkout."""
    return HERE / name if (HERE / name).is_file() else CHECKOUT / in_checkout


MESSAGES = file_of("protocol.proto", "protocol/ziggurat/v1/protocol.proto")
LICENCE = file_of("LICENSE", "LICENSE")


class BuildMessages(build_py):
    """Needs protoc (Debian: protobuf-compiler)."""

    def run(self):
        super().run()
        target = pathlib.Path(self.build_lib) / "ziggurat"
        target.mkdir(parents=True, exist_ok=True)
        subprocess.run(["protoc", f"-I{MESSAGES.parent}", f"--python_out={target}", MESSAGES.name], check=True)


class WithMessages(sdist):
    """Whose folder has what is elsewhere in the checkout."""

    def make_release_tree(self, base_dir, files):
        super().make_release_tree(base_dir, files)
        for file in (MESSAGES, LICENCE):
            shutil.copy(file, base_dir)


setup(cmdclass={"build_py": BuildMessages, "sdist": WithMessages})
