#!/usr/bin/env python3
"""Processes that end with their parent."""
import os
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../python"))

from desert_comparison import processes  # noqa: E402


class Processes(unittest.TestCase):
    def status_of_one_that_ends_with(self, parent):
        code = "import sys; sys.path.insert(0, sys.argv[1]); import processes; processes.end_with(int(sys.argv[2]))"
        return subprocess.run([sys.executable, "-c", code, os.path.dirname(processes.__file__), str(parent)]).returncode

    def test_a_process_whose_parent_has_ended_already_ends_at_once(self):
        self.assertEqual(self.status_of_one_that_ends_with(os.getpid()), 0)
        with subprocess.Popen(["true"]) as ended:
            pass
        self.assertEqual(self.status_of_one_that_ends_with(ended.pid), -9)

    def test_a_process_ends_with_the_one_that_has_started_it(self):
        """Of three, the second is killed; the third holds the end of a pipe until it ends."""
        reader, writer = os.pipe()
        code = ("import subprocess, sys; sys.path.insert(0, sys.argv[1]); import processes; pipe = int(sys.argv[2]); "
                "subprocess.run(['sh', '-c', 'printf up >&%d; exec sleep 1000000' % pipe], pass_fds=[pipe], "
                "preexec_fn=processes.ends_with_this())")
        with subprocess.Popen([sys.executable, "-c", code, os.path.dirname(processes.__file__), str(writer)],
                              pass_fds=[writer]) as second, os.fdopen(reader, "rb") as pipe:
            os.close(writer)
            self.assertEqual(pipe.read(2), b"up")
            second.kill()
            self.assertEqual(pipe.read(), b"")


if __name__ == "__main__":
    unittest.main()
