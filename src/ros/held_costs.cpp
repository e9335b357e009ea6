#include "desert_sim/ros/held_costs.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace desert_sim {

std::int8_t cost_of(float traversability) {
  if (std::isnan(traversability)) return unknown_cost;
  if (traversability <= 0) return lethal_cost;
  return static_cast<std::int8_t>(std::lround(99 * (1 - std::min(traversability, 1.0f))));
}

void HeldCosts::hold(int width, std::vector<std::int8_t> costs) {
  width_ = width;
  held_ = std::move(costs);
}

bool HeldCosts::differs(std::int8_t now, std::int8_t held) const {
  if (now == held) return false;
  const auto special = [](std::int8_t cost) { return cost == lethal_cost || cost == unknown_cost; };
  return special(now) || special(held) || std::abs(now - held) > threshold_;
}

CellBox HeldCosts::changes(const std::vector<std::int8_t>& now) const {
  CellBox all;
  for (std::size_t i = 0; i < held_.size(); ++i) {
    if (!differs(now[i], held_[i])) continue;
    const int x = static_cast<int>(i % static_cast<std::size_t>(width_)),
              y = static_cast<int>(i / static_cast<std::size_t>(width_));
    all = all.with({x, y, x + 1, y + 1});
  }
  return all;
}

std::vector<std::int8_t> HeldCosts::take(const std::vector<std::int8_t>& now, const CellBox& cells) {
  std::vector<std::int8_t> taken;
  taken.reserve(static_cast<std::size_t>(cells.width()) * static_cast<std::size_t>(cells.height()));
  for (int y = cells.y0; y < cells.y1; ++y) {
    const auto first = static_cast<std::ptrdiff_t>(y) * width_ + cells.x0;
    const auto begin = now.begin() + first, end = begin + cells.width();
    taken.insert(taken.end(), begin, end);
    std::copy(begin, end, held_.begin() + first);  // and no more: what is not sent is not held
  }
  return taken;
}

}  // namespace desert_sim
