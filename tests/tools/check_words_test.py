#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""tools/check_words.py finds the words of its list, and nothing else."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "tools/check_words.py"


class CheckWords(unittest.TestCase):
    def run_on(self, path, text):
        """Exit code and output of the check on one file."""
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, path)
            file.parent.mkdir(parents=True)
            file.write_text(text)
            done = subprocess.run([sys.executable, SCRIPT, folder], capture_output=True, text=True)
            return done.returncode, done.stdout

    def test_finds_a_word_in_code_and_documents(self):
        for path, text in [("docs/a.md", "The world waits for nobody.\n"),
                           ("server/a/b.cpp", "void say_hello();\n"),
                           ("server/a/b.h", "struct Lack {};\n"),
                           ("clients/a.py", "# a number is due\n"),
                           ("server/a/c.h", "bool is_due();\n"),
                           ("server/a/d.h", "int surroundings_program_;\n"),
                           ("docs/b.md", "as he sends it\n")]:
            with self.subTest(text):
                code, out = self.run_on(path, "\n" + text)
                self.assertEqual(code, 1, out)
                self.assertTrue(out.startswith(f"{path}:2: "), out)
                self.assertIn("write instead", out)

    def test_leaves_other_words_alone(self):
        text = ("Residue lacks room; the duel says hello_again, essay_length, the fate of a packet. "
                "Lackluster, Grid::Rooms, and this one is the rest.\n")
        self.assertEqual(self.run_on("docs/a.md", text)[0], 0)

    def test_finds_a_comment_that_begins_vaguely(self):
        for text in ["/// What a pair needs.", "int a;  // Those of a pair.", "  // Where it is."]:
            with self.subTest(text):
                code, out = self.run_on("server/physics/a.h", "\n" + text + "\n")
                self.assertEqual(code, 1, out)
                self.assertTrue(out.startswith("server/physics/a.h:2: "), out)
                self.assertEqual(self.run_on("bench/a.h", text)[0], 0, "elsewhere it is not checked")

    def test_finds_a_long_sentence_of_a_comment(self):
        words = ["word"] * 13
        longer = f"/// {' '.join(words)}\n/// {' '.join(words)}.\n"
        code, out = self.run_on("server/math/a.h", longer)
        self.assertEqual(code, 1, out)
        self.assertIn("server/math/a.h:1: a sentence of 26 words", out)
        short = f"/// {' '.join(words)}: {' '.join(words)} ({' '.join(words)}).\n/// @param a  {' '.join(words)}\n"
        self.assertEqual(self.run_on("server/math/a.h", short)[0], 0)

    def test_finds_a_long_sentence_of_a_document(self):
        words = " ".join(["word"] * 16)
        code, out = self.run_on("docs/a.md", f"# A title\n\n{words}\n{words}.\n")
        self.assertEqual(code, 1, out)
        self.assertIn("docs/a.md:3: a sentence of 32 words", out)
        short = f"{words}. {words}:\n\n- {words}\n- {words} ({words})\n\n| {words} | {words} |\n\n```sh\n{words} {words}\n```\n"
        self.assertEqual(self.run_on("docs/a.md", short)[0], 0)
        self.assertEqual(self.run_on("docker/a.md", f"{words} {words}\n")[0], 1, "in any folder")
        self.assertEqual(self.run_on("docker/a.txt", f"{words} {words}\n")[0], 0, "that is no document")

    def test_leaves_other_comments_alone(self):
        text = '/// Position of a link.\nint a = 0;  ///< of the link [m]\nauto url = "http://What";\n'
        self.assertEqual(self.run_on("server/physics/a.h", text)[0], 0)

    def test_leaves_recorded_messages_alone(self):
        self.assertEqual(self.run_on("protocol/recorded/a.txt", "nobody\n")[0], 0)


if __name__ == "__main__":
    unittest.main()
