// Streams under virtual pipes: uniform flow by the drag of the bed, and, where that would be too fast, steady
// flow at froude_limit.

#include <algorithm>
#include <cmath>

#include "src/core/constants.hpp"
#include "test/support/bench_terrain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

/// Mean and standard deviation of a series.
class Series {
 public:
  void add(double value) {
    ++count_;
    sum_ += value;
    squares_ += value * value;
  }
  double mean() const { return sum_ / count_; }
  double deviation() const { return std::sqrt(std::max(squares_ / count_ - mean() * mean(), 0.0)); }

 private:
  double count_ = 0, sum_ = 0, squares_ = 0;
};

class WaterStreams : public test::OnBackend {
 protected:
  static constexpr double g = 9.81, limit = virtual_pipes::froude_limit;

  static WaterParameters with_drag(double drag) {
    WaterParameters p;
    p.friction = 0;
    p.drag = static_cast<float>(drag);
    return p;
  }
  /// A step of a second, with a spring.
  void flow(test::BenchTerrain& t, const WaterParameters& p, const Spring& spring) {
    with_backend(exec(), [&](auto& e) {
      water_sources::add_spring(e, t.terrain.view(), spring, spring.x, spring.y, 1, ticks_, t.ledger());
    });
    t.flow(p, 1, static_cast<double>(ticks_++));
  }
  std::uint64_t ticks_ = 0;
};

/// Chézy: what the bed's drag allows, however thin the water.
TEST_P(WaterStreams, BelowTheLimitCarryWhatTheBedsDragAllows) {
  for (const auto& [slope, depth] : {std::pair{0.01, 0.4}, {0.02, 0.01}, {0.02, 0.0005}}) {
    // A ramp on a torus has a cliff, and the flow is measured before the cliff's wave comes there.
    test::BenchTerrain t(exec(), 4096, 1, 1, true);
    t.set(Layer::bedrock, [slope = slope](int x, int) { return slope * (4096 - x); });
    t.set(Layer::water, depth);
    for (int n = 0; n < 60; ++n) t.flow(with_drag(0.05), 1);
    const double expected = std::sqrt(g * depth * slope / 0.05);
    for (int x = 2048; x < 2048 + 64; ++x)
      EXPECT_NEAR(t.at(Layer::water_velocity_x, x, 0) / expected, 1, 0.02) << "depth " << depth;
  }
}

/// A channel of 4 × 300 cells with 0.2 m²/s, which drag would let run at Fr 0.71 … 3.2. Without the limit it
/// broke into pulses, whose depth at a place deviated by 150 to 280 % of its mean. So did streams at the
/// limit, by 6 to 24 %, with sub-steps as long as slow water allows.
TEST_P(WaterStreams, FasterThanTheLimitAreSteadyAtIt) {
  const int cells = 300;
  const double per_metre = 0.2, depth = std::pow(per_metre / (limit * std::sqrt(g)), 2.0 / 3);
  for (const double slope : {0.005, 0.01, 0.02, 0.1}) {
    test::BenchTerrain t(exec(), cells, 6, 1, false);
    t.set(Layer::bedrock,
          [&](int x, int y) { return slope * (cells - x) + (y == 0 || y == 5 ? 20 : 0) + (x == 0 ? 5 : 0); });
    t.terrain.allocate(Layer::water);
    Series at[3];
    for (int n = 0; n < 700; ++n) {
      flow(t, with_drag(0.01), {5, 3, 2.5, static_cast<float>(4 * per_metre)});
      if (n >= 400)
        for (int k = 0; k < 3; ++k) at[k].add(t.at(Layer::water, 60 + 90 * k, 2));
    }
    for (const Series& s : at) {
      EXPECT_LT(s.deviation() / s.mean(), 0.005) << "slope " << slope;
      EXPECT_NEAR(s.mean() / depth, 1, 0.01) << "slope " << slope;
    }
  }
}

/// The limit is one of the whole velocity: a stream at 45 degrees in a valley is no faster than along an
/// axis.
TEST_P(WaterStreams, AtAnAngleAreSteadyAtTheSameLimit) {
  const int cells = 128;
  const double middle = cells / 2, slope = 0.03;
  for (const double degrees : {0.0, 20.0, 45.0}) {
    const double c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
    test::BenchTerrain t(exec(), cells, cells, 1, false);
    t.set(Layer::bedrock, [&](int x, int y) {
      const double far = (x + 0.5 - middle) * c + (y + 0.5 - middle) * s,
                   across = (y + 0.5 - middle) * c - (x + 0.5 - middle) * s;
      return 20 - slope * far + 0.002 * across * across + (far < -58 ? 3 : 0);
    });
    t.terrain.allocate(Layer::water);
    const int x = static_cast<int>(middle + 20 * c), y = static_cast<int>(middle + 20 * s);
    Series depth, froude;
    for (int n = 0; n < 400; ++n) {
      flow(t, with_drag(0.01),
           {static_cast<float>(middle - 53 * c), static_cast<float>(middle - 53 * s), 3, 4});
      if (n < 250) continue;
      const double w = t.at(Layer::water, x, y);
      depth.add(w);
      froude.add(std::hypot(t.at(Layer::water_velocity_x, x, y), t.at(Layer::water_velocity_y, x, y)) /
                 std::sqrt(g * w));
    }
    EXPECT_GT(depth.mean(), 0.2) << degrees << " degrees";
    EXPECT_LT(depth.deviation() / depth.mean(), 0.01) << degrees << " degrees";
    EXPECT_NEAR(froude.mean() / limit, 1, 0.02) << degrees << " degrees";
  }
}

DESERT_ON_EACH_BACKEND(WaterStreams);

}  // namespace
}  // namespace desert_sim
