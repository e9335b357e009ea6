"""A rover of desert_rover_node."""
import collections
import math
import threading

import rospy
from geometry_msgs.msg import Pose2D, Twist
from nav_msgs.msg import Odometry
from std_srvs.srv import Trigger

from .msg import RoverStatus
from .services import SimulationError, call
from .srv import DriveRover, LoadRover, SaveRover, SetRoverPose

# Place of base_link [m] and heading, counter-clockwise from +x [rad].
Pose = collections.namedtuple("Pose", "x y z yaw")


class Rover:
    """Drives a rover, and says where it is.

        rover = desert_sim.Rover()                 # of launch/bringup.launch
        rover.drive(0.2, 0.1)                      # 0.2 m/s ahead, 0.1 rad/s to the left; holds for half a second
        x, y, z, yaw = rover.pose()

    name      namespace of its topics (launch/rover.launch: name)
    timeout   seconds of wall time to wait for first messages and for services
    Calls raise SimulationError with the rover's reason if they are refused, or if nothing comes within the timeout.
    """

    def __init__(self, name="rover", timeout=20.0):
        self.name, self.timeout = rospy.resolve_name(name), timeout
        self.node = self.name + "/desert_rover"
        self._changed, self._last = threading.Condition(), {}
        self._commands = rospy.Publisher(self.name + "/cmd_vel", Twist, queue_size=1)
        self._subscribers = [
            rospy.Subscriber(topic, kind, self._keep, topic, queue_size=1, tcp_nodelay=True)
            for topic, kind in ((self.name + "/ground_truth", Odometry), (self.name + "/odom", Odometry),
                                (self.node + "/status", RoverStatus))]

    # ---- driving

    def drive(self, forward, yaw_rate=0.0, left=0.0):
        """Publishes one command on cmd_vel: [m/s], counter-clockwise [rad/s], and to the left [m/s] for rovers that steer each
        wheel. It holds for ~cmd_vel_timeout (0.5 s of the rover's time); faster ones than the rover's limits are cut."""
        self._commands.publish(_twist(forward, yaw_rate, left))

    def command(self, forward, yaw_rate=0.0, left=0.0, seconds=0.0):
        """The same by the service ~drive, which answers when the rover obeys, in lockstep from exactly this step on.

        seconds   of the rover's time, for which the command holds; 0: until the next command
        Answers with terrain_step, and with state_hash of the rover before the command.
        """
        return self._call("drive", DriveRover, _twist(forward, yaw_rate, left), seconds)

    def stop(self):
        self.drive(0.0)

    def set_pose(self, x, y, yaw=0.0):
        """Puts it down at rest at (x, y) [m] with this heading [rad]; its odometry does not notice."""
        return self._call("set_pose", SetRoverPose, Pose2D(x, y, yaw))

    def reset(self):
        """Back to its start, with all counts at 0."""
        return self._call("reset", Trigger)

    def save_state(self, name):
        """The exact state, in a file below the rover's ~data_dir."""
        return self._call("save_state", SaveRover, name)

    def load_state(self, name):
        return self._call("load_state", LoadRover, name)

    # ---- looking

    def pose(self):
        """The last true Pose of base_link in the terrain's frame: x, y, z [m], yaw [rad]."""
        return pose_of(self.ground_truth())

    def distance_to(self, x, y):
        """From that place to a point of the terrain's frame, in the plane [m]."""
        now = self.pose()
        return math.hypot(x - now.x, y - now.y)

    def ground_truth(self):
        """The last nav_msgs/Odometry of the true motion."""
        return self._newest(self.name + "/ground_truth")

    def odometry(self):
        """The last nav_msgs/Odometry by the wheels: its error is the slip."""
        return self._newest(self.name + "/odom")

    def status(self):
        """The last RoverStatus: state (RoverStatus.DRIVING, STUCK, ...) and reason, slip, sinkage, ways."""
        return self._newest(self.node + "/status")

    def wait_for_stamp(self, stamp, timeout):
        """Waits for a pose of this ROS time or a later one, at most `timeout` seconds of wall time; whether it came. In
        lockstep poses have the stamps of the terrain's states: a rover whose pose has that of a LayerMap has driven on it."""
        topic = self.name + "/ground_truth"
        with self._changed:
            return self._changed.wait_for(
                lambda: topic in self._last and self._last[topic].header.stamp >= stamp, timeout)

    def wait_for_status(self, fits, timeout):
        """Waits until the last RoverStatus is one for which fits(status) is true, at most `timeout` seconds of wall time; whether
        it is. In lockstep one comes for each state of the terrain (terrain_stamp) and each message on cmd_vel (commands)."""
        topic = self.node + "/status"
        with self._changed:
            return self._changed.wait_for(lambda: topic in self._last and fits(self._last[topic]), timeout)

    def close(self):
        for subscriber in self._subscribers:
            subscriber.unregister()
        self._commands.unregister()

    def _call(self, service, kind, *arguments):
        return call(self.node + "/" + service, kind, self.timeout, *arguments)

    def _keep(self, message, topic):
        with self._changed:
            self._last[topic] = message
            self._changed.notify_all()

    def _newest(self, topic):
        with self._changed:
            if not self._changed.wait_for(lambda: topic in self._last, self.timeout):
                raise SimulationError(topic, "no message within %g s: %s" % (self.timeout, self._trouble()))
            return self._last[topic]

    def _trouble(self):
        """What keeps the rover from telling where it is; the caller holds the lock."""
        status = self._last.get(self.node + "/status")
        if status is None:
            return "there is no status of %s either: does it run?" % self.node
        return "its state is %s: %s" % (status.state, status.reason)


def _twist(forward, yaw_rate, left):
    twist = Twist()
    twist.linear.x, twist.linear.y, twist.angular.z = forward, left, yaw_rate
    return twist


def pose_of(odometry):
    """The Pose in a nav_msgs/Odometry."""
    place, q = odometry.pose.pose.position, odometry.pose.pose.orientation
    yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
    return Pose(place.x, place.y, place.z, yaw)
