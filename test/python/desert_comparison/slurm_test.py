#!/usr/bin/env python3
"""desert_compare through Slurm, on a cluster of one node on this machine.

  slurm_test.py DESERT_COMPARE PROFILE [TEST]...
"""
import os
import subprocess
import sys
import tempfile
import unittest

import desert_compare_test as local
from loopback_slurm import LoopbackSlurm


class ThroughSlurm(local.DesertCompareCase):
    def setUp(self):
        super().setUp()
        temporary = tempfile.TemporaryDirectory(prefix="desert_slurm_")
        self.addCleanup(temporary.cleanup)
        self.slurm = LoopbackSlurm(temporary.name, local.PATIENCE)
        self.addCleanup(self.slurm.stop)

    def test_the_table_is_that_of_this_machine(self):
        done = subprocess.run(self.command("cluster.html", "--profile", PROFILE), env=self.slurm.environment,
                              stderr=subprocess.PIPE, universal_newlines=True, timeout=200 * local.PATIENCE)
        with open(os.path.join(self.path("cluster.runs"), "snakemake.log")) as log:
            self.assertEqual(done.returncode, 0, done.stderr + log.read())
        here, cluster = self.page("two.html"), self.page("cluster.html")
        for name in ("metrics", "balance", "runs"):
            self.assertEqual(here.tables[name], cluster.tables[name])
        self.assertEqual(here.pictures, cluster.pictures)
        local.wait_until(lambda: self.slurm.states() == ["COMPLETED"] * 4, "jobs that Slurm calls completed")


if __name__ == "__main__":
    local.PROGRAM, PROFILE = sys.argv.pop(1), sys.argv.pop(1)
    unittest.main()
