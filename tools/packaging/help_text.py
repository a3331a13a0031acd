# SPDX-License-Identifier: MIT
"""Help of the programs, read for manual pages and completion: commands, usage, paragraphs, options."""

import dataclasses
import re
import subprocess


@dataclasses.dataclass
class Option:
    name: str   # with dashes
    value: str  # name of its value; empty: it takes none
    text: str


def ask(program, *arguments):
    """What a program prints for --help or help."""
    done = subprocess.run([str(program), *arguments], stdout=subprocess.PIPE, text=True, check=True)
    return done.stdout


def commands(ziggurat):
    """(name, summary) of each command."""
    return re.findall(r"^  ([a-z][a-z-]*) +(.+)$", ask(ziggurat, "help").split("\n\n")[2], re.M)


def command_help(ziggurat, command):
    text = ask(ziggurat, "help", command)
    return ask(ziggurat, "help", command, "--all") if re.search(rf"ziggurat help {command} --all$", text) else text


# `  --seed N   text`, `  --view [=HOST:PORT(=…)]   text`; an option with a long value has its text below.
OPTION = re.compile(r"^ {2}(?:-\w \[ )?(--[a-z][a-z-]*)( \S+)?(?: \])?(?: {2,}(\S.*))?$")


def options(text):
    """All options of a help text, each with the lines that go on about it."""
    found = []
    is_open = False
    for line in text.splitlines():
        begin = OPTION.match(line)
        if begin:
            found.append(Option(begin[1], (begin[2] or "").strip(), begin[3] or ""))
            is_open = True
        elif is_open and re.match(r"^ {8,}\S", line):
            found[-1].text = (found[-1].text + " " + line.strip()).strip()
        else:
            is_open = False
    return found
