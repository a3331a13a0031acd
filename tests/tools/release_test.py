# SPDX-License-Identifier: MIT
"""tools/release on small checkouts of its own, and its dry run on this one."""

import importlib.machinery
import importlib.util
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
loader = importlib.machinery.SourceFileLoader("release", str(ROOT / "tools/release"))
release = importlib.util.module_from_spec(importlib.util.spec_from_loader("release", loader))
loader.exec_module(release)

CHANGELOG = "# Changelog\n\n## [Unreleased]\n\n- A thing.\n\n## [0.1.0] - 2026-01-01\n\n- First.\n"


class Release(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("VERSION", "0.1.0\n")
        self.write("clients/python/ziggurat/__init__.py", '"""Text."""\n\n__version__ = "0.1.0"\n\nrest = 1\n')
        self.write("docs/changelog.md", CHANGELOG)
        release.git(self.root, "init", "--quiet")
        for key in ("user.name", "user.email"):
            release.git(self.root, "config", key, "release@example.org")
        self.commit()
        release.git(self.root, "tag", "v0.1.0")

    def write(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text)

    def commit(self):
        release.git(self.root, "add", "--all")
        release.git(self.root, "commit", "--quiet", "--message", "State")

    def refused(self, version):
        with self.assertRaises(release.Refused) as caught:
            release.release(self.root, version, has_checks=False)
        return str(caught.exception)

    def test_version_changelog_commit_and_tag(self):
        release.release(self.root, "0.2.0", has_checks=False)
        self.assertEqual((self.root / "VERSION").read_text(), "0.2.0\n")
        self.assertEqual((self.root / "clients/python/ziggurat/__init__.py").read_text(),
                         '"""Text."""\n\n__version__ = "0.2.0"\n\nrest = 1\n')
        changelog = (self.root / "docs/changelog.md").read_text()
        self.assertRegex(changelog, r"\n## \[0\.2\.0\] - \d{4}-\d\d-\d\d\n\n- A thing\.\n\n## \[0\.1\.0\] - 2026-01-01\n")
        self.assertEqual(release.git(self.root, "tag", "--points-at", "HEAD").strip(), "v0.2.0")
        self.assertEqual(release.git(self.root, "status", "--porcelain"), "")

    def test_what_is_refused(self):
        self.assertIn("is no version", self.refused("0.2"))
        self.assertIn("the tag v0.1.0 is there", self.refused("0.1.0"))
        self.assertIn("is below 0.1.0", self.refused("0.0.9"))
        self.write("new", "")
        self.assertIn("has changes", self.refused("0.2.0"))
        self.write("docs/changelog.md", CHANGELOG.replace("- A thing.\n", ""))
        self.commit()
        self.assertIn("has no entry for 0.2.0", self.refused("0.2.0"))
        self.write("docs/changelog.md", "# Changelog\n")
        self.commit()
        self.assertIn("no heading for 0.2.0", self.refused("0.2.0"))
        self.assertEqual(release.git(self.root, "tag").split(), ["v0.1.0"])

    def test_the_dry_run_on_this_checkout_changes_nothing(self):
        if not (ROOT / ".git").exists():
            self.skipTest("this is no clone")
        version = (ROOT / "VERSION").read_text().strip()
        if f"v{version}" in release.git(ROOT, "tag").split():
            self.skipTest(f"{version} is released")
        before = release.git(ROOT, "rev-parse", "HEAD"), release.git(ROOT, "tag")
        done = subprocess.run([str(ROOT / "tools/release"), version, "--dry-run", "--without-checks"], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn(f"tag: v{version}", done.stdout)
        self.assertEqual(before, (release.git(ROOT, "rev-parse", "HEAD"), release.git(ROOT, "tag")))


if __name__ == "__main__":
    unittest.main()
