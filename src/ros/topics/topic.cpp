#include "src/ros/topics/topic.hpp"

#include <algorithm>

namespace desert_sim {

SteadyClock::duration period_of(double rate) {
  return rate > 0 ? std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double>(1 / rate))
                  : SteadyClock::duration::zero();
}

void next_time(SteadyClock::time_point& due, SteadyClock::duration period) {
  const SteadyClock::time_point now = SteadyClock::now();
  due += period;
  if (due <= now) due = now + period;
}

void SubscriberNames::left(const std::string& name) {
  const auto found = count_.find(name);
  if (found != count_.end() && --found->second == 0) count_.erase(found);
}

bool SubscriberNames::are_among(const SubscriberNames& others) const {
  return std::all_of(count_.begin(), count_.end(),
                     [&](const auto& entry) { return others.count_.count(entry.first) > 0; });
}

void Topic::shown(std::uint64_t that_change, std::uint64_t that_terrain) {
  change = that_change;
  terrain = that_terrain;
  next_time(due, period_of(*rate));
}

void Topic::rate_changed() { due = std::min(due, SteadyClock::now() + period_of(*rate)); }

}  // namespace desert_sim
