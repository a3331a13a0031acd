# SPDX-License-Identifier: MIT
"""The list of files in docs/adding-a-device.md is that of the files that name the light sensors, without examples; the
distance scanner is in no more.

Files of robots count as one.

usage: device_files_test.py SOURCE_FOLDER
"""

import re
import sys
from pathlib import Path

root = Path(sys.argv[1])
sources = ("server", "clients", "protocol", "cmake", "tools")
endings = {".cpp", ".h", ".py", ".proto", ".ts", ".txt", ".cmake", ".lua"}
most = 5
robots = "server/scene/robots/"  # of all that have such a place, counted as one

LIGHT = re.compile(r"\b(\w+_)?(footbot|eyebot)_light(s|_\w+)?\b|_place\(entity, \"light\"")
SCANNER = re.compile(r"\b(\w+_)?distance_scanner(s|_\w+)?\b|DistanceScanner")


def files_that_name(device):
    for folder in sources:
        for path in (root / folder).rglob("*"):
            if path.suffix not in endings or not path.is_file() or {"examples", "node_modules"} & set(path.parts):
                continue
            if device.search(path.read_text()):
                name = path.relative_to(root).as_posix()
                yield robots if name.startswith(robots) else name


found = set(files_that_name(LIGHT))
table = (root / "docs" / "adding-a-device.md").read_text().split("## 1.")[0]
listed = set(re.findall(r"^\| `([^`]+)` \|", table, re.MULTILINE))

for path in sorted(found - listed):
    print(f"{path} names light sensors; list it in docs/adding-a-device.md, or keep them out of it")
for path in sorted(listed - found):
    print(f"docs/adding-a-device.md lists {path}, which does not name light sensors")
if len(listed) > most:
    print(f"light sensors are in {len(listed)} files; a device must cost at most {most}")
old_words = {"server/scene/old_words.cpp"}  # has what other versions called its attribute
others = set(files_that_name(SCANNER))
if len(others - old_words) > len(listed):
    print(f"the distance scanner is in {len(others)} files: {', '.join(sorted(others))}")
sys.exit(found != listed or len(listed) > most or len(others - old_words) > len(listed))
