#include "src/client/keyframe_requests.hpp"

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
  if (need == KeyframeNeed::expected && now - since_ < 2 * pause_)
    return false;  // the transfer of a large keyframe takes time
  if (!stable_ && now - last_request_ < pause_) return false;
  pause_ = stable_ ? shortest_ : std::min(2 * pause_, longest_);
  stable_ = false;
  last_request_ = now;
  return true;
}

}  // namespace desert_sim
