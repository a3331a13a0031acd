#!/usr/bin/env python3
"""Checks that each sentence of docs/security.md names a test, and that each named test exists.

usage: check_security.py [ROOT]     ROOT is the top of the checkout (default: this file's)

Behind the first heading of the second level, each sentence of a list and each row of a table has at
least one name `WHERE:TEST` in backquotes, and no other text stands there but examples in code. Nothing
holds "by construction": that is no test. WHERE is
a folder below tests/ (`network`), or a test program (`uninvited` is uninvited_test.py). TEST is
Suite.Name or Suite of Google Test, or a function or class of a script. A sentence in _italics_ is advice
and names none. Each violation is printed as file:line: text; the exit code is 1 if there is any.
"""

import pathlib
import re
import sys

DOCUMENT = "docs/security.md"
NAME = re.compile(r"`([\w/]+):([\w.]+)`")
SENTENCE = re.compile(r"(?<=[.!?])\s+(?=[A-Z`_(])|(?<=_)\s+(?=[A-Z`])")


def blocks(text):
    """(first line, text) of each paragraph, list item and table row behind the first heading."""
    block, first, is_code, is_begun = [], 0, False, False
    for number, line in enumerate(text.splitlines() + [""], 1):
        is_code ^= line.startswith("```")
        ends = not line.strip() or line.startswith(("#", "- ", "|", "```")) or is_code
        if ends and block:
            yield first, " ".join(block)
            block = []
        is_begun |= line.startswith("## ")
        is_text = line.strip() and not line.startswith(("#", "    ", "```")) and not is_code
        if is_begun and is_text:
            first = first if block else number
            block.append(line.strip())


def faults_of_form(text):
    rows = 0
    for line, block in blocks(text):
        rows = rows + 1 if block.startswith("|") else 0
        if rows in (1, 2):  # a table's head
            continue
        if not block.startswith(("|", "- ")):
            yield line, "this stands in no list and no table; write it as items that name tests"
            continue
        sentences = [block] if rows else SENTENCE.split(block.removeprefix("- "))
        for sentence in sentences:
            if "by construction" in sentence.lower():
                yield line, f"by construction is no test: {sentence[:80]}"
            if not NAME.search(sentence) and not re.fullmatch(r"_.*_\.?", sentence):
                yield line, f"names no test: {sentence[:80]}"


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
    faults = sorted([*faults_of_form(text), *faults_of_names(root, text)])
    for line, fault in faults:
        print(f"{DOCUMENT}:{line}: {fault}")
    if not faults:
        print(f"{DOCUMENT} names {len(set(NAME.findall(text)))} tests, and all exist")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[1])))
