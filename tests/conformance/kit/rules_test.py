# SPDX-License-Identifier: MIT
"""Every rule of docs/protocol.md has a case, or a reason why not."""

import re
import unittest
from pathlib import Path

from ziggurat_conformance import client_mode
from ziggurat_conformance.cases import SERVER_CASES

DOCUMENT = Path(__file__).resolve().parents[3] / "docs" / "protocol.md"

# Rules that no case can hold, and why.
REASONS = {
    "T11": "a matter of the command line, too: tests/unit/processes/private_folder_test.cpp",
    "R11": "the environment of programs that a server starts: tests/scenes/directing_test.py",
    "K10": "a matter of the file of --curve-clients: tests/unit/network/curve_test.cpp",
    "D5": "more than the kit's robots may send: tests/conformance/device_rules_test.cpp",
}


def rules(served_only: bool = False) -> set:
    """Rules of the document; those that begin with *Reserved:* are not served yet."""
    found = re.findall(r"^- \*\*([A-Z]+[0-9]+)\*\* (\*Reserved:)?", DOCUMENT.read_text(), re.MULTILINE)
    return {rule for rule, reserved in found if not (reserved and served_only)}


class Rules(unittest.TestCase):
    def test_each_has_a_case_or_a_reason(self):
        held = {case.rule for case in [*SERVER_CASES, *client_mode.CASES]}
        self.assertEqual(set(), rules(served_only=True) - held - set(REASONS))

    def test_cases_name_rules_that_there_are(self):
        held = {case.rule for case in [*SERVER_CASES, *client_mode.CASES]}
        tables = {"M0", "D0"}  # of sections 4 and 3.1
        self.assertEqual(set(), held - rules() - tables)

    def test_reasons_are_still_needed(self):
        held = {case.rule for case in [*SERVER_CASES, *client_mode.CASES]}
        self.assertEqual(set(), set(REASONS) & held)
        self.assertEqual(set(), set(REASONS) - rules())

    def test_ids_are_unique(self):
        for cases in (SERVER_CASES, client_mode.CASES):
            ids = [case.id for case in cases]
            self.assertEqual(sorted(set(ids)), sorted(ids))

    def test_there_are_enough(self):
        self.assertGreaterEqual(len(SERVER_CASES) + len(client_mode.CASES), 120)


if __name__ == "__main__":
    unittest.main()
