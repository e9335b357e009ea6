// What a client says of topics that do not come, and when.

#include "src/client/waiting_notice.hpp"

#include <gtest/gtest.h>

namespace {

using namespace desert_sim;
using std::chrono::milliseconds;

TEST(WaitingNotice, NamesTheTopicAndWhatHasItsNameElsewhere) {
  EXPECT_EQ(waiting_text({{"/desert_sim/elevation", false}},
                         {"/mars/desert_sim/elevation", "/mars/desert_sim/elevation_updates"}),
            "Waits for /desert_sim/elevation, which nobody publishes (but somebody does "
            "/mars/desert_sim/elevation)");
  EXPECT_EQ(waiting_text({{"/a/elevation", false}, {"/a/layers/sand_depth", true}}, {}),
            "Waits for /a/elevation, which nobody publishes, and for /a/layers/sand_depth, which has a "
            "publisher that has sent nothing yet");
  EXPECT_EQ(waiting_text({{"/a/elevation", true}}, {"/b/elevation"}),
            "Waits for /a/elevation, which has a publisher that has sent nothing yet");
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
