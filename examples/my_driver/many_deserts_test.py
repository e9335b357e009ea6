#!/usr/bin/env python3
"""The driver crosses deserts whose sand differs from seed to seed. DESERT_SEEDS: how many, from the first one on, as "100"
or "20 from 40"; 2 where it is not said."""
import os
import re
import unittest

import desert_sim.testing
import rostest

SHARE = 0.9  # of the deserts that it has to cross
# Rock, with heaps of sand up to 1.5 m high where the noise of the seed is above a half.
DESERT = {"grid": {"width": 64, "height": 32, "cell_size": 0.5, "boundary": "open"}, "wind": {"speed": 6},
          "terrain": [{"uniform": {"layer": "bedrock", "value": 0}},
                      {"noise": {"layer": "sand", "low": 0, "high": 1.5, "scale": 16, "threshold": 0.5}}]}
START, GOAL = (4, 8), (14, 8)


def seeds():
    count, first = re.fullmatch(r"(\d+)(?: from (\d+))?", os.environ.get("DESERT_SEEDS", "2")).groups()
    return range(int(first or 0), int(first or 0) + int(count))


class ManyDeserts(unittest.TestCase):
    def crosses(self, seed):
        with desert_sim.testing.Desert(DESERT, seed=seed, rover=START, seconds_per_step=0.2) as desert:
            driver = desert_sim.testing.Node("driver", {"goal": list(GOAL)}, "driver.py", "my_driver")
            try:
                desert.expect_rover_arrives(GOAL, within=400)
            finally:
                driver.close()

    def test_it_crosses_most(self):
        lost = {}
        for seed in seeds():
            try:
                self.crosses(seed)
            except AssertionError as failure:  # its message names a picture
                lost[seed] = str(failure)
        self.assertLessEqual(len(lost), (1 - SHARE) * len(seeds()),
                             "\n".join("seed %d: %s" % item for item in lost.items()))


rostest.rosrun("my_driver", "many_deserts_test", ManyDeserts)
