// Which blocks are built anew, in which order, and how long that takes in a frame.

#include "src/render/rebuild_queue.hpp"

#include <gtest/gtest.h>

#include <set>

#include "test/src/render/fields.hpp"

namespace {

using namespace render_test;

/// A queue on a grid of 512 × 512 cells, all of whose blocks are built at a level; each block takes `cost`
/// seconds of the clock.
struct Queue {
  BlockLayout layout{512, 512};
  std::vector<Box> boxes = flat_boxes(layout, 1);
  View view{orthographic(2000), camera_at(256, 256, 100, -90), 800};
  RebuildQueue queue;
  double now = 0, cost = 0.001;
  std::vector<int> built;

  explicit Queue(int level = 0) {
    queue.reset(layout);
    queue.set_levels(std::vector<int>(boxes.size(), level));
  }
  int run(double seconds) {
    built.clear();
    queue.begin_batch(view, boxes);
    return queue.run(
        seconds,
        [this](int block, int) {
          built.push_back(block);
          now += cost;
        },
        [this] { return now; });
  }
  void build_all() {
    while (queue.waiting() > 0) run(1);
  }
};

TEST(RebuildQueue, StopsWithinItsTime) {
  Queue q;
  const double before = q.now;
  EXPECT_EQ(q.run(0.0105), 10);
  EXPECT_LE(q.now - before, 0.0105);
  EXPECT_EQ(q.queue.waiting(), 64 - 10);
  q.cost = 0.05;
  EXPECT_EQ(q.run(0.0105), 1) << "one block in each frame, however long it takes";
}

TEST(RebuildQueue, BuildsTheNearFirst) {
  Queue q;
  q.view = View(perspective(), camera_at(10, 10, 2000, -90), 800);
  q.run(1);
  EXPECT_EQ(q.built.front(), 0);
  EXPECT_EQ(q.built.back(), 63);
}

TEST(RebuildQueue, BuildsWhatIsSeenFirst) {
  Queue q;
  q.view = View(orthographic(100), camera_at(400, 400, 10, -90), 800);
  q.run(1);
  EXPECT_EQ(q.built.front(), 6 * 8 + 6);
  EXPECT_EQ(q.built.size(), 64u) << "and the rest in the time that is left";
}

TEST(RebuildQueue, ABatchIsCompleteWhenAllThatIsSeenIsBuilt) {
  Queue q;
  q.build_all();
  q.queue.touch({0, 0, 200, 200});  // blocks 0 … 3 in both directions
  EXPECT_TRUE(q.queue.batch_complete());
  q.run(0.0105);
  EXPECT_FALSE(q.queue.batch_complete());
  q.queue.touch({0, 0, 20, 20});  // what changes meanwhile belongs to the next batch
  q.run(0.0105);
  EXPECT_TRUE(q.queue.batch_complete());
  EXPECT_EQ(q.built.size(), 6u);
  EXPECT_EQ(q.queue.waiting(), 1);
  q.run(1);
  EXPECT_EQ(q.built, std::vector<int>{0});
  EXPECT_EQ(q.queue.waiting(), 0);
}

TEST(RebuildQueue, WhatIsOutOfSightDoesNotDelayABatch) {
  Queue q;
  q.build_all();
  q.view = View(orthographic(100), camera_at(400, 400, 10, -90), 800);
  q.queue.touch_all();
  q.run(0.0095);
  EXPECT_TRUE(q.queue.batch_complete()) << "the picture has nine blocks at most";
  EXPECT_EQ(q.queue.waiting(), 64 - 9);
}

// Complaint 5: the whole map is sent to the graphics card again for a small change.
TEST(Complaint5, OnlyTouchedBlocksAreBuiltAnew) {
  Queue q;
  q.build_all();
  EXPECT_EQ(q.queue.waiting(), 0);
  q.queue.touch({100, 100, 20, 20});  // in the middle of block (1, 1)
  q.run(1);
  EXPECT_EQ(q.built, std::vector<int>{9});
  q.queue.touch({128, 100, 1, 1});  // the common edge of blocks (1, 1) and (2, 1)
  q.run(1);
  EXPECT_EQ(std::set<int>(q.built.begin(), q.built.end()), (std::set<int>{9, 10}));
  q.queue.touch({128, 128, 64, 64});  // one tile of an update
  q.run(1);
  EXPECT_LE(q.built.size(), 9u);
  q.queue.touch({600, 600, 10, 10});
  q.queue.touch({5, 5, 0, 0});
  EXPECT_EQ(q.queue.waiting(), 0) << "nothing of the grid";
}

TEST(Complaint5, NormalsOfNeighboursAreRebuiltAsFarAsTheirLevelReaches) {
  Queue q(3);
  q.build_all();
  q.queue.touch({67, 100, 1, 1});  // three cells east of the edge of block (0, 1), whose normals reach eight
  q.run(1);
  EXPECT_EQ(std::set<int>(q.built.begin(), q.built.end()), (std::set<int>{8, 9}));
}

TEST(RebuildQueue, AnotherLevelLetsABlockWait) {
  Queue q;
  q.build_all();
  std::vector<int> levels(64, 0);
  levels[17] = 2;
  q.queue.set_levels(levels);
  q.run(1);
  EXPECT_EQ(q.built, std::vector<int>{17});
  EXPECT_EQ(q.queue.levels()[17], 2);
}

// Complaint 8: no throttle when changes come faster than frames.
TEST(Complaint8, ABlockThatChangesManyTimesInAFrameIsBuiltOnce) {
  Queue q;
  q.build_all();
  for (int n = 0; n < 1000; ++n) q.queue.touch({100, 100, 20, 20});
  EXPECT_EQ(q.queue.waiting(), 1);
  EXPECT_EQ(q.run(1), 1);
}

TEST(Complaint8, FarBlocksAreServedAlthoughNearOnesChangeInEachFrame) {
  Queue q;
  q.view = View(perspective(), camera_at(10, 10, 2000, -90), 800);
  q.build_all();
  std::set<int> served;
  q.queue.touch_all();
  for (int frame = 0; frame < 100 && served.size() < 64; ++frame) {
    q.queue.touch({0, 0, 300, 300});
    q.run(0.004);
    served.insert(q.built.begin(), q.built.end());
  }
  EXPECT_EQ(served.size(), 64u);
}

TEST(BlockLayout, CoversEachCellAndGridsOfAnySize) {
  for (const auto& [width, height] :
       {std::pair(2, 2), std::pair(64, 64), std::pair(65, 66), std::pair(513, 70), std::pair(2048, 2048)}) {
    const BlockLayout layout(width, height);
    std::int64_t quads = 0;
    for (int block = 0; block < layout.count(); ++block) {
      const CellRectangle r = layout.vertices(block);
      EXPECT_GE(r.width, 2);
      EXPECT_GE(r.height, 2);
      quads += static_cast<std::int64_t>(r.width - 1) * (r.height - 1);
    }
    EXPECT_EQ(quads, static_cast<std::int64_t>(width - 1) * (height - 1)) << width << " x " << height;
  }
  for (const auto& [width, height] : {std::pair(0, 0), std::pair(1, 100), std::pair(100, 1)})
    EXPECT_EQ(BlockLayout(width, height).count(), 0);
}

}  // namespace
