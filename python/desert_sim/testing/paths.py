"""Messages that are waited for, and how far one path leads away from another."""
import math
import threading

import numpy
import rospy


class Inbox:
    """The messages of a topic since it was made."""

    def __init__(self, topic, kind):
        self.messages, self.changed = [], threading.Condition()
        self.subscriber = rospy.Subscriber(topic, kind, self._take, queue_size=100, tcp_nodelay=True)

    def _take(self, message):
        with self.changed:
            self.messages.append(message)
            self.changed.notify_all()

    def wait_for_more_than(self, count, seconds):
        """Waits for so many messages at most so long; whether they came."""
        with self.changed:
            return self.changed.wait_for(lambda: len(self.messages) > count, seconds)


def points_of(path):
    """[n, 2] points of a nav_msgs/Path [m]."""
    return numpy.array([(pose.pose.position.x, pose.pose.position.y) for pose in path.poses], float).reshape(-1, 2)


def deviation(path, reference):
    """How far the points of a path are at most from the line through those of another one [m]: 0 of a path without points,
    and inf from one without."""
    if not len(path):
        return 0.0
    if not len(reference):
        return math.inf
    starts, ends = reference[:-1], reference[1:]
    if not len(starts):
        starts = ends = reference
    along = ends - starts
    length = numpy.maximum((along ** 2).sum(1), 1e-12)
    share = numpy.clip(((path[:, None] - starts) * along).sum(2) / length, 0, 1)
    gaps = numpy.linalg.norm(path[:, None] - (starts + share[..., None] * along), axis=2)
    return float(gaps.min(1).max())
