"""The site of the documents: built without warnings, nothing from elsewhere, a search that works from the disk."""

import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from documents import ROOT

QUESTIONS = {  # what a user types, and a page that must be among the first results
    "several machines keys": "docs/several-machines.html",
    "camera tag": "docs/tutorial/06-camera/index.html",
    "record replay": "docs/recordings.html",
    "gymnasium": "docs/learning.html",
    "slurm": "docs/experiments.html",
    "debug lua error": "docs/lua-api.html",
    "report card": "docs/hardware-in-the-loop.html",
}


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

    @unittest.skipUnless(shutil.which("chromium"), "needs a browser")
    def test_the_search_answers_from_the_disk(self):
        for question, page in QUESTIONS.items():
            with self.subTest(question):
                address = f"{(self.html / 'index.html').as_uri()}?q={question.replace(' ', '%20')}"
                shown = subprocess.run(
                    ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom", "--virtual-time-budget=15000",
                     f"--user-data-dir={self.folder / 'browser'}", address], capture_output=True, text=True, timeout=60, check=False)
                results = re.findall(r'<a href="([^"?#]*)[^"]*" class="md-search-result__link"', shown.stdout)
                self.assertIn((self.html / page).as_uri(), results[:8])


if __name__ == "__main__":
    unittest.main()
