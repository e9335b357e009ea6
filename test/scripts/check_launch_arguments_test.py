#!/usr/bin/env python3
"""check_launch_arguments.py: roslaunch refuses arguments that a launch file does not have. No master is needed."""
import os
import subprocess
import sys
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
LAUNCH = os.path.join(ROOT, "launch")
sys.path.insert(0, os.path.join(ROOT, "scripts"))
from check_launch_arguments import arguments_of, given  # noqa: E402


def roslaunch(*words):
    return subprocess.run(["roslaunch", "--nodes", *words], capture_output=True, text=True, check=False)


class CheckLaunchArguments(unittest.TestCase):
    def test_each_launch_file_is_checked(self):
        for name in sorted(os.listdir(LAUNCH)):
            with self.subTest(name), open(os.path.join(LAUNCH, name), encoding="utf-8") as file:
                self.assertIn("/check_launch_arguments.py '$(find desert_sim)/launch/%s'" % name, file.read())

    def test_an_unknown_argument_is_refused(self):
        for words in (["desert_sim", "demo.launch", "senario:=wadi"],
                      [os.path.join(LAUNCH, "demo.launch"), "senario:=wadi"]):
            answer = roslaunch(*words)
            self.assertNotEqual(answer.returncode, 0, words)
            self.assertIn("demo.launch has no argument 'senario'; did you mean 'scenario'?", answer.stderr)
            self.assertNotIn("/desert_sim", answer.stdout)

    def test_what_a_file_sets_for_another_is_none_of_its_own(self):
        self.assertIn("lidar", arguments_of(os.path.join(LAUNCH, "demo_rover.launch")), "of bringup.launch")
        self.assertNotEqual(roslaunch("desert_sim", "demo_rover.launch", "scenario:=wadi").returncode, 0)

    def test_known_arguments_pass_with_those_of_the_file_that_takes_all(self):
        answer = roslaunch("desert_sim", "demo.launch", "gui:=false", "scenario:=wadi", "time_step:=0.5")
        self.assertEqual(answer.stdout.split(), ["/desert_sim"], answer.stderr)

    def test_a_file_that_another_one_includes_is_not_held_to_the_command_line(self):
        answer = roslaunch("desert_sim", "bringup.launch", "gui:=false", "rover:=scout")
        self.assertIn("/scout/desert_rover", answer.stdout.split(), answer.stderr)

    def test_whose_arguments_they_are(self):
        path = os.path.join(LAUNCH, "rover.launch")
        self.assertEqual(given(["/usr/bin/python3", "/usr/bin/roslaunch", "-p", "11312", "desert_sim", "rover.launch",
                                "x:=1", "__log:=a"], path), ["x"])
        self.assertEqual(given(["roslaunch", "other", "rover.launch", "y:=1"], path), [])
        self.assertEqual(given(["rostest", "desert_sim", "rover.launch", "y:=1"], path), [])
        self.assertEqual(given(["roslaunch", path, "y:=1"], path), ["y"])


if __name__ == "__main__":
    unittest.main()
