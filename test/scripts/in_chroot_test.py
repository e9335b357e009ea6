#!/usr/bin/env python3
"""scripts/in_chroot: what it refuses before it makes anything. What it does is tried by a maintainer: see CONTRIBUTING.md."""
import os
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


class Refusals(unittest.TestCase):
    def run_script(self, *words):
        return subprocess.run([os.path.join(ROOT, "scripts", "in_chroot"), *words], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True,
                              env=dict(os.environ, DESERT_CHROOTS=self.folder))

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory(prefix="desert_sim_")
        self.folder = os.path.join(self.temporary.name, "chroots")

    def tearDown(self):
        self.temporary.cleanup()

    def test_words_that_it_does_not_know(self):
        for words, text in (((), "a suite and a command"), (("trixie",), "a suite and a command"),
                            (("sid", "true"), "'sid' is not bullseye, bookworm or trixie"),
                            (("--umask", "99", "trixie", "true"), "not '99'"), (("--user",), "--user needs a value"),
                            (("--user", "A B", "trixie", "true"), "not 'A B'"),
                            (("--home", "/h", "trixie", "true"), "--home needs --user"),
                            (("--user", "a", "--home", "h", "trixie", "true"), "absolute path, not 'h'"),
                            (("--bear", "trixie", "true"), "unknown option --bear")):
            run = self.run_script(*words)
            self.assertEqual(run.returncode, 2, words)
            self.assertIn(text, run.stderr)
            self.assertEqual(run.stdout, "")
            self.assertFalse(os.path.exists(self.folder), words)

    def test_help(self):
        run = self.run_script("--help")
        self.assertEqual(run.returncode, 0)
        self.assertIn("SUITE COMMAND", run.stdout)
        self.assertNotIn("set -e", run.stdout)


if __name__ == "__main__":
    unittest.main()
