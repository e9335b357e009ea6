#!/usr/bin/env python3
"""Drives a rover by the keyboard of a terminal: rosrun desert_sim teleop.py cmd_vel:=/rover/cmd_vel

    i, up arrow     ahead          u, o    ahead and to the left, right
    k, down arrow   back           + -     faster, slower (10 %)
    j, left arrow   turn left      space   stop
    l, right arrow  turn right     q       end

Hold a key to drive. The rover stops ~hold seconds (1) after the last key, and when this ends. While no key is pressed, nothing
is published, so that a planner can drive. Private parameters: ~speed [m/s] (0.2), ~turn [rad/s] (0.4), ~rate [Hz] (10), ~hold [s].
"""
import os
import select
import signal
import sys
import termios
import time
import tty
import warnings

import rospy
from geometry_msgs.msg import Twist

# Shares of speed and turn; arrows come as escape sequences, of both modes that terminals have.
MOTIONS = {"i": (1, 0), "k": (-1, 0), "j": (0, 1), "l": (0, -1), "u": (1, 1), "o": (1, -1)}
ARROWS = {"A": "i", "B": "k", "C": "l", "D": "j"}
FASTER = {"+": 1.1, "=": 1.1, "-": 1 / 1.1, "_": 1 / 1.1}


def keys_of(text):
    """The keys of what a terminal sent: letters, and arrows as the letters that mean the same."""
    keys, n = [], 0
    while n < len(text):
        if text[n] == "\x1b" and text[n + 1:n + 2] in ("[", "O"):
            keys += [ARROWS[letter] for letter in text[n + 2:n + 3] if letter in ARROWS]
            n += 3
        else:
            keys.append(text[n].lower())
            n += 1
    return keys


class Driver:
    """What the keys ask for; `now` is any clock that never goes back [s]."""

    def __init__(self, speed, turn, hold):
        self.speed, self.turn, self.hold = speed, turn, hold
        self.motion, self.until = (0, 0), None

    def press(self, key, now):
        if key in FASTER:
            self.speed, self.turn = self.speed * FASTER[key], self.turn * FASTER[key]
        elif key in MOTIONS:
            self.motion, self.until = MOTIONS[key], now + self.hold
        elif key == " ":
            self.motion, self.until = (0, 0), now

    def command(self, now):
        """(forward [m/s], left [rad/s]); None once it has stopped: there is nothing to say then."""
        if self.until is None:
            return None
        if now >= self.until:
            self.motion, self.until = (0, 0), None
        return self.motion[0] * self.speed, self.motion[1] * self.turn


class Terminal:
    """The terminal gives each key at once and shows none of them, until the end, however it comes.

    A signal in SIGNALS is such an end, too. It is noticed between two commands: an exception out of its handler would
    leave the one that is being sent in pieces.
    """
    SIGNALS = (signal.SIGTERM, signal.SIGHUP, signal.SIGINT)

    def __init__(self, descriptor):
        self.descriptor, self.before = descriptor, termios.tcgetattr(descriptor)
        self.ended, end = os.pipe()
        for number in self.SIGNALS:
            signal.signal(number, lambda *_: os.write(end, b"."))

    def __enter__(self):
        tty.setcbreak(self.descriptor)  # Ctrl-C still interrupts
        return self

    def __exit__(self, *_):
        termios.tcsetattr(self.descriptor, termios.TCSADRAIN, self.before)

    def keys(self, seconds):
        """Those that come within so many seconds; None when the terminal has gone, or after a signal."""
        try:
            ready = select.select([self.descriptor, self.ended], [], [], seconds)[0]
            if not ready:
                return []
            if self.ended in ready:
                return None
            text = os.read(self.descriptor, 1024).decode(errors="ignore")
        except OSError:
            return None
        return keys_of(text) if text else None


def positive(name, default):
    value = rospy.get_param(name, default)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 < value < 1e3:
        sys.exit("teleop.py: %s: %r (allowed: a number above 0, below 1000)" % (rospy.resolve_name(name), value))
    return float(value)


def twist(forward, left):
    message = Twist()
    message.linear.x, message.angular.z = forward, left
    return message


def advertise(topic):
    """A publisher whose messages have left when publish() returns.

    With a queue the last one, which stops the rover, is lost when the program ends before the queue's thread runs.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SyntaxWarning)  # no queue_size, as is meant here
        return rospy.Publisher(topic, Twist)


def drive(terminal, driver, publisher, period):
    due = time.monotonic()
    while not rospy.is_shutdown():
        keys = terminal.keys(max(0.0, due - time.monotonic()))
        if keys is None or "q" in keys:
            return
        for key in keys:
            driver.press(key, time.monotonic())
        if keys:
            print("\r%.2f m/s, %.2f rad/s " % (driver.speed, driver.turn), end="", flush=True)
            due = time.monotonic()
        if time.monotonic() < due:
            continue
        due = time.monotonic() + period
        command = driver.command(time.monotonic())
        if command is not None:
            publisher.publish(twist(*command))


def main():
    if not sys.stdin.isatty():
        print("teleop.py: the standard input is no terminal, so that there are no keys: start it in a terminal, not in the "
              "background and without a pipe", file=sys.stderr)
        return 2
    for number in Terminal.SIGNALS:
        signal.signal(number, lambda *_: sys.exit(0))  # while there is no master yet, say
    rospy.init_node("teleop", disable_signals=True)
    driver = Driver(positive("~speed", 0.2), positive("~turn", 0.4), positive("~hold", 1.0))
    period = 1 / positive("~rate", 10.0)
    publisher = advertise("cmd_vel")
    print(__doc__.split("\n\n")[1] + "\n\nto " + publisher.resolved_name, flush=True)
    try:
        with Terminal(sys.stdin.fileno()) as terminal:
            drive(terminal, driver, publisher, period)
    finally:
        publisher.publish(Twist())
        print(flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
