#!/usr/bin/env python3
"""Keyframes and updates as the node sends them, put together by desert_sim.layer_assembler without a client."""
import desert_sim
import rospy
import rostest
from desert_sim.layer_assembler import NONE, LayerAssembler
from desert_sim.layer_messages import map_of
from desert_sim.msg import ElevationGrid, ElevationUpdate, LayerGrid, LayerUpdate
from desert_sim.testing import PATIENCE, wait_until
from map_client import Listener, MapTest, wait_until_known
from std_msgs.msg import Empty, String

THRESHOLD = 0.01


class Updates(MapTest):
    def test_those_of_the_elevation_add_up(self):
        asks = rospy.Publisher("/desert_sim/request_keyframe", Empty, queue_size=1)
        self.expect_same("elevation", ElevationGrid, ElevationUpdate, asks, Empty())

    def test_those_of_a_layer_add_up(self):
        asks = rospy.Publisher("/desert_sim/layers/request_keyframe", String, queue_size=1)
        self.expect_same("layers/sand_depth", LayerGrid, LayerUpdate, asks, String("sand_depth"))

    def expect_same(self, topic, grid, update_type, asks, request):
        desert = desert_sim.Simulation(timeout=60 * PATIENCE)

        def heap(x, y, height):
            desert.edit("sand", "circle", "add", height, center=(x, y), radius=9)
            return desert.step(3).step

        wait_until(asks.get_num_connections, "the node listens to requests")
        with Listener("/desert_sim/" + topic, grid) as keyframes, \
                Listener("/desert_sim/" + topic + "_updates", update_type) as updates:
            keyframes.first()
            wait_until_known(keyframes, updates, lambda: heap(100, 50, 1), lambda: desert.status().publications)
            number = updates.messages[-1].keyframe
            base = keyframes.wait_for(lambda k: k.keyframe == number, "the keyframe that updates build on")
            for turn in range(4):
                step = heap(40 + 20 * turn, 20, 0.02 + 2 * turn)
                last = updates.wait_for(lambda u: u.step == step, "an update of the step")  # noqa: B023
            self.assertEqual(last.keyframe, base.keyframe, "steps send no keyframe to those who take updates")
            mine = [u for u in updates.messages if u.keyframe == base.keyframe]
            self.assertEqual([u.sequence for u in mine], list(range(1, len(mine) + 1)))
            assembler = LayerAssembler()
            assembler.take_keyframe(base)
            for update in mine:
                assembler.take_update(update)
            self.assertEqual((assembler.need(), assembler.counts.updates), (NONE, len(mine)))
            tiles = [tile for update in mine for tile in update.tiles]
            self.assertTrue(any(tile.changes for tile in tiles) and any(tile.data for tile in tiles), "both ways are used")
            asks.publish(request)
            now = map_of(keyframes.wait_for(lambda k: k.keyframe > base.keyframe, "a keyframe, because it was asked for"))
        self.assertEqual(now.step, step)
        self.assertLessEqual(abs(now.values.astype(float) - assembler.map.values).max(), THRESHOLD + 1e-6)
        self.assertGreater(abs(now.values.astype(float) - map_of(base).values).max(), 1, "much has changed")


if __name__ == "__main__":
    rospy.init_node("updates", disable_signals=True)
    rostest.rosrun("desert_sim", "updates", Updates)
