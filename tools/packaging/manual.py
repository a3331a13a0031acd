# SPDX-License-Identifier: MIT
"""Writes manual pages from what the programs print as help.

usage: manual.py FOLDER-OF-PROGRAMS OUT    OUT/ziggurat.1.gz, ziggurat-run.1.gz, … of each command, ziggurat-lua.1.gz, …
"""

import gzip
import pathlib
import re
import sys

import help_text


def roff(line):
    """Text that roff prints as it is."""
    line = line.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + line if line[:1] in ".'" else line


def options_of(block):
    """A block of options as tagged paragraphs, or nothing if it is another one."""
    found = help_text.options(block)
    if not found or not help_text.OPTION.match(block.splitlines()[0]):
        return None
    text = ""
    for option in found:
        value = f" \\fI{roff(option.value)}\\fR" if option.value else ""
        text += f".TP\n\\fB{roff(option.name)}\\fR{value}\n{roff(option.text or '.')}\n"
    return text


def block_of(lines):
    """Lines without an empty one between them: a heading with options, examples, or a paragraph."""
    text = ""
    if re.match(r"^[A-Z].*:$", lines[0]) and len(lines) > 1 and lines[1].startswith("  "):
        text, lines = f".SS {roff(lines[0][:-1])}\n", lines[1:]
    tagged = options_of("\n".join(lines))
    if tagged is not None:
        return text + tagged
    body = "\n".join(roff(line) for line in lines) + "\n"
    if any(line.startswith(" ") for line in lines):
        return text + f".PP\n.nf\n{body}.fi\n"
    return text + ".PP\n" + body


def page(name, summary, version, text):
    lines = [line.rstrip() for line in text.strip().splitlines()]
    first = next(i for i, line in enumerate(lines) if line.startswith("usage: "))
    last = first
    while last + 1 < len(lines) and lines[last + 1].startswith("       "):
        last += 1
    synopsis = [line[len("usage: "):] for line in lines[first:last + 1]]
    blocks = "\n".join(lines[:first] + lines[last + 1:]).strip("\n").split("\n\n")
    out = f'.TH {name.upper()} 1 "" "Ziggurat {version}" "Ziggurat"\n'
    out += f".SH NAME\n{roff(name)} \\- {roff(summary)}\n.SH SYNOPSIS\n.nf\n"
    out += "\n".join(f"\\fB{roff(line)}\\fR" for line in synopsis) + "\n.fi\n.SH DESCRIPTION\n"
    out += "".join(block_of(block.strip("\n").splitlines()) for block in blocks if block.strip())
    return out


def main(programs, out):
    programs, out = pathlib.Path(programs), pathlib.Path(out)
    out.mkdir(parents=True, exist_ok=True)
    ziggurat = programs / "ziggurat"
    version = help_text.ask(ziggurat, "--version").split()[-1]
    commands = help_text.commands(ziggurat)
    pages = {"ziggurat": ("run robots in lock-step with their controllers", help_text.ask(ziggurat, "help")),
             "ziggurat-lua": ("run Lua controllers of robots", help_text.ask(programs / "ziggurat-lua", "--help")),
             "ziggurat-conformance": ("prove a server or a client of the protocol right", help_text.ask(
                 sys.executable, programs / "ziggurat-conformance", "--help"))}
    for name, summary in commands:
        pages[f"ziggurat-{name}"] = (summary, help_text.command_help(ziggurat, name))
    for name, (summary, text) in pages.items():
        written = page(name, summary, version, text)
        others = [f"\\fBziggurat\\-{other}\\fR(1)" for other, _ in commands] if name == "ziggurat" else [
            "\\fBziggurat\\fR(1)"]
        written += ".SH SEE ALSO\n" + ",\n".join(others) + "\n"
        (out / f"{name}.1.gz").write_bytes(gzip.compress(written.encode(), mtime=0))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
