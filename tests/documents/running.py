# SPDX-License-Identifier: MIT
"""Runs code blocks of documents as their readers would: in a folder of their own, with an installed Ziggurat.

The folder is a copy of the checkout, with what no command changes linked in, so that paths from the project's folder are right, and has the
files of folders/all and folders/PAGE, which the page's commands take for granted.
"""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from documents import ROOT, name_of

sys.path.insert(0, str(ROOT / "tests"))
from waiting import HANG  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
BUILD = pathlib.Path(os.environ.get("ZIGGURAT_BUILD", ROOT / "build/release"))
COPIED = ("clients/json", "clients/python/examples", "docs", "scenes")  # what commands may write beside
LINKED = ("bench", "tests", "tools")
INTERRUPTED = (0, 130, -signal.SIGINT)


class Fault(Exception):
    pass


class Folder:
    """A reader's terminal: a folder, an environment, and what goes on in other terminals."""

    def __init__(self, page):
        self.top = pathlib.Path(tempfile.mkdtemp(prefix="zd", dir="/tmp"))  # short: sockets live in it
        self.work = self.top / "work"
        self.work.mkdir()
        for name in COPIED:
            shutil.copytree(ROOT / name, self.work / name)
        for name in LINKED:
            (self.work / name).symlink_to(ROOT / name)
        (self.work / "build").mkdir()
        (self.work / "build/release").symlink_to(BUILD)
        for given in ("all", name_of(page)):
            if (HERE / "folders" / given).is_dir():
                shutil.copytree(HERE / "folders" / given, self.work, dirs_exist_ok=True)
        try:
            self.environment = self.installed()
        except Fault:
            self.remove()
            raise

    def installed(self):
        """The environment of a user whose system has Ziggurat's packages."""
        prefix, home, runtime = self.top / "usr", self.top / "home", self.top / "run"
        for folder in (home, runtime):
            folder.mkdir(mode=0o700)
        self.call(["cmake", "--install", str(BUILD), "--prefix", str(prefix)])
        python = f"python3.{sys.version_info.minor}"
        return dict(
            {name: value for name, value in os.environ.items() if not name.startswith(("ZIGGURAT", "PYTHON"))},
            PATH=f"{prefix}/bin:/usr/bin:{os.environ['PATH']}", HOME=str(home), XDG_RUNTIME_DIR=str(runtime),
            PKG_CONFIG_PATH=f"{prefix}/lib/pkgconfig", CMAKE_PREFIX_PATH=str(prefix),
            LD_LIBRARY_PATH=f"{prefix}/lib", LUA_CPATH=f"{prefix}/lib/lua/5.3/?.so;;",
            PYTHONPATH=f"{prefix}/lib/{python}/dist-packages:{prefix}/lib/python3/dist-packages",
            PYTHONDONTWRITEBYTECODE="1", CCACHE_DISABLE="1")

    @staticmethod
    def call(command):
        done = subprocess.run(command, capture_output=True, text=True, timeout=HANG, check=False)
        if done.returncode:
            raise Fault(f"{' '.join(command)}\n{done.stdout}{done.stderr}")

    def start(self, script):
        """A shell in a session of its own; its output goes to a file."""
        output = tempfile.TemporaryFile(mode="w+", dir=self.top, errors="replace")
        process = subprocess.Popen(["bash", "-euc", script], cwd=self.work, env=self.environment,
                                   stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT, start_new_session=True)
        process.output = output
        return process

    def run(self, script, codes=(0,), limit=HANG):
        """Runs a script to its end and returns its output."""
        process = self.start(script)
        try:
            process.wait(timeout=limit)
        except subprocess.TimeoutExpired:
            raise Fault(f"hangs: {script}\n{said(process)}") from None
        finally:
            output = said(process)
            kill(process)
        if process.returncode not in codes:
            raise Fault(f"exit code {process.returncode} of: {script}\n{output}")
        return output

    def start_beside(self, script):
        """Starts what goes on in another terminal, and waits until it says something or ends."""
        process = self.start(script)
        end = time.monotonic() + (HANG if re.search(r"\bziggurat (run|serve|replay)\b", script) else 0.5)
        while time.monotonic() < end and not said(process) and process.poll() is None:
            time.sleep(0.01)
        return process

    def remove(self):
        shutil.rmtree(self.top, ignore_errors=True)


def said(process):
    process.output.seek(0)
    return process.output.read()


def kill(process):
    """Ends what is left of a shell's session."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.wait()
    process.output.close()


def interrupt(process):
    """Ctrl-C; returns the exit code and the whole output."""
    try:
        os.killpg(process.pid, signal.SIGINT)
        process.wait(timeout=HANG)
    except (ProcessLookupError, subprocess.TimeoutExpired):
        pass
    output = said(process)
    kill(process)
    return process.returncode, output
