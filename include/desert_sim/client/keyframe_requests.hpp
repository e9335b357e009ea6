#pragma once
/// Decides when to request a keyframe: immediately after a loss, then with exponential backoff while requests
/// do not help for long. A reader that is too slow for its stream therefore does not request keyframes all
/// the time.

#include <chrono>

#include "desert_sim/client/layer_assembler.hpp"

namespace desert_sim {

class KeyframeRequests {
 public:
  using Clock = std::chrono::steady_clock;

  /// The shortest and longest pause between requests, 0 < shortest <= longest. An expected keyframe is
  /// requested only after twice the present pause.
  KeyframeRequests(Clock::duration shortest, Clock::duration longest)
      : shortest_(shortest), longest_(longest), pause_(shortest) {}

  /// Whether to send a request now; if so, it counts as sent.
  bool due(KeyframeNeed need, Clock::time_point now);

 private:
  Clock::duration shortest_, longest_, pause_;
  Clock::time_point last_request_{};  ///< time of the last request
  Clock::time_point since_{};         ///< time since which need_ has been the same
  bool stable_ = true;  ///< no request yet, or no need for longer than a pause since the last one
  KeyframeNeed need_ = KeyframeNeed::none;
};

}  // namespace desert_sim
