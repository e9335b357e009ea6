#!/usr/bin/env python3
"""teleop.py: what keys ask for, and the program on a terminal of its own with a ROS master of its own."""
import os
import pty
import signal
import socket
import subprocess
import sys
import termios
import threading
import time
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
COMMAND = [sys.executable, os.path.join(ROOT, "scripts", "teleop.py")]
# The program on a machine so loaded that rospy's sending threads come late: what it leaves to one of them at its end is lost.
LOADED = [sys.executable, "-c", """
import runpy, sys, time
from rospy.impl.tcpros_pubsub import QueuedConnection
send_what_comes = QueuedConnection._run
def send_it_late(queued):
    write = queued._connection.write_data
    queued._connection.write_data = lambda data: (time.sleep(0.2), write(data))
    send_what_comes(queued)
QueuedConnection._run = send_it_late
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")
""", COMMAND[1]]
PATIENCE = 60 * float(os.environ.get("DESERT_PATIENCE", "1"))
sys.path.insert(0, os.path.join(ROOT, "scripts"))


def free_port():
    with socket.socket() as free:
        free.bind(("localhost", 0))
        return free.getsockname()[1]


PORT = free_port()
os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % PORT
os.environ["ROS_HOSTNAME"] = "localhost"

import rosgraph  # noqa: E402
import rospy  # noqa: E402
from geometry_msgs.msg import Twist  # noqa: E402
from teleop import Driver, keys_of  # noqa: E402


class Keys(unittest.TestCase):
    def test_arrows_mean_letters(self):
        self.assertEqual(keys_of("i\x1b[A\x1bOBx\x1b[C\x1b[D"), ["i", "i", "k", "x", "l", "j"])
        self.assertEqual(keys_of("I\x1b[5~"), ["i", "~"], "a page key is none of them")
        self.assertEqual(keys_of("\x1b"), ["\x1b"])

    def test_a_key_drives_until_it_has_been_still_for_a_while(self):
        driver = Driver(0.2, 0.4, hold=1)
        self.assertIsNone(driver.command(0))
        driver.press("i", 10)
        self.assertEqual(driver.command(10.9), (0.2, 0))
        driver.press("l", 10.9)
        self.assertEqual(driver.command(11.8), (0, -0.4))
        self.assertEqual(driver.command(11.9), (0, 0), "it stops")
        self.assertIsNone(driver.command(12), "once")
        driver.press("u", 20)
        driver.press(" ", 20.1)
        self.assertEqual(driver.command(20.1), (0, 0))

    def test_speed(self):
        driver = Driver(0.2, 0.4, hold=1)
        driver.press("+", 0)
        self.assertIsNone(driver.command(0), "no motion")
        driver.press("k", 0)
        self.assertAlmostEqual(driver.command(0)[0], -0.22)
        driver.press("-", 0)
        self.assertAlmostEqual(driver.command(0)[0], -0.2)


class OnATerminal(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = subprocess.Popen(["rosmaster", "--core", "-p", str(PORT)], stdout=subprocess.DEVNULL,
                                      stderr=subprocess.DEVNULL)
        end = time.monotonic() + PATIENCE
        while not rosgraph.is_master_online():
            assert time.monotonic() < end, "rosmaster does not start"
            time.sleep(0.05)
        cls.changed, cls.commands = threading.Condition(), []
        rospy.init_node("teleop_test", disable_signals=True)
        cls.subscriber = rospy.Subscriber("/scout/cmd_vel", Twist, cls.take)

    @classmethod
    def tearDownClass(cls):
        rospy.signal_shutdown("the test is over")
        cls.master.terminate()
        cls.master.wait()

    @classmethod
    def take(cls, message):
        with cls.changed:
            cls.commands.append((message.linear.x, message.angular.z))
            cls.changed.notify_all()

    def start(self, *words, command=COMMAND):
        del self.commands[:]
        self.screen, keyboard = pty.openpty()
        self.before = termios.tcgetattr(self.screen)
        self.program = subprocess.Popen([*command, "cmd_vel:=/scout/cmd_vel", *words], stdin=keyboard,
                                        stdout=keyboard, stderr=keyboard)
        os.close(keyboard)
        self.addCleanup(os.close, self.screen)
        self.addCleanup(self.program.kill)
        # It takes keys once they are not shown any more, and is heard once it is connected.
        end = time.monotonic() + PATIENCE
        while termios.tcgetattr(self.screen)[3] & termios.ECHO or not self.subscriber.get_num_connections():
            self.assertLess(time.monotonic(), end, "it does not take the terminal")
            self.assertIsNone(self.program.poll())
            time.sleep(0.05)

    def commands_come(self, expected):
        with self.changed:
            self.assertTrue(self.changed.wait_for(lambda: expected in self.commands, PATIENCE), self.commands[-5:])

    def ends_well(self):
        self.assertEqual(self.program.wait(PATIENCE), 0)
        self.assertEqual(termios.tcgetattr(self.screen), self.before, "the terminal is as it was")

    def test_it_drives_and_stops_when_keys_stop(self):
        self.start("_hold:=0.3")
        os.write(self.screen, b"i")
        self.commands_come((0.2, 0.0))
        self.commands_come((0.0, 0.0))
        os.write(self.screen, b"\x1b[D")
        self.commands_come((0.0, 0.4))
        os.write(self.screen, b"q")
        self.ends_well()

    def test_it_stops_the_rover_and_gives_the_terminal_back_when_it_is_ended(self):
        for end in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(end):
                self.start("_hold:=900", command=LOADED)
                os.write(self.screen, b"i")
                self.commands_come((0.2, 0.0))
                self.program.send_signal(end)
                self.commands_come((0.0, 0.0))
                self.ends_well()

    def test_without_a_terminal_it_says_so(self):
        answer = subprocess.run(COMMAND, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
        self.assertEqual(answer.returncode, 2)
        self.assertIn("no terminal", answer.stderr)

    def test_parameters_out_of_range(self):
        screen, keyboard = pty.openpty()
        answer = subprocess.run([*COMMAND, "_speed:=-1"], stdin=keyboard, capture_output=True, text=True, check=False)
        os.close(screen), os.close(keyboard)
        self.assertNotEqual(answer.returncode, 0)
        self.assertIn("/teleop/speed: -1 (allowed: a number above 0", answer.stderr)


if __name__ == "__main__":
    unittest.main()
