#include "src/simulation/forecast/passability.hpp"

#include <limits>

namespace desert_sim {

namespace {
constexpr float never = std::numeric_limits<float>::infinity();
}  // namespace

Passability::Passability(const std::vector<std::int8_t>& costs) : until_(costs.size()), from_(costs.size()) {
  for (std::size_t i = 0; i < costs.size(); ++i) {
    const bool passable = is_passable(costs[i]);
    until_[i] = passable ? never : 0;
    from_[i] = passable ? 0 : never;
  }
}

void Passability::add(double time, const std::vector<std::int8_t>& costs) {
  const auto now = static_cast<float>(time);
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (!is_passable(costs[i])) {
      if (until_[i] == never) until_[i] = last_time_;
      from_[i] = never;
    } else if (from_[i] == never) {
      from_[i] = now;
    }
  }
  last_time_ = now;
}

}  // namespace desert_sim
