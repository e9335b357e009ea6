// What a client says of topics that do not come, and when.

#include "include/desert_sim/client/waiting_notice.hpp"

#include <gtest/gtest.h>

namespace {

using namespace desert_sim;
using std::chrono::milliseconds;

TEST(WaitingNotice, NamesTheTopicAndWhatHasItsNameElsewhere) {
  EXPECT_EQ(waiting_text({{"/desert_sim/elevation", false}},
                         {"/mars/desert_sim/elevation", "/mars/desert_sim/elevation_updates"}),
            "The terrain client waits. Nobody publishes /desert_sim/elevation (somebody does "
            "/mars/desert_sim/elevation).");
  EXPECT_EQ(waiting_text({{"/a/elevation", false}, {"/a/layers/sand_depth", true}}, {}),
            "The terrain client waits. Nobody publishes /a/elevation. Nothing has come yet of "
            "/a/layers/sand_depth.");
  EXPECT_EQ(waiting_text({{"/a/elevation", false}}, {"/a/elevation", "/b/elevation"}),
            "The terrain client waits. Nothing has come yet of /a/elevation.")
      << "it is not connected yet";
}

TEST(WaitingNotice, IsDueAfterThreeSecondsAndEveryHalfMinute) {
  WaitingNotice notice;
  const WaitingNotice::Clock::time_point start{};
  EXPECT_FALSE(notice.due(true, start));
  EXPECT_FALSE(notice.due(true, start + milliseconds(2999)));
  EXPECT_TRUE(notice.due(true, start + milliseconds(3000)));
  EXPECT_FALSE(notice.due(true, start + milliseconds(32999)));
  EXPECT_TRUE(notice.due(true, start + milliseconds(33000)));
  EXPECT_FALSE(notice.due(false, start + milliseconds(99000)));
  EXPECT_FALSE(notice.due(true, start + milliseconds(99100))) << "it begins anew";
  EXPECT_TRUE(notice.due(true, start + milliseconds(102100)));
}

}  // namespace
