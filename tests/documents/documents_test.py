# SPDX-License-Identifier: MIT
"""Every code block and command of the documents works as printed.

usage: documents_test.py [Documents.test_PAGE]...    a page is top_README, viewing, tutorial_01-box_README, …

The blocks of a page run in order, in one folder. The marks that a block may have are in documents.py.
"""

import os
import unittest

from documents import SHOWN, blocks, name_of, pages
from kinds import run_block
from running import Fault, Folder, interrupt

ALL = os.environ.get("ZIGGURAT_TEST_ALL") == "1"


def is_run(block):
    return not block.has("not run") and (ALL or not block.has("slow"))


def beside(block, earlier):
    """Commands that run in other terminals: those of the block, and those that go on in its section."""
    going_on = [one.text for one in earlier if one.has("goes on") and block.section[:len(one.section)] == one.section]
    return going_on[-1:] + block.values("beside")


def run_page(test, page):
    all_blocks = blocks(page)
    if not any(is_run(block) and block.kind != SHOWN for block in all_blocks):
        return
    folder = Folder(page)
    try:
        for at, block in enumerate(all_blocks):
            if is_run(block) and block.kind != SHOWN:
                with test.subTest(block.place):
                    run_beside(test, folder, block, beside(block, all_blocks[:at]))
    finally:
        folder.remove()


def run_beside(test, folder, block, commands):
    started = []
    try:
        if block.value("file") is None or block.has("then"):
            for command in commands:
                started.append(folder.start_beside(command))
        run_block(folder, block)
    except Fault as fault:
        test.fail(f"{block.place}: {fault}")
    finally:
        for process in reversed(started):
            interrupt(process)


class Documents(unittest.TestCase):
    pass


for _page in pages():
    setattr(Documents, f"test_{name_of(_page)}", lambda self, page=_page: run_page(self, page))


if __name__ == "__main__":
    unittest.main()
