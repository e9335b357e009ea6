#!/usr/bin/env python3
"""kernels/backend/instruction_set.hpp: a build for one processor (DESERT_PORTABLE=OFF, scripts/demo) refuses another."""
import os
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROGRAM = """#include <iostream>
#include "kernels/backend/instruction_set.hpp"
int main() { std::cout << desert_sim::problem_with_instructions(); }
"""


class InstructionSets(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def problem(self, instructions, *definitions):
        """What a build with these definitions says on a processor with these instructions."""
        program = os.path.join(self.folder.name, "program")
        subprocess.run(["c++", "-std=c++17", "-I", ROOT, *definitions, "-x", "c++", "-", "-o", program], input=PROGRAM,
                       universal_newlines=True, check=True)
        return subprocess.run([program], env={**os.environ, "DESERT_CPU": instructions}, check=True,
                              stdout=subprocess.PIPE, universal_newlines=True).stdout

    def test_a_build_for_all_processors_runs_on_each(self):
        self.assertEqual(self.problem("generic"), "")

    def test_a_build_for_one_runs_there(self):
        self.assertEqual(self.problem("generic", "-DDESERT_ONLY_INSTRUCTIONS=generic"), "")

    def test_a_build_for_one_refuses_another_and_says_what_to_do(self):
        for other in ("avx2", "avx512"):
            problem = self.problem("generic", "-DDESERT_ONLY_INSTRUCTIONS=" + other)
            self.assertIn("'generic'", problem)
            self.assertIn("-DDESERT_PORTABLE=ON", problem)

    def test_another_name_is_refused_with_those_that_there_are(self):
        self.assertEqual(self.problem("sse9"), "DESERT_CPU: 'sse9' is not one of generic, avx2, avx512, native")


if __name__ == "__main__":
    unittest.main()
