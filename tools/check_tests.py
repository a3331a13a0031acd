#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Finds tests that no run has: neither ./quickstart test nor ./quickstart test-all.

usage: check_tests.py [ROOT]     ROOT is the top of the checkout (default: this file's)

./quickstart test-all runs every test that ctest knows, so a test is lost where ctest does not know it. Each
file NAME_test.cpp, NAME_test.py, NAME_test.mjs and NAME_fuzzer.cpp below tests/ is named, with or without its
ending, by a CMakeLists.txt in its folder or above; those in tests/tools by tools/check. No case is switched
off (DISABLED_, unittest.skip). Each violation is printed as file:line: text; the exit code is 1 if there
is any.
"""

import re
import sys

from checkout import named_root

TEST = re.compile(r"(?P<stem>(?P<name>\w+?)_(?:test|fuzzer))\.(?:cpp|py|mjs)")
SWITCHED_OFF = re.compile(r"\s*(?:TEST\w*\(.*\bDISABLED_|@unittest\.skip\(|(?:test|it|describe)\.(?:skip|todo)\()")


def is_named(words, match):
    return bool({match[0], match["stem"], match["name"]} & words)


def words_of(path):
    """Words of a list of tests, without comments; `folder/name` counts as `name`."""
    return set(re.findall(r"\w+(?:\.(?:cpp|py|mjs))?", re.sub(r"#.*", "", path.read_text())))


def lists_of(root, folder):
    """Files that name the tests of a folder."""
    if folder == root / "tests/tools":
        return [root / "tools/check"]
    above = [folder, *folder.parents]
    return [place / "CMakeLists.txt" for place in above[:above.index(root / "tests") + 1]
            if (place / "CMakeLists.txt").is_file()]


def tests_of(root):
    for path in sorted((root / "tests").rglob("*")):
        match = TEST.fullmatch(path.name)
        if match and "node_modules" not in path.parts:
            yield path, match


def faults(root):
    words = {}
    for path, match in tests_of(root):
        lists = lists_of(root, path.parent)
        for file in lists:
            words.setdefault(file, words_of(file))
        if not any(is_named(words[file], match) for file in lists):
            names = " or ".join(str(file.relative_to(root)) for file in lists[:2]) or "a CMakeLists.txt"
            yield f"{path.relative_to(root)}:1: no test runs this file; name it in {names}"
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if SWITCHED_OFF.match(line):
                yield (f"{path.relative_to(root)}:{number}: this case is switched off; mend it, or skip it where it can't run, "
                       "with the reason (GTEST_SKIP, skipUnless)")


def main():
    root = named_root(__doc__)
    found = list(faults(root))
    for fault in found:
        print(fault)
    if not found:
        print(f"{sum(1 for _ in tests_of(root))} files of tests: a test runs each")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
