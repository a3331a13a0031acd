# SPDX-License-Identifier: MIT
"""Writes completion for bash and zsh from what `ziggurat` prints as help.

usage: completion.py FOLDER-OF-PROGRAMS OUT    OUT/ziggurat for bash, OUT/_ziggurat for zsh

Commands and options are those of the help. Scenes and ids of entities are asked from the program at the time:
`ziggurat scenes --names`, and `ziggurat ctl read` of the only server that runs.
"""

import pathlib
import re
import sys

import help_text

FOLDER = pathlib.Path(__file__).parent


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def main(programs, out):
    ziggurat, out = pathlib.Path(programs) / "ziggurat", pathlib.Path(out)
    out.mkdir(parents=True, exist_ok=True)
    commands = help_text.commands(ziggurat)
    options = {name: help_text.options(help_text.command_help(ziggurat, name)) for name, _ in commands}
    requests = re.findall(r"^  ([a-z-]+) ", help_text.ask(ziggurat, "help", "ctl").split("\n\n")[2], re.M)

    words = "\n".join(f"    {name}) printf '%s\\n' {' '.join(dict.fromkeys(o.name for o in each))} ;;"
                      for name, each in options.items() if each)
    valued = sorted({o.name for each in options.values() for o in each if o.value and not o.value.startswith("[")})
    described = "\n".join(
        f"    {name}) options=({' '.join(quoted(o.name + ':' + o.text) for o in each)}) ;;"
        for name, each in options.items() if each)
    fill = {"@COMMANDS@": " ".join(name for name, _ in commands), "@REQUESTS@": " ".join(requests),
            "@OPTIONS@": words, "@VALUED@": "|".join(valued), "@DESCRIBED_OPTIONS@": described,
            "@DESCRIBED_COMMANDS@": " ".join(quoted(f"{name}:{text}") for name, text in commands)}
    for source, target in (("completion.bash.in", "ziggurat"), ("completion.zsh.in", "_ziggurat")):
        text = (FOLDER / source).read_text()
        for mark, value in fill.items():
            text = text.replace(mark, value)
        (out / target).write_text(text)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
