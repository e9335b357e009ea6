#pragma once
/// Decides when to subscribe anew to a topic without a publisher. roscpp asks each publisher that the master
/// names for a connection once; if that request fails (a node that is just starting or is overloaded), it
/// never asks again, and the topic stays silent.

#include <algorithm>
#include <chrono>
#include <optional>

namespace desert_sim {

class Reconnection {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr Clock::duration shortest_pause = std::chrono::seconds(5);
  static constexpr Clock::duration longest_pause = std::chrono::minutes(1);

  /// Whether to subscribe anew now: after a pause without a publisher, which doubles with each time that
  /// this did not help, so that a connection that takes long is not broken off for ever.
  bool due(bool connected, Clock::time_point now) {
    if (connected) {
      *this = Reconnection();
      since_ = now;
      return false;
    }
    if (!since_) since_ = now;
    if (now - *since_ < pause_) return false;
    since_ = now;
    pause_ = std::min<Clock::duration>(2 * pause_, longest_pause);
    return true;
  }

 private:
  Clock::duration pause_ = shortest_pause;
  std::optional<Clock::time_point> since_;  ///< last time of a connection or an attempt
};

}  // namespace desert_sim
