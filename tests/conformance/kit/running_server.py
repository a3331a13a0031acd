# SPDX-License-Identifier: MIT
"""The kit against a server that runs already: running_server.py ZIGGURAT KIT [OPTION of the kit]…

Starts `ziggurat serve` with the kit's scene, once, and plays all cases that need no restart."""

import json
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

FEWEST = 400  # cases, with their forms, that must pass


def main(ziggurat, kit, *options):
    scene = subprocess.run([kit, "--scene"], check=True, capture_output=True, text=True).stdout.strip()
    said = tempfile.TemporaryFile("w+")
    server = subprocess.Popen([ziggurat, "serve", scene, "--endpoint", "tcp://127.0.0.1:*"],
                              stdout=subprocess.PIPE, stderr=said, text=True)
    try:
        endpoint = server.stdout.readline().split()[1]
        with tempfile.TemporaryDirectory() as folder:
            report = Path(folder, "report.json")
            code = subprocess.run(
                [kit, "server", *options, "--json", str(report), endpoint]).returncode
            cases = json.loads(report.read_text())["cases"]
        passed = sum(case["verdict"] == "pass" for case in cases)
        if code == 0 and server.poll() is None and passed >= FEWEST:
            return 0
        said.seek(0)
        print(f"exit code {code}, {passed} passed, server: {server.poll()}; it said:\n{said.read()[-2000:]}")
        return 1
    finally:
        server.send_signal(signal.SIGINT)
        try:
            server.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            server.kill()
            server.communicate()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
