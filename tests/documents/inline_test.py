# SPDX-License-Identifier: MIT
"""Commands and options that documents name in running text and tables exist.

A command in a text, as `ziggurat ctl pause`, must be one of the program's, and its options must be in its help; an option
alone, as `--record`, in the help of one of our programs.
"""

import functools
import os
import pathlib
import re
import subprocess
import unittest

from documents import FENCE, ROOT, pages

BIN = pathlib.Path(os.environ.get("ZIGGURAT_BUILD", ROOT / "build/release")) / "bin"
SPAN = re.compile(r"(?<!`)`([^`\n]+)`(?!`)")
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z_-]*")
# Options of unshare, docker, tests, an example and other simulators.
OF_OTHERS = {"--bind", "--fast", "--gtest_filter", "--gtest_list_tests", "--only", "--pause", "--playback", "--read-only",
             "--test-name-pattern", "--tmpfs"}


def told(*command):
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False, cwd=ROOT)
    return done.stdout + done.stderr


@functools.cache
def commands():
    return re.findall(r"^  (\w+)  ", told(BIN / "ziggurat", "help"), re.MULTILINE)


@functools.cache
def help_of(command):
    parts = ("status", "results", "plot", "resume", "worker") if command == "sweep" else ()
    return told(BIN / "ziggurat", "help", command, "--all") + "".join(told(BIN / "ziggurat", command, part, "--help") for part in parts)


@functools.cache
def all_options():
    texts = [help_of(command) for command in commands()] + [told(BIN / "ziggurat", "help")]
    kit = ("/usr/bin/python3", "-B", BIN / "ziggurat-conformance")
    texts += [told(BIN / "ziggurat-lua", "--help"), *(told(*kit, *part, "--help") for part in ((), ("server",), ("client",)))]
    texts += [(ROOT / path).read_text() for path in ("tests/scenes/construction/perturb.py", "clients/python/examples/avoid.py",
                                                     "quickstart", "bench/run", "tests/fresh-machine/run")]
    return set(OPTION.findall(" ".join(texts))) | set(OF_OTHERS)


def spans(page):
    """(line, code) of code in running text."""
    inside = False
    for number, line in enumerate((ROOT / page).read_text(encoding="utf-8").splitlines(), 1):
        if FENCE.fullmatch(line):
            inside = not inside
        elif not inside:
            yield from ((number, span) for span in SPAN.findall(line))


def faults_of(span):
    words = re.match(r"ziggurat (\w+)", span)
    if not words and not span.startswith("--"):
        return
    if words and words[1] not in commands():
        yield f"ziggurat has no command '{words[1]}'"
        return
    known = set(OPTION.findall(help_of(words[1]))) | {"--json", "--all"} if words else all_options()
    for option in OPTION.findall(span.split(" -- ")[0]):
        if option not in known:
            yield f"no option {option}"


class Inline(unittest.TestCase):
    def test_commands_and_options_exist(self):
        count = 0
        for page in pages():
            for number, span in spans(page):
                with self.subTest(f"{page}:{number}: {span}"):
                    count += bool(OPTION.search(span) or span.startswith("ziggurat "))
                    self.assertEqual(list(faults_of(span)), [])
        self.assertGreater(count, 100)
        print(f"{count} commands and options in running text")


if __name__ == "__main__":
    unittest.main()
