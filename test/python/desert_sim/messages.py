"""Messages of a sender whose numbers and elevations a test chooses: test/support/messages.hpp in Python."""
import numpy
import rospy
from desert_sim.msg import ElevationGrid, ElevationUpdate, LayerTile

WIDTH, HEIGHT = 130, 70


def keyframe(number, step, width=WIDTH, height=HEIGHT, elevation=0.0):
    """At second `step` of ROS time; cells of 2 m, corner at (10, -20)."""
    grid = ElevationGrid(keyframe=number, step=step, sim_time=step, width=width, height=height, cell_size=2)
    grid.header.frame_id, grid.header.stamp = "terrain", rospy.Time(step)
    grid.origin.position.x, grid.origin.position.y, grid.origin.orientation.w = 10, -20, 1
    grid.elevation = numpy.full(width * height, elevation, numpy.float32)
    return grid


def tile(x, y, width, height, elevation):
    return LayerTile(x=x, y=y, width=width, height=height, data=[elevation] * (width * height))


def update(number, sequence, step, elevation=1.0):
    """Writes `elevation` on cells (0...1, 0...2)."""
    message = ElevationUpdate(keyframe=number, sequence=sequence, step=step, sim_time=step)
    message.header.frame_id, message.header.stamp = "terrain", rospy.Time(step)
    message.tiles = [tile(0, 0, 2, 3, elevation)]
    return message
