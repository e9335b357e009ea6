#pragma once
/// When to ask for a keyframe: at once after a loss, then with pauses that double while asking does not help
/// for long, so that a stream that is faster than its reader does not make the reader ask all the time.

#include <chrono>

#include "src/client/elevation_assembler.hpp"

namespace desert_sim {

class KeyframeRequests {
 public:
  using Clock = std::chrono::steady_clock;

  /// Pauses between requests, 0 < shortest <= longest. An expected keyframe may take twice the present pause.
  KeyframeRequests(Clock::duration shortest, Clock::duration longest)
      : shortest_(shortest), longest_(longest), pause_(shortest) {}

  /// Whether to ask now, in which case it counts as asked.
  bool due(KeyframeNeed need, Clock::time_point now);
  /// The pause between the last request and the next.
  Clock::duration pause() const { return pause_; }

 private:
  Clock::duration shortest_, longest_, pause_;
  Clock::time_point asked_{}, since_{};  ///< since when the need has been what it is
  bool calm_ = true;                     ///< no request yet, or all has been well for long since the last
  KeyframeNeed need_ = KeyframeNeed::none;
};

}  // namespace desert_sim
