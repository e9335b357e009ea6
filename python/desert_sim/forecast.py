"""Forecasts of a desert_sim node."""
import dataclasses
import time

import actionlib
import numpy
import rospy

from .layer_map import LayerMap
from .layer_messages import map_of
from .msg import ForecastTerrainAction, ForecastTerrainGoal
from .services import SimulationError

_REPEAT_PERIOD = 1.0  # [s] of wall time, after which a goal that the server does not know may be lost


@dataclasses.dataclass(frozen=True)
class Forecast:
    """What the terrain will be like at m moments: msg/Forecast.msg as arrays. Times are of ROS, in seconds after `stamp`, as
    the live run is paced.

    Arrays of cells are [height, width], row 0 in the south; `elevation[n]` says where they lie (origin_x, origin_y,
    cell_size, frame).
    """
    stamp: rospy.Time              # ROS time of the state that the forecast begins with
    step: int                      # of that state
    sim_time: float                # the desert's own time of that state [s]
    seconds_per_sim_second: float  # seconds of ROS time for a second of the desert's own time
    members: int                   # runs with a wind of their own; 1: only that of the live run
    times: numpy.ndarray           # [m] of the moments, rising [s]
    steps: numpy.ndarray           # [m] of the moments
    state_hashes: list             # [m] texts of 16 hexadecimal digits
    costs: numpy.ndarray           # int8 [m, height, width], as ~costmap: 0 ... 99, 100 lethal, -1 unknown
    elevation: list                # [m] LayerMaps [m]
    passable_until: LayerMap       # how long a cell stays passable [s]: 0 if it is not now, inf beyond the horizon
    passable_from: LayerMap        # since when it is passable [s]: 0 if it is now, inf if it is not at the horizon
    probability: numpy.ndarray     # float32 [m, height, width]: share of the members for which it is passable; [0, ...] with one


def _times_map(grid):
    """A LayerMap of times, which may be infinite."""
    values = numpy.array(grid.data, numpy.float32)
    grid.data = numpy.zeros(values.size, numpy.float32)
    values = values.reshape(grid.height, grid.width)
    values.setflags(write=False)
    return dataclasses.replace(map_of(grid), values=values)


def forecast_of(message):
    """The Forecast of a desert_sim/Forecast message."""
    elevation = [map_of(grid) for grid in message.elevation]
    height, width = message.passable_until.height, message.passable_until.width

    def stack(arrays, kind):
        return numpy.array([numpy.asarray(a, kind) for a in arrays], kind).reshape(len(arrays), height, width)

    return Forecast(
        message.header.stamp, message.step, message.sim_time, message.seconds_per_sim_second, message.members,
        numpy.array(message.times, float), numpy.array(message.steps, numpy.int64), list(message.state_hashes),
        stack([grid.data for grid in message.costs], numpy.int8), elevation, _times_map(message.passable_until),
        _times_map(message.passable_from), stack([grid.data for grid in message.probability], numpy.float32))


def request_forecast(action, server_timeout, timeout, on_progress, **goal):
    """Simulation.forecast(). Raises SimulationError if the node refuses it, does not answer, or is late."""
    # Not SimpleActionClient: an answer that comes before its send_goal() has returned is lost to it.
    client = actionlib.ActionClient(action, ForecastTerrainAction)
    try:
        if not _wait(lambda: _is_connected(client), server_timeout):
            raise SimulationError(action, "there is no such action after %g s: does the node run?" % server_timeout)
        handle = client.send_goal(ForecastTerrainGoal(**goal),
                                  feedback_cb=on_progress and (lambda _, feedback: on_progress(feedback.progress)))
        if not _wait(_SentGoal(client, handle).has_ended, timeout):
            handle.cancel()
            raise SimulationError(action, "no forecast within %g s: it was cancelled" % timeout)
        result, state = handle.get_result(), handle.get_terminal_state()
        if state != actionlib.TerminalState.SUCCEEDED or not result.success:
            reason = (result.message if result else "") or handle.get_goal_status_text()
            raise SimulationError(action, reason or "it ended in state %s" % actionlib.TerminalState.to_string(state))
        return forecast_of(result.forecast)
    finally:
        client.stop()


class _SentGoal:
    """A goal on its way, which is sent again while the server says nothing of it: a server that has it takes no notice.

    It is lost on a connection that the node is about to close: one that it had to an earlier client of this process, and has
    made anew to this one because the master has not told it yet that the earlier one is gone."""

    def __init__(self, client, handle):
        self._client, self._handle, self._sent = client, handle, time.monotonic()

    def has_ended(self):
        state, now = self._handle.get_comm_state(), time.monotonic()
        if state == actionlib.CommState.WAITING_FOR_GOAL_ACK and now - self._sent > _REPEAT_PERIOD:
            self._sent = now
            self._client.pub_goal.publish(self._handle.comm_state_machine.action_goal)
        return state == actionlib.CommState.DONE


def _wait(happened, timeout):
    """Waits by the wall's clock: a node that is the clock itself shows no time while it is paused."""
    end = None if timeout is None else time.monotonic() + timeout
    while not happened():
        if rospy.is_shutdown() or end is not None and time.monotonic() > end:
            return False
        time.sleep(0.01)
    return True


def _is_connected(client):
    """Whether a server listens and will be heard: by its connections, because it tells its status by ROS time only."""
    ends = (client.pub_goal, client.pub_cancel, client.result_sub, client.feedback_sub)
    return all(end.get_num_connections() > 0 for end in ends)
