/// What a client makes of a stream of keyframes and updates that is whole, reordered, torn or broken.
#include <gtest/gtest.h>

#include <limits>

#include "include/desert_sim/client/layer_assembler.hpp"
#include "test/support/messages.hpp"

namespace {

using namespace client_test;
using desert_sim::KeyframeNeed;
using desert_sim::MapChange;

constexpr float infinity = std::numeric_limits<float>::infinity();

class Assembler : public testing::Test {
 protected:
  MapChange take(const ElevationGrid& keyframe) {
    return assembler_.process(boost::make_shared<ElevationGrid>(keyframe));
  }
  float corner() const { return assembler_.map()->at(0, 0); }
  const desert_sim::StreamCounts& counts() const { return assembler_.counts(); }
  bool whole() const { return assembler_.need() == KeyframeNeed::none; }
  void expect_gap(const std::string& why, KeyframeNeed need = KeyframeNeed::lost) const {
    EXPECT_EQ(assembler_.need(), need);
    EXPECT_EQ(counts().gaps, 1u);
    EXPECT_NE(counts().last_gap.find(why), std::string::npos)
        << "'" << why << "' not in: " << counts().last_gap;
  }
  desert_sim::ElevationAssembler assembler_;
};

// ---- a whole stream ----

TEST_F(Assembler, BeginsWithNothingAndExpectsAKeyframe) {
  EXPECT_EQ(assembler_.map(), nullptr);
  EXPECT_EQ(assembler_.need(), KeyframeNeed::expected);
}

TEST_F(Assembler, WritesUpdatesOverTheKeyframe) {
  const MapChange first = take(keyframe(4, 10));
  EXPECT_TRUE(first.replaced);
  EXPECT_EQ(first.cells.width * first.cells.height, 130u * 70u);
  const MapChange second = assembler_.process(update(4, 1, 11, 5));
  EXPECT_FALSE(second.replaced);
  EXPECT_EQ(second.map, assembler_.map());
  EXPECT_EQ(second.cells.width, 2u);
  EXPECT_EQ(second.cells.height, 3u);
  assembler_.process(update(4, 2, 12, 6));
  EXPECT_EQ(corner(), 6);
  EXPECT_EQ(assembler_.map()->info().step, 12u);
  EXPECT_TRUE(whole());
  EXPECT_EQ(counts().keyframes, 1u);
  EXPECT_EQ(counts().updates, 2u);
  EXPECT_EQ(counts().gaps + counts().late + counts().unusable + counts().refused, 0u);
}

TEST_F(Assembler, AnUpdateWithoutTilesMovesTimeOnly) {
  take(keyframe(1, 1, 130, 70, 3));
  const auto nothing = update(1, 1, 9);
  nothing->tiles.clear();
  const MapChange change = assembler_.process(nothing);
  EXPECT_TRUE(change.cells.empty());
  EXPECT_EQ(assembler_.map()->info().step, 9u);
  EXPECT_EQ(corner(), 3);
}

TEST_F(Assembler, AKeyframeThatConfirmsChangesNoCell) {
  take(keyframe(1, 1));
  const MapChange change = take(keyframe(2, 5));
  EXPECT_TRUE(change.cells.empty());
  EXPECT_FALSE(change.replaced);
  EXPECT_EQ(assembler_.map()->info().step, 5u);
  const MapChange another_size = take(keyframe(3, 6, 20, 33));
  EXPECT_TRUE(another_size.replaced);
}

// ---- reordered between the two connections ----

TEST_F(Assembler, UpdatesWaitForTheirKeyframe) {
  assembler_.process(update(1, 1, 2, 8));
  assembler_.process(update(1, 2, 3, 9));
  EXPECT_EQ(assembler_.map(), nullptr);
  const MapChange change = take(keyframe(1, 1));
  EXPECT_EQ(change.map->info().sequence, 2u);
  EXPECT_EQ(corner(), 9);
  EXPECT_TRUE(whole());
}

TEST_F(Assembler, UpdatesThatOvertakeALaterKeyframeAreNoGap) {
  take(keyframe(1, 1));
  assembler_.process(update(2, 1, 3, 7));
  EXPECT_EQ(assembler_.need(), KeyframeNeed::expected);
  EXPECT_EQ(corner(), 0);
  const MapChange change = take(keyframe(2, 2));
  EXPECT_EQ(corner(), 7);
  EXPECT_EQ(change.cells.width, 2u) << "the keyframe differs in no cell, the update in some";
  EXPECT_TRUE(whole());
  EXPECT_EQ(counts().gaps, 0u);
}

TEST_F(Assembler, TheLastUpdateOfTheOldKeyframeMayComeLate) {
  take(keyframe(1, 1));
  take(keyframe(2, 3, 130, 70, 4));
  assembler_.process(update(1, 1, 3, 8));
  EXPECT_EQ(corner(), 4);
  EXPECT_TRUE(whole());
  EXPECT_EQ(counts().late, 1u);
}

TEST_F(Assembler, ALatchedKeyframeThatIsSentAgainDoesNotTurnTimeBack) {
  take(keyframe(1, 1));
  assembler_.process(update(1, 1, 2, 8));
  take(keyframe(1, 1));
  EXPECT_EQ(corner(), 8);
  EXPECT_EQ(counts().restarts, 0u);
  assembler_.process(update(1, 2, 3, 9));
  EXPECT_EQ(corner(), 9);
}

// ---- torn ----

TEST_F(Assembler, AMissingUpdateIsAGapUntilTheNextKeyframe) {
  take(keyframe(1, 1));
  assembler_.process(update(1, 1, 2, 5));
  assembler_.process(update(1, 3, 4, 7));
  expect_gap("update 2 of keyframe 1 is missing: update 3 arrived instead");
  assembler_.process(update(1, 4, 5, 8));
  EXPECT_EQ(corner(), 5) << "the last good map";
  EXPECT_EQ(counts().unusable, 2u);
  assembler_.process(update(2, 1, 7, 9));
  take(keyframe(2, 6, 130, 70, 8));
  EXPECT_EQ(corner(), 9);
  EXPECT_TRUE(whole());
  EXPECT_EQ(counts().gaps, 1u);
}

TEST_F(Assembler, AFirstUpdateThatIsMissingIsAGapToo) {
  assembler_.process(update(1, 2, 3));
  take(keyframe(1, 1));
  expect_gap("update 1 of keyframe 1 is missing");
}

TEST_F(Assembler, AKeyframeThatDoesNotComeIsAGapOnceItIsOverdue) {
  take(keyframe(1, 1));
  assembler_.keyframe_overdue();
  EXPECT_TRUE(whole()) << "none was expected";
  assembler_.process(update(2, 1, 3));
  assembler_.keyframe_overdue();
  expect_gap("keyframe 2");
  take(keyframe(3, 4));
  EXPECT_TRUE(whole());
}

TEST_F(Assembler, ARestartIsNoticedByUpdatesAndHealedByTheKeyframe) {
  take(keyframe(7, 100));
  assembler_.process(update(7, 1, 101, 5));
  assembler_.process(update(1, 1, 201, 2));  // the node has been started anew
  expect_gap("has restarted", KeyframeNeed::restarted);
  EXPECT_EQ(corner(), 5);
  take(keyframe(1, 200));
  EXPECT_EQ(corner(), 2);
  EXPECT_TRUE(whole());
  EXPECT_EQ(counts().restarts, 1u);
}

TEST_F(Assembler, ARestartWithTheSameNumbersIsNoticed) {
  take(keyframe(1, 100));
  for (std::uint32_t n = 1; n < 9; ++n) assembler_.process(update(1, n, 100 + n, 5));
  assembler_.process(update(1, 3, 203, 6));
  expect_gap("update 3 of keyframe 1 arrived after update 8");
  take(keyframe(1, 202, 130, 70, 4));
  EXPECT_EQ(assembler_.need(), KeyframeNeed::lost) << "updates 1 and 2 were never here";
  EXPECT_EQ(counts().gaps, 2u);
  EXPECT_EQ(corner(), 4);
}

TEST_F(Assembler, AnotherRunWhoseNumbersHappenToFollowIsNoticed) {
  take(keyframe(1, 100));
  assembler_.process(update(1, 1, 101, 5));
  auto fresh = update(1, 2, 3, 6);
  fresh->header.stamp = ros::Time(200, 0);
  assembler_.process(fresh);
  expect_gap("has restarted");
  EXPECT_EQ(corner(), 5);
}

// ---- a recording that is played again: the same numbers and stamps from their beginning ----

class Played : public Assembler {
 protected:
  void play_keyframe(std::uint32_t number, std::uint32_t step) {
    take(keyframe(number, step, 130, 70, static_cast<float>(step)));
  }
  void play_updates(std::uint32_t number, std::uint32_t step, std::uint32_t count) {
    for (std::uint32_t n = 1; n <= count; ++n)
      assembler_.process(update(number, n, step + n, static_cast<float>(step + n)));
  }
  void expect_at(std::uint32_t step) const {
    EXPECT_EQ(assembler_.map()->info().step, step);
    EXPECT_EQ(corner(), step);
    EXPECT_TRUE(whole());
  }
};

TEST_F(Played, OfOneKeyframe) {
  for (int turn = 0; turn < 3; ++turn) {
    play_keyframe(1, 10);
    play_updates(1, 10, 4);
    expect_at(14);
    EXPECT_EQ(assembler_.map()->at(5, 5), 10);
  }
  EXPECT_EQ(counts().updates, 12u);
  EXPECT_EQ(counts().restarts, 2u);
  EXPECT_EQ(counts().gaps, 0u);
}

TEST_F(Played, OfOneKeyframeWhoseFirstUpdateOvertakesIt) {
  play_keyframe(1, 10);
  play_updates(1, 10, 4);
  play_updates(1, 10, 2);
  expect_gap("has restarted", KeyframeNeed::restarted);
  EXPECT_EQ(corner(), 14) << "the last good map stays";
  play_keyframe(1, 10);
  expect_at(12);
}

TEST_F(Played, OfSeveralKeyframes) {
  for (int turn = 0; turn < 3; ++turn)
    for (std::uint32_t number = 3; number < 6; ++number) {
      play_keyframe(number, 10 * number);
      play_updates(number, 10 * number, 4);
      expect_at(10 * number + 4);
    }
  EXPECT_EQ(counts().gaps, 0u);
  EXPECT_EQ(counts().restarts, 2u);
}

TEST_F(Played, OfSeveralKeyframesInAnyOrderOfTheTwoConnections) {
  play_keyframe(1, 10);
  play_updates(1, 10, 2);
  play_keyframe(2, 20);
  play_updates(2, 20, 2);
  play_updates(1, 10, 1);  // before its keyframe
  EXPECT_EQ(assembler_.need(), KeyframeNeed::restarted);
  play_keyframe(1, 10);
  expect_at(11);
  play_keyframe(2, 20);
  play_keyframe(1, 10);  // before the last update of the turn before
  play_updates(2, 20, 1);
  play_updates(1, 10, 2);
  expect_at(12);
  EXPECT_EQ(counts().gaps, 1u);
}

TEST_F(Played, InALoopByWhoJoinedLate) {
  for (const std::uint32_t joined : {1u, 3u, 8u}) {  // before which update of the second keyframe
    assembler_ = desert_sim::ElevationAssembler();
    for (std::uint32_t n = joined; n <= 9; ++n)
      assembler_.process(update(2, n, 20 + n, static_cast<float>(20 + n)));
    for (int turn = 0; turn < 3; ++turn) {
      play_keyframe(1, 10);
      play_keyframe(2, 20);
      for (std::uint32_t n = 1; n <= 9; ++n) {
        assembler_.process(update(2, n, 20 + n, static_cast<float>(20 + n)));
        expect_at(20 + n);
      }
    }
  }
}

TEST_F(Assembler, ARestartAfterUpdatesThatWaitedIsNoRecording) {
  assembler_.process(update(1, 1, 11, 5));
  take(keyframe(1, 10, 130, 70, 4));
  assembler_.process(update(1, 1, 101, 6));
  expect_gap("has restarted", KeyframeNeed::restarted);
  EXPECT_EQ(corner(), 5);
}

TEST_F(Assembler, AStepBackOfTheScenarioIsNotARestart) {
  take(keyframe(1, 100));
  ElevationGrid reset = keyframe(2, 101);
  reset.step = 0;
  take(reset);
  EXPECT_EQ(assembler_.map()->info().step, 0u);
  EXPECT_EQ(counts().restarts, 0u);
  EXPECT_TRUE(whole());
}

TEST_F(Assembler, KeepsNoMoreWaitingUpdatesThanItShould) {
  for (std::uint32_t n = 1; n <= 1000; ++n) assembler_.process(update(1, n, n + 1));
  EXPECT_EQ(counts().unusable, 1000u - 256u);
  auto large = [](std::uint32_t n) {
    const auto u = update(2, n, 2000 + n);
    u->tiles = {tile(0, 0, 2048, 2048, 1)};
    return u;
  };
  for (std::uint32_t n = 1; n <= 6; ++n) assembler_.process(large(n));
  EXPECT_EQ(counts().unusable, 1002u) << "four of 2048 x 2048 cells are kept";
}

// ---- broken ----

struct BadKeyframe {
  const char* names;
  void (*spoil)(ElevationGrid&);
};

TEST_F(Assembler, RefusesBadKeyframesAndSaysWhy) {
  const BadKeyframe bad[] = {
      {"9099 values for 130 x 70", [](ElevationGrid& k) { k.elevation.pop_back(); }},
      {"0 values for 0 x 70", [](ElevationGrid& k) { k.width = 0, k.elevation.clear(); }},
      {"4294967295", [](ElevationGrid& k) { k.width = k.height = 4294967295u; }},
      {"cell_size is 0", [](ElevationGrid& k) { k.cell_size = 0; }},
      {"cell_size is nan", [](ElevationGrid& k) { k.cell_size = std::numeric_limits<double>::quiet_NaN(); }},
      {"origin is (inf", [](ElevationGrid& k) { k.origin.position.x = infinity; }},
      {"cell_size is 1e+300: must be 0.001 to", [](ElevationGrid& k) { k.cell_size = 1e300; }},
      {"1e+300, 0): must be within", [](ElevationGrid& k) { k.origin.position.y = 1e300; }},
      {"value 40 is 3e+38: must be within", [](ElevationGrid& k) { k.elevation[40] = 3e38f; }},
      {"z = 0", [](ElevationGrid& k) { k.origin.position.z = 1; }},
      {"orientation", [](ElevationGrid& k) { k.origin.orientation.w = 0, k.origin.orientation.z = 1; }},
      {"sim_time", [](ElevationGrid& k) { k.sim_time = infinity; }},
      {"value 17 is -inf", [](ElevationGrid& k) { k.elevation[17] = -infinity; }},
  };
  std::uint64_t refused = 0;
  for (const BadKeyframe& b : bad) {
    ElevationGrid k = keyframe(1, 1);
    b.spoil(k);
    EXPECT_EQ(take(k).map, nullptr);
    EXPECT_EQ(counts().refused, ++refused) << b.names;
    EXPECT_NE(counts().last_refusal.find(b.names), std::string::npos) << counts().last_refusal;
    EXPECT_NE(counts().last_refusal.find("keyframe 1"), std::string::npos) << counts().last_refusal;
  }
  EXPECT_EQ(assembler_.map(), nullptr);
}

struct BadUpdate {
  const char* names;
  void (*spoil)(ElevationUpdate&);
};

TEST_F(Assembler, RefusesBadUpdatesWhollyAndNeedsAKeyframeThen) {
  const BadUpdate bad[] = {
      {"sequence", [](ElevationUpdate& u) { u.sequence = 0; }},
      {"sim_time", [](ElevationUpdate& u) { u.sim_time = infinity; }},
      {"tile 1: 5 values for 2 x 3", [](ElevationUpdate& u) { u.tiles[1].data.pop_back(); }},
      {"tile 1: 0 values for 2 x 0",
       [](ElevationUpdate& u) { u.tiles[1].height = 0, u.tiles[1].data.clear(); }},
      {"tile 1: value 2 is inf", [](ElevationUpdate& u) { u.tiles[1].data[2] = infinity; }},
      {"tile 1: value 0 is -3e+38", [](ElevationUpdate& u) { u.tiles[1].data[0] = -3e38f; }},
      {"tile 1: 1 values for 2 cells that changed",
       [](ElevationUpdate& u) { u.tiles[1].changed = {0b10000100}, u.tiles[1].data.resize(1); }},
      {"tile 1: 0 values for 0 cells that changed",
       [](ElevationUpdate& u) { u.tiles[1].changed = {0}, u.tiles[1].data.clear(); }},
      {"tile 1: 2 bytes of mask for 2 x 3",
       [](ElevationUpdate& u) {
         u.tiles[1].changed = {0xfc, 0};
       }},
      {"tile 1: bit 6 of its mask is set", [](ElevationUpdate& u) { u.tiles[1].changed = {0xfe}; }},
      {"tile 1: has changes and absolute values", [](ElevationUpdate& u) { u.tiles[1].changes.resize(6); }},
      {"tile 1: resolution is 0: must be above 0",
       [](ElevationUpdate& u) {
         u.tiles[1].data.clear(), u.tiles[1].changes.resize(6), u.tiles[1].bits = 8;
       }},
      {"tile 1: has changes of 0 bits",
       [](ElevationUpdate& u) { u.tiles[1].data.clear(), u.tiles[1].changes.resize(6); }},
      {"tile 1 reaches to cell (131, 3)", [](ElevationUpdate& u) { u.tiles[1].x = 129; }},
      {"tile 1 reaches to cell (2, 4294967298)", [](ElevationUpdate& u) { u.tiles[1].y = 4294967295u; }},
      {"frame is 'odom'", [](ElevationUpdate& u) { u.header.frame_id = "odom"; }},
  };
  std::uint32_t number = 0;
  for (const BadUpdate& b : bad) {
    ++number;
    take(keyframe(number, 10 * number));
    const auto u = update(number, 1, 10 * number + 1);
    u->tiles.push_back(u->tiles[0]);
    b.spoil(*u);
    EXPECT_EQ(assembler_.process(u).map, nullptr);
    EXPECT_EQ(counts().refused, number) << b.names;
    EXPECT_NE(counts().last_refusal.find(b.names), std::string::npos) << counts().last_refusal;
    EXPECT_EQ(corner(), 0) << "its first tile is sound, and must not be written";
    EXPECT_EQ(assembler_.need(), KeyframeNeed::lost);
  }
  EXPECT_EQ(counts().gaps, number);
}

TEST_F(Assembler, AnUpdateThatWaitedIsCheckedAgainstItsKeyframe) {
  assembler_.process(update(1, 1, 2));
  take(keyframe(1, 1, 1, 70));
  EXPECT_EQ(counts().refused, 1u);
  expect_gap("tile 0 reaches to cell (2, 3) of a grid of 1 x 70");
}

}  // namespace
