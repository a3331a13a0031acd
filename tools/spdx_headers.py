#!/usr/bin/env python3
"""Gives each source file a line with its licence, `SPDX-License-Identifier: MIT`, or reports those without.

usage: tools/spdx_headers.py           adds the line where it is missing
       tools/spdx_headers.py --check   names the files without; exit code 1 if there are any

Sources are all files of git with the endings of COMMENTS, and scripts that begin with #!. The line is the first, or
stands behind `#!` and `<?xml`. Recorded data, texts and scenes have none: LICENSE is for them.
"""

import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
LICENCE = "SPDX-License-Identifier: MIT"
COMMENTS = {".cpp": "//", ".h": "//", ".inl": "//", ".ts": "//", ".mjs": "//", ".proto": "//", ".css": "/*",
            ".py": "#", ".pyi": "#", ".sh": "#", ".cmake": "#", ".lua": "--", ".map": "#"}
WITHOUT = ("clients/templates/", "docs/", "scenes/", "tests/recording/data/", "tests/fuzz/data/", "clients/web/node_modules/")


def comment_of(path):
    """The word that begins a comment of this file; none: it is no source."""
    if path.name == "CMakeLists.txt":
        return "#"
    if path.suffix in COMMENTS:
        return COMMENTS[path.suffix]
    with path.open("rb") as file:
        return "#" if file.read(2) == b"#!" else None


def sources():
    """(path, word that begins a comment) of each source that git knows."""
    names = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout
    for name in names.split("\0"):
        path = ROOT / name
        is_input = name.endswith(".lua") and not name.startswith("clients/")  # of tests, which name its lines
        if not name or is_input or name.startswith(WITHOUT) or path.is_symlink() or not path.is_file():
            continue
        comment = comment_of(path)
        if comment:
            yield path, comment


def has_header(text):
    return any(LICENCE in line for line in text.splitlines()[:3])


def with_header(text, comment):
    line = f"{comment} {LICENCE}{' */' if comment == '/*' else ''}\n"
    first, rest = text.split("\n", 1) if text.startswith("#!") else ("", text)
    return f"{first}\n{line}{rest}" if first else line + text


def main(arguments):
    if arguments not in ([], ["--check"]):
        print(__doc__.strip())
        return 2
    missing = 0
    for path, comment in sources():
        text = path.read_text()
        if has_header(text):
            continue
        missing += 1
        if arguments:
            print(f"{path.relative_to(ROOT)}:1: there is no '{LICENCE}'; write: tools/spdx_headers.py")
        else:
            path.write_text(with_header(text, comment))
    if not arguments:
        print(f"{missing} files have the line now")
    return 1 if arguments and missing else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
