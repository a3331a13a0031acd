"""The list of files in docs/adding-a-device.md is that of the files that name the IMU, without examples, which use it;
the contact sensor is in no more.

usage: device_files_test.py SOURCE_FOLDER
"""

import re
import sys
from pathlib import Path

root = Path(sys.argv[1])
sources = ("server", "clients", "protocol", "cmake", "tools")
endings = {".cpp", ".h", ".py", ".proto", ".txt", ".cmake", ".lua"}


IMU = re.compile(r"(\w+_)?imus?(_\w+)?|Imus?([A-Z]\w*)?")
CONTACT_SENSOR = re.compile(r"(\w+_)?contact_sensors?(_\w+)?|ContactSensors?([A-Z]\w*)?")


def files_that_name(device):
    for folder in sources:
        for path in (root / folder).rglob("*"):
            if path.suffix not in endings or not path.is_file() or "examples" in path.parts:
                continue
            words = re.findall(r"\w+", path.read_text())
            if any(device.fullmatch(word) for word in words):
                yield path.relative_to(root).as_posix()


found = set(files_that_name(IMU))
table = (root / "docs" / "adding-a-device.md").read_text().split("## 1.")[0]
listed = set(re.findall(r"^\| `([^`]+)` \|", table, re.MULTILINE))

for path in sorted(found - listed):
    print(f"{path} names the IMU; list it in docs/adding-a-device.md, or keep the IMU out of it")
for path in sorted(listed - found):
    print(f"docs/adding-a-device.md lists {path}, which does not name the IMU")
most = 14
if len(listed) > most:
    print(f"the IMU is in {len(listed)} files; a device must cost at most {most}")
others = set(files_that_name(CONTACT_SENSOR))
if len(others) > len(listed):
    print(f"the contact sensor is in {len(others)} files: {', '.join(sorted(others))}")
sys.exit(found != listed or len(listed) > most or len(others) > len(listed))
