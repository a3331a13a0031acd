# SPDX-License-Identifier: MIT
"""Counts the code blocks and commands of the documents, and lists those that are not run, with the reasons."""

import unittest

from documents import SHOWN, blocks, pages


def count(some):
    return f"{len(some)} blocks with {sum(len(block.commands) for block in some)} commands"


class Count(unittest.TestCase):
    def test_each_block_that_is_not_run_has_a_reason(self):
        every = [block for page in pages() for block in blocks(page)]
        code = [block for block in every if block.kind != SHOWN]
        slow, left = ([block for block in code if block.has(mark)] for mark in ("slow", "not run"))
        run = [block for block in code if not block.has("slow") and not block.has("not run")]
        print(f"{count(code)}, and {len(every) - len(code)} drawings and outputs")
        for some, text in ((run, "run by ./quickstart test"), (slow, "only by ./quickstart test-all:"), (left, "not run:")):
            print(f"{count(some)} {text}")
            for block in some if some is not run else ():
                reason = block.value("slow") or block.value("not run")
                print(f"  {block.place}: {reason}")
                self.assertTrue(reason, block.place)
        self.assertLess(len(left), len(code) / 4, "most of the documents is to be run")


if __name__ == "__main__":
    unittest.main()
