/// When a client asks for a keyframe.
#include "include/desert_sim/client/keyframe_requests.hpp"

#include <gtest/gtest.h>

namespace {

using desert_sim::KeyframeNeed;
using desert_sim::KeyframeRequests;
using Clock = KeyframeRequests::Clock;
using std::chrono::milliseconds;

class Requests : public testing::Test {
 protected:
  /// Requests in so many milliseconds of this need, looked at every 10 ms.
  int in(int length, KeyframeNeed need) {
    int n = 0;
    for (const Clock::time_point end = now_ + milliseconds(length); now_ < end; now_ += milliseconds(10))
      n += requests_.due(need, now_);
    return n;
  }
  KeyframeRequests requests_{milliseconds(500), milliseconds(4000)};
  Clock::time_point now_{std::chrono::hours(1)};
};

TEST_F(Requests, NoneWithoutNeed) { EXPECT_EQ(in(20000, KeyframeNeed::none), 0); }

TEST_F(Requests, ALossIsAskedForAtOnce) {
  in(1000, KeyframeNeed::none);
  EXPECT_TRUE(requests_.due(KeyframeNeed::lost, now_));
  EXPECT_FALSE(requests_.due(KeyframeNeed::lost, now_ + milliseconds(1)));
}

TEST_F(Requests, AKeyframeOnItsWayHasTimeToCome) {
  EXPECT_EQ(in(990, KeyframeNeed::expected), 0);
  EXPECT_EQ(in(100, KeyframeNeed::expected), 1);
}

TEST_F(Requests, LeaveAKeyframeOnItsWayTimeAfterARestart) {
  in(1000, KeyframeNeed::none);
  EXPECT_EQ(in(990, KeyframeNeed::restarted), 0) << "a new subscription would lose it";
  EXPECT_EQ(in(100, KeyframeNeed::restarted), 1);
}

TEST_F(Requests, PausesDoubleUpToTheLongest) {
  EXPECT_EQ(in(490, KeyframeNeed::lost), 1);   // at 0
  EXPECT_EQ(in(500, KeyframeNeed::lost), 1);   // 0.5 s
  EXPECT_EQ(in(1000, KeyframeNeed::lost), 1);  // 1.5 s
  EXPECT_EQ(in(2000, KeyframeNeed::lost), 1);  // 3.5 s
  EXPECT_EQ(in(4000, KeyframeNeed::lost), 1);  // 7.5 s
  EXPECT_EQ(in(40000, KeyframeNeed::lost), 10);
}

TEST_F(Requests, AStreamThatBreaksAfterEachKeyframeIsAskedForLessAndLess) {
  int asked = 0;
  for (int n = 0; n < 600; ++n) asked += in(50, KeyframeNeed::none) + in(50, KeyframeNeed::lost);  // a minute
  EXPECT_GE(asked, 10);
  EXPECT_LE(asked, 20) << "every 4 s in the end";
}

TEST_F(Requests, AStreamThatHoldsGetsTheShortPauseBack) {
  in(20000, KeyframeNeed::lost);
  in(4100, KeyframeNeed::none);
  EXPECT_EQ(in(490, KeyframeNeed::lost), 1);
  EXPECT_EQ(in(500, KeyframeNeed::lost), 1);
}

}  // namespace
