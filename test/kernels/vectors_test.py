#!/usr/bin/env python3
"""Laws whose loops a CPU has to work on as vectors: vectors_test.py LIBRARY. GCC leaves a loop scalar, and says nothing, for a
single branch, a truth value that was a number, or a sum of a square root that it carries from cell to cell; a step then takes
up to three times as long, with the same result. Of the arithmetic that the library has for a law with AVX2, a fifth at least
must be of vectors; what is scalar otherwise are the ends of rows."""
import collections
import re
import subprocess
import sys
import unittest

LAWS = [
    "avalanching::RelaxTile", "continuum::Prepare<true, true>", "continuum::PassSand<true>", "face_flow::MoveWater<true>",
    "looseness::Slide", "plants::Illuminate<true>", "reptation::SetAngles", "reptation::Smooth<true>",
    "saltation::DepositOfOne<true, true>", "saltation::LiftAndAdvect<true>", "shallow_water::Accelerate<true>",
    "shear_stress::Respond", "slabs::SettleSnow", "virtual_pipes::Accelerate<true>", "wind_shadow::ShadowOfBlock",
]
FUNCTION = re.compile(r"[0-9a-f]+ <.*with_avx2<desert_sim::(?:for_each_in_row|for_each_tile|add_row|pass_line)<(.*)>:$")
LAW = re.compile(r"(?:desert_sim::Tiles, )?desert_sim::(%s)\b" % "|".join(re.escape(law).rstrip(">") for law in LAWS))
ARITHMETIC = re.compile(r"\tv(?:add|sub|mul|div|sqrt|max|min|fn?m(?:add|sub)\d*)([ps])s ")


def counts(library):
    """By law: operations that are of vectors, and all."""
    code = subprocess.run(["objdump", "-dC", "--no-show-raw-insn", library], check=True, stdout=subprocess.PIPE,
                          universal_newlines=True).stdout
    vectors, all_of_them, law = collections.Counter(), collections.Counter(), None
    for line in code.split("\n"):
        if line.endswith(">:"):
            function = FUNCTION.match(line)
            found = LAW.match(function.group(1)) if function else None
            law = found.group(1) if found else None
        elif law:
            operation = ARITHMETIC.search(line)
            if operation:
                vectors[law] += operation.group(1) == "p"
                all_of_them[law] += 1
    return vectors, all_of_them


class Laws(unittest.TestCase):
    def test_are_vectors(self):
        vectors, all_of_them = counts(sys.argv[1])
        for law in LAWS:
            name = law.rstrip(">")
            with self.subTest(law):
                self.assertGreater(all_of_them[name], 0, "the library has no code of it for AVX2")
                self.assertGreater(vectors[name] / all_of_them[name], 0.2)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
