#!/usr/bin/env python3
"""Keyframes and updates, put together as doc/ros_interface.md shows for Python."""
import time

import numpy
import rospy
import rostest
from desert_sim.msg import ElevationGrid, ElevationUpdate, LayerGrid, LayerUpdate
from desert_sim.srv import EditTerrain, EditTerrainRequest, Step
from map_client import Listener, MapTest, call
from std_msgs.msg import Empty, String

THRESHOLD = 0.01


def cells_of(keyframe):
    values = keyframe.data if hasattr(keyframe, "layer") else keyframe.elevation
    return numpy.array(values, numpy.float32).reshape(keyframe.height, keyframe.width)


def write(update, held):
    """Over `held`, the cells of the keyframe and of all updates since: float32, height x width."""
    for tile in update.tiles:
        cells = held[tile.y:tile.y + tile.height, tile.x:tile.x + tile.width]
        mask = numpy.ones(cells.shape, bool)
        if tile.changed:
            mask = numpy.unpackbits(numpy.frombuffer(tile.changed, numpy.uint8), count=cells.size)
            mask = mask.astype(bool).reshape(cells.shape)
        if tile.changes:
            changes = numpy.array(tile.changes, numpy.int8)
            if tile.bits == 4:
                changes = numpy.stack((changes >> 4, (changes << 4) >> 4), 1).reshape(-1)[:mask.sum()]
            cells[mask] = cells[mask].astype(float) + changes * float(tile.resolution)
        else:
            cells[mask] = tile.data


class Updates(MapTest):
    def test_python_puts_those_of_the_elevation_together(self):
        asks = rospy.Publisher("/desert_sim/request_keyframe", Empty, queue_size=1)
        self.expect_same("elevation", ElevationGrid, ElevationUpdate, asks.publish)

    def test_python_puts_those_of_a_layer_together(self):
        asks = rospy.Publisher("/desert_sim/layers/request_keyframe", String, queue_size=1)
        self.expect_same("layers/sand_depth", LayerGrid, LayerUpdate, lambda: asks.publish("sand_depth"))

    def expect_same(self, topic, grid, update_type, request_keyframe):
        with Listener("/desert_sim/" + topic, grid) as keyframes, \
                Listener("/desert_sim/" + topic + "_updates", update_type) as updates:
            keyframes.first()
            time.sleep(1)  # both are subscribed: the last keyframe is the one that updates build on
            base = keyframes.messages[-1]
            held = cells_of(base)
            for turn in range(4):
                brush = EditTerrainRequest(layer="sand", shape="circle", merge="add", radius=9, value=0.02 + 2 * turn)
                brush.center.x, brush.center.y = 40 + 20 * turn, 20
                self.assertTrue(call("edit_terrain", EditTerrain, brush).success)
                step = call("step", Step, steps=3).step
                last = updates.wait_for(lambda u: u.step == step, "an update of the step")  # noqa: B023
            self.assertEqual(last.keyframe, base.keyframe, "steps send no keyframe to those who take updates")
            mine = [u for u in updates.messages if u.keyframe == base.keyframe]
            self.assertEqual([u.sequence for u in mine], list(range(1, len(mine) + 1)))
            for update in mine:
                write(update, held)
            tiles = [tile for update in mine for tile in update.tiles]
            self.assertTrue(any(tile.changes for tile in tiles) and any(tile.data for tile in tiles), "both ways are used")
            request_keyframe()
            now = keyframes.wait_for(lambda k: k.keyframe > base.keyframe, "a keyframe, because it was asked for")
        self.assertEqual(now.step, step)
        self.assertLessEqual(abs(cells_of(now).astype(float) - held).max(), THRESHOLD + 1e-6)
        self.assertGreater(abs(cells_of(now).astype(float) - cells_of(base)).max(), 1, "much has changed")


if __name__ == "__main__":
    rospy.init_node("updates", disable_signals=True)
    rostest.rosrun("desert_sim", "updates", Updates)
