#!/usr/bin/env python3
"""What a client says of topics that do not come, and when: as WaitingNotice of C++."""
import unittest

from desert_sim.waiting_notice import WaitingNotice, waiting_text


class WaitingNotices(unittest.TestCase):
    def test_the_topic_is_named_and_what_has_its_name_elsewhere(self):
        self.assertEqual(waiting_text([("/desert_sim/elevation", False)],
                                      ["/mars/desert_sim/elevation", "/mars/desert_sim/elevation_updates"]),
                         "The terrain client waits. Nobody publishes /desert_sim/elevation (somebody does "
                         "/mars/desert_sim/elevation).")
        self.assertEqual(waiting_text([("/a/elevation", False), ("/a/layers/sand_depth", True)], []),
                         "The terrain client waits. Nobody publishes /a/elevation. Nothing has come yet of "
                         "/a/layers/sand_depth.")
        self.assertEqual(waiting_text([("/a/elevation", False)], ["/a/elevation", "/b/elevation"]),
                         "The terrain client waits. Nothing has come yet of /a/elevation.")

    def test_it_is_due_after_three_seconds_and_every_half_minute(self):
        notice = WaitingNotice()
        moments = (0, 2.9, 3, 32.9, 33)
        self.assertEqual([notice.due(True, t) for t in moments], [False, False, True, False, True])
        self.assertFalse(notice.due(False, 99))
        self.assertEqual([notice.due(True, t) for t in (99.1, 102.1)], [False, True])


if __name__ == "__main__":
    unittest.main()
