#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes server/render/tag36h11.cpp from Debian's libapriltag.

usage: tools/make_tag36h11.py > server/render/tag36h11.cpp

Needs cc and libapriltag-dev. The table is committed, so that building needs neither; the unit
tests compare it with the library that is installed.
"""

import pathlib
import subprocess
import sys
import tempfile

# Prints each pattern as 36 bits: the 6 x 6 modules inside the black border, row by row from the
# top left as the tag stands upright, 1 is white.
PROGRAM = r"""
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <stdio.h>

int main(void) {
  apriltag_family_t* family = tag36h11_create();
  for (uint32_t id = 0; id < family->ncodes; ++id) {
    image_u8_t* image = apriltag_to_image(family, id);
    unsigned long long bits = 0;
    for (int row = 2; row < 8; ++row)
      for (int column = 2; column < 8; ++column)
        bits = bits << 1 | (image->buf[row * image->stride + column] ? 1 : 0);
    printf("%09llx\n", bits);
    image_u8_destroy(image);
  }
  tag36h11_destroy(family);
  return 0;
}
"""

HEADER = """\
// Written by tools/make_tag36h11.py from Debian's libapriltag-dev; don't edit.
//
// The patterns are those of the family 36h11 of AprilTag 3,
// https://april.eecs.umich.edu/software/apriltag.html
//
"""

FOOTER = """\
}};

}  // namespace

std::span<const std::uint64_t, tag36h11_count> tag36h11_patterns() { return patterns; }

}  // namespace ziggurat::render
"""


def patterns():
    """The patterns as hexadecimal text, in the order of ids."""
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder, "patterns.c")
        program = pathlib.Path(folder, "patterns")
        source.write_text(PROGRAM)
        subprocess.run(["cc", source, "-o", program, "-lapriltag", "-lapriltag-utils", "-lm"], check=True)
        return subprocess.run([program], check=True, capture_output=True, text=True).stdout.split()


def licence():
    """The library's licence as a comment, from Debian's copyright file."""
    lines = pathlib.Path("/usr/share/doc/libapriltag-dev/copyright").read_text().splitlines()
    files = lines.index("Files: *")
    begin = next(i + 1 for i, line in enumerate(lines)
                 if line == "License: BSD-2-clause" and lines[i + 1].startswith(" "))
    end = next(i for i in range(begin, len(lines)) if not lines[i].startswith(" "))
    text = [lines[files + 1], lines[files + 2]] + ["" if line == " ." else line.strip()
                                                   for line in lines[begin:end]]
    return "".join(f"// {line}".rstrip() + "\n" for line in text)


def main():
    if len(sys.argv) > 1:
        print(__doc__)
        return 0 if sys.argv[1] in ("-h", "--help") else 1
    found = patterns()
    rows = ["    " + " ".join(f"0x{each}," for each in found[i:i + 7]) + "\n"
            for i in range(0, len(found), 7)]
    print(HEADER + licence() + f"""
#include "render/tag36h11.h"

#include <array>

namespace ziggurat::render {{
namespace {{

constexpr std::array<std::uint64_t, tag36h11_count> patterns{{{{
""" + "".join(rows) + FOOTER, end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
