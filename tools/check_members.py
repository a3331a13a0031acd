#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that vectors, quaternions and matrices in our headers have an initial value, and in scenes numbers, too.

usage: check_members.py [ROOT]     ROOT is the top of the checkout (default: this file's)

They would be as memory was: an entity that code builds and fills in part would differ from run to
run. A local one that the next line fills with << is left out. Each member without an initial value is
printed as file:line: text; the exit code is 1 if there is any.
"""

import re
import sys

from checkout import named_root

VECTOR = re.compile(r"\s+(?:math::|Eigen::)?(Vector\d|Quaternion|Matrix\d|Vector\dd|Quaterniond|Matrix\dd)"
                    r"\s+\w+(, \w+)*;")
# Members of classes, with a _ at their end, are the business of constructors.
NUMBER = re.compile(r"\s+(double|int|bool|float|unsigned|std::(size_t|u?int(8|16|32|64)_t))\s+\w*[a-z0-9](, \w*[a-z0-9])*;")


def check(root):
    """All members without an initial value under root, as file:line: text."""
    found = []
    for top in ("server", "clients/cpp", "protocol"):
        for path in sorted((root / top).rglob("*.h")):
            lines = path.read_text(encoding="utf-8").splitlines()
            for number, (line, after) in enumerate(zip(lines, lines[1:] + [""]), 1):
                name = path.relative_to(root).as_posix()
                is_vector = VECTOR.match(line) and "<<" not in after
                if is_vector or (NUMBER.match(line) and name.startswith("server/scene/")):
                    found.append(f"{name}:{number}: give '{line.strip()}' an initial value: "
                                 "= 0, = …::Zero() or = …::Identity()")
    return found


def main():
    root = named_root(__doc__)
    found = check(root)
    print("\n".join(found) or "every vector, quaternion and matrix of a header has an initial value, and every number of a scene")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
