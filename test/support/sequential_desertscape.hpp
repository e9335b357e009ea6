#pragma once
/// The stochastic model of Paris et al. 2019 one event after the other, each seeing all that happened before,
/// and its slides with it. An independent program to compare kernels/sand/desertscape.hpp with: sand in
/// metres on a periodic square of cells of a metre, over level rock, in a wind along x.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace desert_sim::test {

struct SequentialDesertscape {
  int side;
  double slab, creeping, hop, spread;  ///< [m]
  double repose = tangent(33), shadow_begins = tangent(10), shadow_is_full = tangent(15);
  int reach = 10;  ///< of the shadow [cells]
  std::vector<double> sand;
  std::mt19937 random;

  SequentialDesertscape(int cells, double depth, double slab_depth, double creep_depth, double hop_length,
                        double hop_spread, unsigned seed)
      : side(cells),
        slab(slab_depth),
        creeping(creep_depth),
        hop(hop_length),
        spread(hop_spread),
        sand(static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells), depth),
        random(seed) {}

  static double tangent(double degrees) { return std::tan(degrees * 3.14159265358979 / 180); }
  double& at(int x, int y) {
    const auto wrapped = [this](int n) { return static_cast<std::size_t>((n % side + side) % side); };
    return sand[wrapped(y) * static_cast<std::size_t>(side) + wrapped(x)];
  }
  double uniform() { return std::uniform_real_distribution<>(0, 1)(random); }
  double scatter() { return std::normal_distribution<>(0, spread)(random); }

  double shadow(int x, int y) {
    double steepest = 0;
    for (int d = 1; d <= reach; ++d) steepest = std::max(steepest, (at(x - d, y) - at(x, y)) / d);
    return std::clamp((steepest - shadow_begins) / (shadow_is_full - shadow_begins), 0.0, 1.0);
  }
  /// The neighbour to which the surface falls most steeply from (x, y), and the fall over the distance.
  struct Fall {
    int x, y;
    double slope;
  };
  /// The two steepest, in order; slope 0 where there is none.
  std::pair<Fall, Fall> falls(int x, int y) {
    Fall first{x, y, 0}, second{x, y, 0};
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx == 0 && dy == 0) continue;
        const Fall fall{x + dx, y + dy, (at(x, y) - at(x + dx, y + dy)) / std::hypot(dx, dy)};
        if (fall.slope > first.slope) {
          second = first;
          first = fall;
        } else if (fall.slope > second.slope) {
          second = fall;
        }
      }
    return {first, second};
  }
  void creep(int x, int y) {
    const auto [first, second] = falls(x, y);
    if (first.slope <= 0) return;
    const double moved = std::min({creeping, 0.5 * first.slope, at(x, y)});
    const double to_second = moved * second.slope / (first.slope + second.slope);
    at(x, y) -= moved;
    at(first.x, first.y) += moved - to_second;
    at(second.x, second.y) += to_second;
    for (const Fall& to : {first, second}) stabilise(to.x, to.y);
  }
  /// Sand that is too steep falls to all lower neighbours by their excess over repose (avalanching.hpp).
  bool slide(int x, int y) {
    double excess[9] = {}, sum = 0, largest = 0;
    for (int k = 0; k < 9; ++k) {
      const int dx = k % 3 - 1, dy = k / 3 - 1;
      const double fall = at(x, y) - at(x + dx, y + dy) - repose * std::hypot(dx, dy);
      excess[k] = k == 4 ? 0 : std::max(fall, 0.0);
      sum += excess[k];
      largest = std::max(largest, excess[k]);
    }
    if (largest < 1e-3 || at(x, y) <= 0) return false;
    const double moved = std::min(largest / (1 + largest / sum), at(x, y));
    at(x, y) -= moved;
    for (int k = 0; k < 9; ++k) at(x + k % 3 - 1, y + k / 3 - 1) += moved * excess[k] / sum;
    return true;
  }
  /// Slides from a cell and its neighbours, and on from where sand has come to lie, until all are at rest.
  void stabilise(int x, int y) {
    std::vector<std::pair<int, int>> unrest;
    const auto disturb = [&](int at_x, int at_y) {
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) unrest.emplace_back(at_x + dx, at_y + dy);
    };
    disturb(x, y);
    while (!unrest.empty()) {
      const auto [from_x, from_y] = unrest.back();
      unrest.pop_back();
      if (slide(from_x, from_y)) disturb(from_x, from_y);
    }
  }
  void poll() {
    int x = static_cast<int>(uniform() * side), y = static_cast<int>(uniform() * side);
    double open = 1 - shadow(x, y);
    if (at(x, y) <= 0 || uniform() >= open) return;
    const double amount = std::min(slab, at(x, y));
    at(x, y) -= amount;
    stabilise(x, y);
    for (double off_x = 0, off_y = 0;;) {
      off_x += hop * open + scatter();
      off_y += scatter();
      const int over_x = static_cast<int>(std::lround(off_x)), over_y = static_cast<int>(std::lround(off_y));
      off_x -= over_x;
      off_y -= over_y;
      x += over_x;
      y += over_y;
      open = 1 - shadow(x, y);
      const bool stays = uniform() < std::max(1 - open, at(x, y) >= 1e-3 ? 0.6 : 0.4);
      if (stays) at(x, y) += amount;
      creep(x, y);
      if (!stays) continue;
      stabilise(x, y);
      return;
    }
  }
  void run(int steps) {
    for (int n = 0; n < steps; ++n)
      for (int k = 0; k < side * side; ++k) poll();
  }
};

}  // namespace desert_sim::test
