#include "src/client/keyframe_requests.hpp"

#include <algorithm>

namespace desert_sim {

bool KeyframeRequests::due(KeyframeNeed need, Clock::time_point now) {
  if (need != need_) {
    need_ = need;
    since_ = now;
  }
  if (need == KeyframeNeed::none) {
    // A stream that breaks again soon after each keyframe does not get the short pause back.
    if (now - since_ > pause_) {
      calm_ = true;
      pause_ = shortest_;
    }
    return false;
  }
  if (need == KeyframeNeed::expected && now - since_ < 2 * pause_)
    return false;  // a large one takes its time
  if (!calm_ && now - asked_ < pause_) return false;
  pause_ = calm_ ? shortest_ : std::min(2 * pause_, longest_);
  calm_ = false;
  asked_ = now;
  return true;
}

}  // namespace desert_sim
