#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that each row of the tables of docs/security.md names a test, and that each named test exists.

usage: check_security.py [ROOT]     ROOT is the top of the checkout (default: this file's)

A table whose last column is "Tests" has in each row at least one name `WHERE:TEST` in backquotes. WHERE is a folder
below tests/ (`network`), or a test program (`uninvited` is uninvited_test.py). TEST is Suite.Name or Suite of Google
Test, or a function or class of a script. Each violation is printed as file:line: text; the exit code is 1 if there is
any.
"""

import pathlib
import re
import sys

DOCUMENT = "docs/security.md"
NAME = re.compile(r"`([\w/]+):([\w.]+)`")


def faults_of_rows(text):
    tests = False  # whether the present table has that column
    for number, line in enumerate(text.splitlines(), 1):
        if not line.startswith("|"):
            tests = False
        elif re.search(r"\| Tests \|$", line):
            tests = True
        elif tests and not line.startswith("|--") and not NAME.search(line.rstrip("| ").rpartition(" | ")[2]):
            yield number, f"names no test: {line[:80]}"


def places(root, where):
    """Files of tests that `where` names."""
    folders = [root / "tests" / where, root / "tests/unit" / where]
    found = [path for folder in folders if folder.is_dir() for path in folder.rglob("*_test.cpp")]
    for suffix in ("py", "mjs"):
        found += (root / "tests").rglob(f"{where}_test.{suffix}")
    return found


def has_test(text, name, suffix):
    if suffix == ".cpp":
        suite, _, test = name.partition(".")
        behind = rf"\s*,\s*{test}\b" if test else ""
        return re.search(rf"TEST(_F|_P)?\({suite}\b{behind}", text) is not None
    outer, _, inner = name.rpartition(".")
    parts = [part for part in (outer, inner) if part]
    return all(re.search(rf"^\s*(class|(async )?def|async)\s+(test_)?{part}\b", text, re.M)
               for part in parts)


def faults_of_names(root, text):
    for number, line in enumerate(text.splitlines(), 1):
        for where, name in NAME.findall(line):
            files = places(root, where)
            if not files:
                yield number, f"there are no tests {where}"
            elif not any(has_test(path.read_text(), name, path.suffix) for path in files):
                yield number, f"there is no test {name} in {where}"


def main(root):
    text = (root / DOCUMENT).read_text()
    faults = sorted([*faults_of_rows(text), *faults_of_names(root, text)])
    for line, fault in faults:
        print(f"{DOCUMENT}:{line}: {fault}")
    if not faults:
        print(f"{DOCUMENT} names {len(set(NAME.findall(text)))} tests, and all exist")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[1])))
