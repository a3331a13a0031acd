#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What ctest's last run was: each case that failed, with the command that runs it alone, and a line of totals.

usage: test_summary.py BUILD      the folder of the build, after ctest --output-junit BUILD/tests.xml

quickstart calls it behind ctest. A case is one of Google Test, of Python's unittest, of Node's test runner or of
the conformance kit; where no case says that it failed, the test as a whole is named. Tests that were not run
are named, too. The exit code is 0.
"""

import json
import pathlib
import re
import shlex
import subprocess
import sys
import xml.etree.ElementTree

GOOGLE = re.compile(r"^\[  FAILED  \] ([\w/]+\.[\w/]+)(?:,| \(|$)", re.M)
GOOGLE_BEGIN = re.compile(r"^\[ RUN      \] (\S+)", re.M)
GOOGLE_END = re.compile(r"^\[ (?:      OK|  FAILED|  SKIPPED) \] ([^\s,]+)", re.M)
UNITTEST = re.compile(r"^(?:FAIL|ERROR): \w+ \(([\w.]+)\)", re.M)
NODE = re.compile(r"^\s*not ok \d+ - (.+)$", re.M)
KIT = re.compile(r"^(?:\x1b\[\d+m)?fail(?:\x1b\[0?m)? +([A-Z]\d\S*):", re.M)


COUNT = re.compile(r"^(?:\[==========\] (\d+) tests? from .* ran\.|Ran (\d+) tests?|# tests (\d+)$|(\d+) cases in )", re.M)


def commands(build):
    """Name of each test → its command, its environment and its folder."""
    shown = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], capture_output=True, text=True,
                           check=True)
    found = {}
    for test in json.loads(shown.stdout)["tests"]:
        properties = {entry["name"]: entry["value"] for entry in test.get("properties", [])}
        environment = [line for line in properties.get("ENVIRONMENT", []) if not line.startswith("GTEST_")]
        found[test["name"]] = (test.get("command", []), environment, properties.get("WORKING_DIRECTORY", "."))
    return found


def cases(output):
    """(case, option that chooses it) of each failed case in what a test printed."""
    found = [(name, f"--gtest_filter={name}") for name in GOOGLE.findall(output)]
    begun, ended = GOOGLE_BEGIN.findall(output), GOOGLE_END.findall(output)
    if begun and begun[-1] not in ended:  # a crash
        found.append((begun[-1], f"--gtest_filter={begun[-1]}"))
    for name in UNITTEST.findall(output):
        case = ".".join(name.split(".")[-2:])
        found.append((case, f"-k {case}"))
    found += [(name, "") for name in NODE.findall(output)]
    found += [(name, f"--only {name}") for name in KIT.findall(output)]
    return list(dict.fromkeys(found))


def alone(build, test, command, option):
    """The command line that runs one case; without an option for it, that of the test."""
    words, environment, folder = command
    if not option or not words:
        return f"ctest --test-dir {build} --output-on-failure -R '^{re.escape(test)}$'"
    if "--" in words and option.startswith("--only"):
        place = words.index("--")
        words, rest = words[:place] + option.split(), words[place:]
    else:
        words, rest = words + option.split(), []
    line = shlex.join([*(["env", *environment] if environment else []), *words, *rest])
    is_script = not option.startswith("--")  # it may look for files beside it
    return f"(cd {folder} && {line})" if is_script else line


def totals(suite):
    """A line: tests that passed, the cases in all of them, the duration."""
    results = suite.findall("testcase")
    counts = {status: sum(result.get("status") == status for result in results) for status in ("run", "fail", "notrun")}
    text = "".join((result.findtext("system-out") or "") + "\n" for result in results)
    number = sum(int(count) for match in COUNT.findall(text) for count in match if count)
    seconds = round(float(suite.get("time", 0)))
    return (f"{counts['run']} of {len(results)} tests passed, {counts['fail']} failed, {counts['notrun']} not run; "
            f"{number} cases in {seconds // 60} min {seconds % 60} s")


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__.strip())
        return 0 if sys.argv[1:] in (["--help"], ["-h"]) else 2
    build = sys.argv[1]
    suite = xml.etree.ElementTree.parse(pathlib.Path(build) / "tests.xml").getroot()
    known = None
    for result in suite.findall("testcase"):
        test, output = result.get("name"), result.findtext("system-out") or ""
        if result.get("status") == "notrun":
            print(f"not run: {test}: {(output.strip().splitlines() or ['no reason is given'])[-1]}")
        if result.get("status") == "fail":
            known = known or commands(build)
            print(f"failed: {test}")
            for case, option in cases(output) or [("no case is named", "")]:
                print(f"    {case}\n        {alone(build, test, known[test], option)}")
    print(totals(suite))
    return 0


if __name__ == "__main__":
    sys.exit(main())
