#!/usr/bin/env python3
import unittest, rostest, desert_sim.testing

class Driver(unittest.TestCase):
    def test_it_arrives(self):
        with desert_sim.testing.Desert("rover_barchans", seed=3, rover=(12, 64)) as desert:
            desert.expect_cost(12, 64, at_most=30)                      # 0 free ... 99, 100 no way
            desert.expect_rover_arrives((14, 64), within=200)           # steps; 0.1 s of the rover's time each

rostest.rosrun("my_driver", "driver_test", Driver)
