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
        if not _wait(lambda: handle.get_comm_state() == actionlib.CommState.DONE, timeout):
            handle.cancel()
            raise SimulationError(action, "no forecast within %g s: it was cancelled" % timeout)
        result, state = handle.get_result(), handle.get_terminal_state()
        if state != actionlib.TerminalState.SUCCEEDED or not result.success:
            reason = (result.message if result else "") or handle.get_goal_status_text()
            raise SimulationError(action, reason or "it ended in state %s" % actionlib.TerminalState.to_string(state))
        return forecast_of(result.forecast)
    finally:
        client.stop()


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
