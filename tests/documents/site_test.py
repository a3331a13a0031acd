# SPDX-License-Identifier: MIT
"""The site of the documents: built without warnings, nothing from elsewhere, a search that works from the disk."""

import json
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from documents import ROOT

HERE = pathlib.Path(__file__).resolve().parent

QUESTIONS = {  # what a user types, and a page that must be among the first results
    "add noise": "docs/faq.html",
    "attach": "docs/faq.html",
    "glue two bodies": "docs/faq.html",
    "ground truth": "docs/faq.html",
    "add a light": "docs/faq.html",
    "write a file from lua": "docs/faq.html",
    "debug a lua script": "docs/faq.html",
    "hundred seeds": "docs/faq.html",
    "monte carlo": "docs/faq.html",
    "headless": "docs/faq.html",
    "gpu": "docs/faq.html",
    "faster": "docs/faq.html",
    "screenshot": "docs/faq.html",
    "move a robot from outside": "docs/faq.html",
    "teleport": "docs/faq.html",
    "stop a run": "docs/faq.html",
    "two machines": "docs/faq.html",
    "meshes terrain": "docs/faq.html",
    "urdf": "docs/faq.html",
    "ros2": "docs/faq.html",
    "lidar": "docs/faq.html",
    "windows": "docs/faq.html",
    "springs": "docs/faq.html",
    "joint torque": "docs/faq.html",
    "several machines keys": "docs/several-machines.html",
    "camera tag": "docs/tutorial/06-camera/index.html",
    "record replay": "docs/recordings.html",
    "gymnasium": "docs/learning.html",
    "slurm": "docs/experiments.html",
    "phototaxis": "docs/faq.html",  # a word of paths in code
    "set_velocity": "docs/lua-api.html",
    "io.open": "docs/faq.html",
    "opencv": "docs/python-client.html",
    "docker": "docker/index.html",
    "cite": "index.html",
    "report card": "docs/hardware-in-the-loop.html",
}
FIRST = 5


@unittest.skipUnless(shutil.which("mkdocs"), "needs Debian's mkdocs and mkdocs-material")
class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="zs", dir="/tmp"))
        cls.built = subprocess.run([ROOT / "tools/site", cls.folder / "site"], capture_output=True, text=True, check=False)
        cls.html = cls.folder / "site/html"

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def test_it_is_built_without_warnings(self):
        self.assertEqual((self.built.returncode, self.built.stderr), (0, ""))

    def test_only_documents_are_searched(self):
        index = json.loads((self.html / "search/search_index.json").read_text(encoding="utf-8"))
        self.assertEqual({entry["location"].split("/")[0].split("#")[0] for entry in index["docs"]}, {"docs", "docker", "index.html"})

    def test_no_page_loads_anything_from_elsewhere(self):
        loaded = re.compile(r'<(?:script|img|link rel="stylesheet"|iframe)[^>]*(?:src|href)="(?:https?:)?//[^"]*"')
        for page in self.html.rglob("*.html"):
            self.assertEqual(loaded.findall(page.read_text(encoding="utf-8")), [], page)

    def test_links_to_sections_lead_to_one(self):
        identities = {}
        for page in sorted(self.html.rglob("*.html")):
            text = page.read_text(encoding="utf-8")
            identities[page] = set(re.findall(r'\bid="([^"]+)"', text))
        faults = []
        for page in identities:
            body = page.read_text(encoding="utf-8").split("<article", 1)[-1].split("</article>")[0]
            for target, anchor in re.findall(r'href="([^":]*)#([^"]+)"', body):
                other = (page.parent / target).resolve() if target else page
                if other in identities and anchor not in identities[other]:
                    faults.append(f"{page.relative_to(self.html)}: {target}#{anchor}")
        self.assertEqual(faults, [])

    @unittest.skipUnless(shutil.which("node"), "needs node")
    def test_the_search_answers_questions(self):
        searched = subprocess.run(["node", HERE / "search.js", self.html, *QUESTIONS], capture_output=True, text=True, check=True)
        for (question, page), line in zip(QUESTIONS.items(), searched.stdout.splitlines(), strict=True):
            with self.subTest(question):
                self.assertIn(page, [place.split("#")[0] for place in json.loads(line)[:FIRST]])

    @unittest.skipUnless(shutil.which("chromium"), "needs a browser")
    def test_the_search_works_from_the_disk(self):
        address = f"{(self.html / 'index.html').as_uri()}?q=gymnasium"
        shown = subprocess.run(
            ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom", "--virtual-time-budget=15000",
             f"--user-data-dir={self.folder / 'browser'}", address], capture_output=True, text=True, timeout=120, check=False)
        results = re.findall(r'<a href="([^"?#]*)[^"]*" class="md-search-result__link"', shown.stdout)
        self.assertIn((self.html / "docs/learning.html").as_uri(), results[:FIRST])


if __name__ == "__main__":
    unittest.main()
