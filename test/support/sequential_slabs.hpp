#pragma once
/// Slab models as their papers have them: one poll after the other, each seeing all that happened before. An
/// independent program to compare slab_model.hpp with: heights in slabs on a periodic square, wind along x.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace desert_sim::test {

struct SequentialSlabs {
  int side = 0, mean = 0;  ///< mean height [slabs]
  int hop = 5;
  double slab = 1.0 / 3, stays_on_sand = 0.6, stays_on_rock = 0.4, repose = 0, shadow = 0;
  double linear = 0, square = 0;  ///< of the speed-up; none in werner
  bool shadow_protects = false;
  std::vector<int> height;  ///< [slabs]
  int highest = 0;          ///< not less than any
  std::mt19937 random;

  SequentialSlabs(int cells, int slabs, double repose_deg, unsigned seed)
      : side(cells),
        mean(slabs),
        repose(std::tan(repose_deg * 3.14159265358979 / 180)),
        shadow(std::tan(15 * 3.14159265358979 / 180)),
        height(static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells), slabs),
        highest(slabs),
        random(seed) {}

  int& at(int x, int y) {
    const auto wrapped = [this](int n) { return static_cast<std::size_t>((n % side + side) % side); };
    return height[wrapped(y) * static_cast<std::size_t>(side) + wrapped(x)];
  }
  double uniform() { return std::uniform_real_distribution<>(0, 1)(random); }

  bool in_shadow(int x, int y) {
    const double here = at(x, y) * slab, top = highest * slab;
    for (int d = 1; d * shadow < top - here; ++d)
      if (at(x - d, y) * slab - here > d * shadow) return true;
    return false;
  }
  /// Follows the steepest of slopes steeper than repose; `sign` 1 is downhill, −1 uphill.
  void roll(int& x, int& y, int sign) {
    for (;;) {
      const int order[4][2] = {{sign, 0}, {0, 1}, {0, -1}, {-sign, 0}};
      double steepest = repose;
      int to_x = x, to_y = y;
      for (const auto& n : order) {
        const double slope = sign * (at(x, y) - at(x + n[0], y + n[1])) * slab;
        if (slope <= steepest) continue;
        steepest = slope;
        to_x = x + n[0];
        to_y = y + n[1];
      }
      if (to_x == x && to_y == y) return;
      x = to_x;
      y = to_y;
    }
  }
  void poll() {
    int x = static_cast<int>(uniform() * side), y = static_cast<int>(uniform() * side);
    if (at(x, y) == 0 || (shadow_protects && in_shadow(x, y))) return;
    int from_x = x, from_y = y;
    roll(from_x, from_y, -1);
    --at(from_x, from_y);
    for (;;) {
      const double above = at(x, y) - mean;
      const double length = hop + (linear > 0 ? linear * above + square * above * std::max(above, 0.0) : 0);
      x += std::max(1, static_cast<int>(length + uniform()));
      x %= side;
      if (in_shadow(x, y) || uniform() < (at(x, y) > 0 ? stays_on_sand : stays_on_rock)) break;
    }
    roll(x, y, 1);
    highest = std::max(highest, ++at(x, y));
  }
  void run(int steps) {
    for (int n = 0; n < steps; ++n) {
      for (int k = 0; k < side * side; ++k) poll();
      highest = *std::max_element(height.begin(), height.end());
    }
  }
};

/// With the numbers of Werner 1995.
inline SequentialSlabs sequential_werner(int cells, int slabs, unsigned seed) {
  return {cells, slabs, 30, seed};
}
/// With those of Momiji et al. 2000.
inline SequentialSlabs sequential_momiji(int cells, int slabs, unsigned seed) {
  SequentialSlabs s(cells, slabs, 33.7, seed);
  s.shadow_protects = true;
  s.linear = 0.4;
  s.square = 0.002;
  return s;
}

}  // namespace desert_sim::test
