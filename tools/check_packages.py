#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares the package lists, which quickstart installs, with docs/packages.md, which gives the reasons.

usage: check_packages.py     exit code 1 if a package is in one of them only
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
LISTS = ["build", "test", "clang", "test-all"]


def listed(name):
    """The packages of tools/packages-NAME.txt."""
    lines = (ROOT / f"tools/packages-{name}.txt").read_text().splitlines()
    return [line.split("#")[0].strip() for line in lines if line.split("#")[0].strip()]


def main():
    in_lists = {package for name in LISTS for package in listed(name)}
    table = re.search(r"^\| Package.*?\n\n", (ROOT / "docs/packages.md").read_text(), re.M | re.S)
    if not table:
        print("docs/packages.md: there is no table that begins with '| Package'")
        return 1
    rows = [line.split("|")[1] for line in table.group(0).splitlines()[2:] if line.strip()]
    in_document = {package for row in rows for package in re.findall(r"`([^`]+)`", row)}
    for package in sorted(in_lists - in_document):
        print(f"docs/packages.md: {package} is installed, and no reason is given")
    for package in sorted(in_document - in_lists):
        print(f"docs/packages.md: {package} is named, and nothing installs it")
    if in_lists == in_document:
        print(f"{len(in_lists)} packages: each is installed and has its reason")
    return 0 if in_lists == in_document else 1


if __name__ == "__main__":
    sys.exit(main())
