#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes docs/scene-reference.md and docs/command-line.md, both from what the program says of itself.

usage: make_reference.py PROGRAM            writes the pages; PROGRAM is ziggurat
       make_reference.py PROGRAM --check    prints how they differ from what it says; exit code 1 if they do

The page of scenes has for each attribute since which version it is there: a new one gets that of the program, the
others keep theirs.
"""

import difflib
import pathlib
import re
import subprocess
import sys

DOCS = pathlib.Path(__file__).resolve().parents[1] / "docs"

SCENE = """# Scene reference

Every element and attribute of a scene, from the reader's own tables: `ziggurat help scene` prints them, and
`ziggurat help scene led` those of elements with that name. This page is written by `tools/make_reference.py` and a
test compares it with the program. What the attributes mean: [scene-format.md](scene-format.md). Types of values:
[Values](scene-format.md#values).

*required*: a fault without it. *none*: may be missing, without a default of its own. *no effect*: read, and told in a
notice. An attribute that only one kind of an element has (`size` of a `magnet` with `shape="box"`, `layout` with
`method="grid"`) is required with that kind. Two of them: it depends on the element's other attributes. `params` and `parameters` have attributes of your own;
`models` has the entities of `arena`, without `body`.

"""

COMMANDS = """# Command line

What `ziggurat help COMMAND --all` prints, for every command. This page is written by `tools/make_reference.py` and a
test compares it with the program.

"""


def said(program, *arguments):
    return subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout


def rows(text):
    """(heading with its places, attribute or None, line) of each line of a page of scenes."""
    heading = ""
    for line in text.splitlines():
        if line.startswith("## "):
            heading = line
        if line.startswith("In "):
            heading += line
        match = re.match(r"\| `(\w+)` \|", line)
        yield heading, match and match[1], line


def versions(page):
    """{(heading, attribute): version} of a page."""
    return {(heading, attribute): line.split("|")[-2].strip() for heading, attribute, line in rows(page) if attribute}


def scene_page(program, old):
    """The page; versions of attributes that the old one has stay."""
    known = versions(old)
    by_name = {(heading.split("In ")[0], attribute): version for (heading, attribute), version in known.items()}
    version = re.search(r"\d+\.\d+", said(program, "--version"))[0]
    page = []
    for heading, attribute, line in rows(said(program, "help", "scene")):
        if attribute:
            element = (heading.split("In ")[0], attribute)  # as it was, where only its places changed
            line += f" {known.get((heading, attribute), by_name.get(element, version))} |"
        elif line.startswith("| Attribute"):
            line += " Since |"
        elif line.startswith("|---"):
            line += "---|"
        page.append(line)
    return SCENE + "\n".join(page) + "\n"


def command_page(program):
    overview = said(program, "help")
    names = [line.split()[0] for line in re.findall(r"^  \w+ +\w.*$", overview, re.MULTILINE) if "ziggurat " not in line]
    page = COMMANDS + f"```text\n{overview.rstrip()}\n```\n"
    for name in names:
        page += f"\n## ziggurat {name}\n\n```text\n{said(program, 'help', name, '--all').rstrip()}\n```\n"
    return page


def main(arguments):
    if len(arguments) not in (1, 2) or arguments[1:] not in ([], ["--check"]):
        sys.exit(__doc__.strip())
    failed = False
    for name, make in (("scene-reference.md", scene_page), ("command-line.md", lambda program, _: command_page(program))):
        path = DOCS / name
        old = path.read_text() if path.exists() else ""
        new = make(arguments[0], old)
        if arguments[1:]:
            difference = list(difflib.unified_diff(old.splitlines(), new.splitlines(), f"docs/{name}", "the program", lineterm=""))
            failed |= bool(difference)
            print("\n".join(difference) or f"docs/{name} is what the program says")
        else:
            path.write_text(new)
    if failed:
        print("to write the pages anew: tools/make_reference.py build/release/bin/ziggurat")
    return failed


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
