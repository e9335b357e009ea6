#include "include/desert_sim/client/keyframe_requests.hpp"

#include <algorithm>

namespace desert_sim {

bool KeyframeRequests::due(KeyframeNeed need, Clock::time_point now) {
  if (need != need_) {
    need_ = need;
    since_ = now;
  }
  if (need == KeyframeNeed::none) {
    // The pause becomes short again only after the stream has been complete for longer than a pause.
    if (now - since_ > pause_) {
      stable_ = true;
      pause_ = shortest_;
    }
    return false;
  }
  // The transfer of a large keyframe takes time, and a new subscription would lose one that is on its way.
  if (need != KeyframeNeed::lost && now - since_ < 2 * pause_) return false;
  if (!stable_ && now - last_request_ < pause_) return false;
  pause_ = stable_ ? shortest_ : std::min(2 * pause_, longest_);
  stable_ = false;
  last_request_ = now;
  return true;
}

}  // namespace desert_sim
