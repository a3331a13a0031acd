"""The list of files in docs/adding-a-device.md is that of the files that name the device.

usage: device_files_test.py SOURCE_FOLDER
"""

import re
import sys
from pathlib import Path

root = Path(sys.argv[1])
sources = ("server", "clients", "protocol", "cmake", "tools")
endings = {".cpp", ".h", ".py", ".proto", ".txt", ".cmake", ".lua"}


def files_that_name_it():
    for folder in sources:
        for path in (root / folder).rglob("*"):
            if path.suffix not in endings or not path.is_file():
                continue
            words = re.findall(r"\w+", path.read_text())
            if any(re.fullmatch(r"(\w+_)?imus?(_\w+)?|Imus?([A-Z]\w*)?", word) for word in words):
                yield path.relative_to(root).as_posix()


found = set(files_that_name_it())
table = (root / "docs" / "adding-a-device.md").read_text().split("## 1.")[0]
listed = set(re.findall(r"^\| `([^`]+)` \|", table, re.MULTILINE))

for path in sorted(found - listed):
    print(f"{path} names the IMU; list it in docs/adding-a-device.md, or keep the IMU out of it")
for path in sorted(listed - found):
    print(f"docs/adding-a-device.md lists {path}, which does not name the IMU")
most = 14
if len(listed) > most:
    print(f"the IMU is in {len(listed)} files; a device must cost at most {most}")
sys.exit(found != listed or len(listed) > most)
