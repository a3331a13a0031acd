# SPDX-License-Identifier: MIT
"""Which checkout a check of this folder looks at."""

import pathlib
import sys


def named_root(usage):
    """The top of the checkout: the only argument, or that of this file. --help prints the usage and ends the program, and so
    do more arguments, with exit code 1."""
    arguments = sys.argv[1:]
    if len(arguments) > 1 or arguments[:1] in (["-h"], ["--help"]):
        print(usage)
        sys.exit(0 if len(arguments) == 1 else 1)
    root = pathlib.Path(arguments[0]) if arguments else pathlib.Path(__file__).parents[1]
    return root.resolve()
