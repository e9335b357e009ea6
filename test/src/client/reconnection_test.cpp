/// When a client subscribes anew to a topic without a publisher.
#include "include/desert_sim/client/reconnection.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace {

using desert_sim::Reconnection;
using std::chrono::seconds;

/// The seconds of a span, looked at every second, at which a connection was due.
std::vector<int> attempts(Reconnection& reconnection, int begin, int end, bool connected = false) {
  std::vector<int> due;
  for (int s = begin; s < end; ++s)
    if (reconnection.due(connected, Reconnection::Clock::time_point(seconds(s)))) due.push_back(s);
  return due;
}

TEST(Reconnection, IsDueAfterFiveSecondsAndThenLessAndLess) {
  Reconnection reconnection;
  EXPECT_EQ(attempts(reconnection, 0, 260), (std::vector<int>{5, 15, 35, 75, 135, 195, 255}));
}

TEST(Reconnection, BeginsAnewAfterAConnection) {
  Reconnection reconnection;
  EXPECT_EQ(attempts(reconnection, 0, 20), (std::vector<int>{5, 15}));
  EXPECT_TRUE(attempts(reconnection, 20, 100, true).empty());
  EXPECT_EQ(attempts(reconnection, 100, 120), (std::vector<int>{104, 114})) << "five seconds after second 99";
}

}  // namespace
