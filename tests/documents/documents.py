# SPDX-License-Identifier: MIT
"""Code blocks of all documents: their kind, their place, and the marks before them.

A mark is an HTML comment on a line of its own before a block; readers do not see it:

    <!-- not run: REASON -->   the block is not run; the test lists it
    <!-- slow: REASON -->      only ./quickstart test-all runs it (ZIGGURAT_TEST_ALL=1)
    <!-- file: NAME -->        the block is the content of this file, which later blocks of the page use
    <!-- then: COMMAND -->     runs after the block
    <!-- beside: COMMAND -->   runs while the block does
    <!-- goes on -->           the block runs until Ctrl-C: it is started for each later block of its section, too
    <!-- exit: CODE -->        its exit code, if that is not 0; several with | between them
    <!-- part of: PATH -->     the block, or what a diff finds, stands in this file, which other tests run
"""

import dataclasses
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = ("*.md", "docs/**/*.md", "docker/*.md", "clients/*/README.md", "protocol/recorded/*.md")
MARK = re.compile(r"\s*<!-- (not run|slow|file|then|beside|goes on|exit|part of)(?:: (.*?))? -->\s*")
FENCE = re.compile(r"(\s*)(`{3,})(\w*)(?: .*)?")
HEADING = re.compile(r"(#+) (.*)")
SHOWN = "text"  # the kind of drawings, messages and outputs: nothing to run


@dataclasses.dataclass
class Block:
    page: str        # path from the root of the checkout
    line: int        # of the fence
    kind: str        # the fence's language
    text: str
    marks: list      # (mark, value)
    section: tuple   # headings above it, the outermost first

    def values(self, mark):
        return [value for name, value in self.marks if name == mark]

    def value(self, mark):
        return next(iter(self.values(mark)), None)

    def has(self, mark):
        return any(name == mark for name, _ in self.marks)

    @property
    def place(self):
        return f"{self.page}:{self.line}"

    @property
    def exit_codes(self):
        return tuple(int(code) for code in (self.value("exit") or "0").split("|"))

    @property
    def commands(self):
        """Command lines of a shell block, those that are continued as one."""
        if self.kind == "console":
            return [line[2:] for line in self.text.splitlines() if line.startswith("$ ")]
        lines = re.sub(r"[\\|]\n\s*", " ", self.text).splitlines() if self.kind == "sh" else []
        return [line for line in lines if line.strip() and not line.lstrip().startswith("#")]


def pages():
    """Paths from the root."""
    return [path.relative_to(ROOT).as_posix() for pattern in PAGES for path in sorted(ROOT.glob(pattern))]


def name_of(page):
    """top_README, viewing, tutorial_01-box_README, clients_python_README: the page's test."""
    path = page if "/" in page else f"top/{page}"
    return path.removesuffix(".md").removeprefix("docs/").replace("/", "_")


def blocks(page):
    return list(blocks_of(page, (ROOT / page).read_text(encoding="utf-8")))


def blocks_of(page, text):
    lines = text.splitlines()
    headings, marks, at = [], [], 0
    while at < len(lines):
        line = lines[at]
        if fence := FENCE.fullmatch(line):
            end = next(i for i in range(at + 1, len(lines)) if lines[i].strip() == fence[2])
            body = "".join(content.removeprefix(fence[1]) + "\n" for content in lines[at + 1:end])
            yield Block(page, at + 1, fence[3], body, marks, tuple(headings))
            marks, at = [], end
        elif mark := MARK.fullmatch(line):
            marks.append((mark[1], mark[2] or ""))
        elif line.strip():
            if re.match(r"    \S", line) and not marks and (at == 0 or not lines[at - 1].strip()) and not in_list(lines, at):
                yield Block(page, at + 1, "indented", line, [], tuple(headings))
            marks = []
            if heading := HEADING.fullmatch(line):
                headings = headings[:len(heading[1]) - 1] + [f"{at}:{heading[2]}"]
        at += 1


def in_list(lines, at):
    """Whether an indented line goes on a list."""
    above = next((line for line in reversed(lines[:at]) if line.strip() and not line.startswith("  ")), "")
    return re.match(r"([-*]|\d+\.) ", above) is not None
