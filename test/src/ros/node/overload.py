#!/usr/bin/env python3
"""Subscribers that do not read, a request of many steps under way, and ended in the middle of it all: the simulation goes
on, others are served between two steps, memory stays bounded, and the node ends. (How fast and how soon is measured by
overload_timing.py.)"""
import io
import resource
import select
import signal
import socket
import threading
import xmlrpc.client

from desert_sim.msg import ElevationGrid, ElevationUpdate, SimulationStatus
from desert_sim.srv import QueryTerrain, SetWind, Step
from desert_sim.testing import PATIENCE, wait_until
from geometry_msgs.msg import Point
from map_client import Listener
from node_tests import CORNER, Scenarios
import rosgraph
from rosgraph.network import read_ros_handshake_header, write_ros_handshake_header
import rosnode
import rospy
from rospy.numpy_msg import numpy_msg
import rostest
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Trigger

MANY = 4000000000  # steps: nobody waits for their end


def connect_deaf(topic):
    """The connection of a subscriber, in the protocol of ROS, from which nobody reads what the publisher sends."""
    name = "/deaf" + topic.replace("/", "_")
    master = rosgraph.Master(name)
    node = master.lookupNode(topic.rpartition("/")[0])
    code, message, protocol = xmlrpc.client.ServerProxy(node).requestTopic(name, topic, [["TCPROS"]])
    assert code == 1, message
    connection = socket.socket()
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    connection.connect(tuple(protocol[1:]))
    write_ros_handshake_header(connection, {"callerid": name, "topic": topic, "md5sum": "*", "type": "*"})
    read_ros_handshake_header(connection, io.BytesIO(), 1)
    return connection


def memory(node):
    with open("/proc/%d/statm" % node.process.pid) as file:
        return int(file.read().split()[1]) * resource.getpagesize()


class Overload(Scenarios):
    def step_in_background(self, node):
        """A call for many steps that is under way: its thread, the list that its answer will be in, and statuses."""
        answers = []

        def call():
            try:
                answers.append(node.call("step", Step, MANY))
            except rospy.ServiceException as e:
                answers.append(e)

        status = Listener(node.path + "/status", SimulationStatus)
        self.addCleanup(status.close)
        before = status.first().step
        thread = threading.Thread(target=call)
        thread.start()
        status.wait_for(lambda m: m.step >= before + 2, "it does not step")
        return thread, answers, status

    # ---- subscribers ---------------------------------------------------------------------------

    def test_subscribers_that_do_not_read_hold_nobody_up(self):
        node = self.start("unread", {"scenario": CORNER, "settings": ["grid.width=256", "grid.height=256"],
                                     "keyframe_rate": 0, "update_rate": 0, "update_threshold": 0, "points_rate": 0})
        topics = {"elevation": ElevationGrid, "elevation_updates": ElevationUpdate, "points": PointCloud2}
        readers = {name: Listener("/unread/" + name, numpy_msg(kind)) for name, kind in topics.items()}
        for reader in readers.values():
            self.addCleanup(reader.close)
        readers["elevation"].first()
        readers["points"].first()
        deaf = [connect_deaf("/unread/" + name) for name in topics]
        for connection in deaf:
            self.addCleanup(connection.close)

        def all_are_sent_something():
            node.call("step", Step, 1)
            return len(select.select(deaf, [], [], 0)[0]) == len(deaf)

        wait_until(all_are_sent_something, "the node does not know its subscribers")

        def publish(steps):
            """Steps one by one: those who read are shown each. How many bytes."""
            total = 0
            for _ in range(steps):
                step = node.call("step", Step, 1).step
                grid = readers["elevation"].wait_for(lambda m: m.step == step, "a keyframe")  # noqa: B023
                readers["elevation_updates"].wait_for(lambda m: m.step == step, "an update")  # noqa: B023
                stamp = grid.header.stamp
                cloud = readers["points"].wait_for(lambda m: m.header.stamp == stamp, "points")  # noqa: B023
                total += grid.elevation.nbytes + len(cloud.data)
            return total

        publish(30)  # queues and the buffers of the connections are full then
        before = memory(node)
        published = publish(40)
        grown = memory(node) - before
        print("the memory grew by %.3f of the %.0f MB that were published" % (grown / published, published / 1e6))
        self.assertLess(grown / published, 0.5)
        self.assertEqual(node.end()[0], 0, node.output)

    # ---- between two steps ---------------------------------------------------------------------

    def test_others_are_served_between_two_of_many_steps(self):
        node = self.start("stepping", {"scenario": CORNER, "status_rate": 100})
        thread, answers, status = self.step_in_background(node)
        for n in range(8):
            # After a command a query is given no copy that was made before.
            self.assertTrue(node.call("set_wind", SetWind, speed=5 + n).success)
            answer = node.call("query_terrain", QueryTerrain, points=[Point(20, 20, 0)])
            self.assertTrue(answer.success, answer.message)
            status.wait_for(lambda m: m.step > answer.step, "steps and queries take turns")  # noqa: B023
        self.assertEqual(answers, [])
        self.assertTrue(node.call("pause", Trigger).success)
        thread.join(60 * PATIENCE)
        self.assertFalse(answers[0].success)
        self.assertIn("ended by a pause after", answers[0].message)

    # ---- ends, though nothing of what it does would end by itself ------------------------------

    @staticmethod
    def interrupt(node):
        node.process.send_signal(signal.SIGINT)

    @staticmethod
    def terminate(node):
        node.process.send_signal(signal.SIGTERM)

    def rosnode_kill(self, node):
        self.assertEqual(rosnode.kill_nodes([node.path]), ([node.path], []))

    def start_one_an_end(self, **private):
        """A node for each way to end it, and that way."""
        ends = (("interrupted", self.interrupt), ("terminated", self.terminate), ("dismissed", self.rosnode_kill))
        return [(self.start(name, dict({"scenario": CORNER, "step_rate": 0}, **private)), end) for name, end in ends]

    def expect_end(self, node, end):
        end(node)
        status, output = node.wait()
        self.assertEqual(status, 0, output)

    def test_ends_while_it_runs(self):
        for node, end in self.start_one_an_end(paused=False):
            wait_until(lambda: node.latest("status", SimulationStatus).step > 0, "it does not run")  # noqa: B023
            self.expect_end(node, end)

    def test_ends_while_many_steps_are_under_way(self):
        for node, end in self.start_one_an_end(status_rate=100):
            thread, answers, _ = self.step_in_background(node)
            self.assertEqual(answers, [])
            self.expect_end(node, end)
            thread.join(60 * PATIENCE)
            self.assertEqual(len(answers), 1, "the client that waits is let go")

    def test_ends_while_paused(self):
        for node, end in self.start_one_an_end():
            node.call("pause", Trigger)
            self.expect_end(node, end)


if __name__ == "__main__":
    rospy.init_node("overload", disable_signals=True)
    rostest.rosrun("desert_sim", "overload", Overload)
