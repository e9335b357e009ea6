// Three ripples on which rovers drove on Mars, with one set of constants of the ground: loose ones that
// held a rover or turned it back, and a high but firm one that was crossed.

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/rover/wheel_ground.hpp"
#include "test/support/running.hpp"

namespace desert_sim {
namespace {

/// A rover of three axles that drives east along one row of a scenario. All its wheels turn alike; their
/// slip follows from the mean slope and ground under its axles.
class Course {
 public:
  explicit Course(const std::string& scenario)
      : scenario_(shipped(scenario)),
        scene_(scenario_),
        law_(wheels::make_wheel_ground(scenario_.get<TraversabilityParameters>(),
                                       scenario_.get<WheelGroundParameters>())),
        height_(scene_.field(Layer::elevation)),
        looseness_(scene_.field(Layer::looseness)),
        sand_(scene_.field(Layer::sand)) {
    reset(10);
  }

  /// The rover's middle stands at x [m]; its wheels stand as deep as at rest on the ground there.
  void reset(double x) {
    x_ = x;
    most_slip_ = deepest_ = 0;
    depth_ = law_.sinkage(0, 1, ground());
  }
  /// Turns its wheels by `rim_way` metres.
  void drive(double rim_way) {
    constexpr double step = 0.005;
    for (double way = 0; way < rim_way; way += step) {
      const float slip =
          law_.longitudinal_slip(static_cast<float>(std::atan(slope())),
                                 scenario_.get<TraversabilityParameters>().drive_speed, ground());
      depth_ = law_.sinkage_after(depth_, static_cast<float>(step), slip, 1, ground());
      x_ += step * (1 - slip);
      most_slip_ = std::max(most_slip_, slip);
      deepest_ = std::max(deepest_, depth_);
    }
  }
  double x() const { return x_; }
  float most_slip() const { return most_slip_; }
  float deepest() const { return deepest_; }

  /// The costs of the layer traversability: share of lethal cells, and whether a way leads from west to
  /// east past them, over four neighbours.
  double lethal_share() { return share_of_lethal(costs()); }
  bool can_be_crossed() {
    const Field cost = costs();
    std::vector<char> reached(cost.values.size(), 0);
    std::vector<std::pair<int, int>> open;
    const auto visit = [&](int x, int y) {
      if (x < 0 || y < 0 || x >= cost.width || y >= cost.height) return;
      const auto i = static_cast<std::size_t>(y * cost.width + x);
      if (reached[i] || cost.values[i] <= 0) return;
      reached[i] = 1;
      open.emplace_back(x, y);
    };
    for (int y = 0; y < cost.height; ++y) visit(0, y);
    while (!open.empty()) {
      const auto [x, y] = open.back();
      open.pop_back();
      if (x == cost.width - 1) return true;
      visit(x + 1, y), visit(x - 1, y), visit(x, y + 1), visit(x, y - 1);
    }
    return false;
  }

 private:
  static double share_of_lethal(const Field& cost) {
    return static_cast<double>(std::count(cost.values.begin(), cost.values.end(), 0.0f)) /
           static_cast<double>(cost.values.size());
  }
  Field costs() { return scene_.field(Layer::traversability); }

  /// Of a field in the middle row, linear between cells.
  static double at(const Field& f, double x) {
    const double place = x / f.cell_size - 0.5, cell = std::floor(place);
    const auto value = [&](double c) {
      const int column = std::clamp(static_cast<int>(c), 0, f.width - 1);
      return static_cast<double>(f.values[static_cast<std::size_t>(f.height / 2 * f.width + column)]);
    };
    return value(cell) + (place - cell) * (value(cell + 1) - value(cell));
  }
  template <class Value>
  double mean_over_axles(const Value& value) const {
    const double half = 0.5 * scenario_.get<TraversabilityParameters>().wheelbase;
    return (value(x_ - half) + value(x_) + value(x_ + half)) / 3;
  }
  double slope() const {
    const double reach = 0.5 * height_.cell_size;
    return mean_over_axles(
        [&](double x) { return (at(height_, x + reach) - at(height_, x - reach)) / (2 * reach); });
  }
  wheels::Ground ground() const {
    const auto mean = [&](const Field& f) {
      return static_cast<float>(mean_over_axles([&](double x) { return at(f, x); }));
    };
    return {mean(looseness_), mean(sand_), 0};
  }

  Scenario scenario_;
  Running scene_;
  wheels::WheelGround law_;
  Field height_, looseness_, sand_;
  double x_ = 0;
  float depth_ = 0, most_slip_ = 0, deepest_ = 0;
};

TEST(MarsGallery, OneSetOfGroundConstantsServesAllThree) {
  const WheelGroundParameters defaults;
  for (const char* name : {"mars_purgatory", "mars_hidden_valley", "mars_dingo_gap"}) {
    const Scenario s = shipped(name);
    for_each_parameter(s.get<WheelGroundParameters>(), [&](const auto& row, const auto& value) {
      EXPECT_EQ(value, defaults.*(row.member)) << name << ": " << row.name;
    });
  }
}

/// Opportunity, sol 446: wheels in by more than 10 cm, 50 m commanded, 2 m made.
TEST(MarsGallery, AnMerSticksOnTheLooseRipplesOfPurgatory) {
  Course course("mars_purgatory");
  const double begin = course.x();
  course.drive(50);
  DESERT_REPORT("Purgatory: %.2f m made of 50 m, slip %.2f, sinkage %.3f m", course.x() - begin,
                course.most_slip(), course.deepest());
  EXPECT_LT(course.x() - begin, 2.5);
  EXPECT_EQ(course.most_slip(), 1);
  EXPECT_GT(course.deepest(), 0.10);
  EXPECT_LT(course.deepest(), 0.20) << "not over its wheels' tops";
  EXPECT_FALSE(course.can_be_crossed());
  EXPECT_GT(course.lethal_share(), 0.3);
}

/// Curiosity: slip up to 77 %, sinkage about 30 % of the wheel's 0.50 m.
TEST(MarsGallery, AnMslSlipsAndSinksInTheLooseRipplesOfHiddenValley) {
  Course course("mars_hidden_valley");
  course.drive(20);
  DESERT_REPORT("Hidden Valley: slip %.2f, sinkage %.3f m", course.most_slip(), course.deepest());
  EXPECT_GT(course.most_slip(), 0.6);
  EXPECT_LT(course.most_slip(), 1);
  EXPECT_NEAR(course.deepest() / 0.5, 0.30, 0.08);
  EXPECT_FALSE(course.can_be_crossed());
  EXPECT_GT(course.lethal_share(), 0.2);
}

TEST(MarsGallery, AnMslCrossesTheFirmMegarippleOfDingoGap) {
  Course course("mars_dingo_gap");
  course.drive(30);
  DESERT_REPORT("Dingo Gap: at %.1f m, slip %.2f, sinkage %.3f m", course.x(), course.most_slip(),
                course.deepest());
  EXPECT_GT(course.x(), 26) << "it is on the far side";
  EXPECT_LT(course.most_slip(), 0.4);
  EXPECT_GT(course.most_slip(), 0.1) << "it climbs";
  EXPECT_TRUE(course.can_be_crossed());
  EXPECT_EQ(course.lethal_share(), 0);
}

/// Height alone does not decide: the same ripples, packed, are driven over, and the same megaripple, loose,
/// is not.
TEST(MarsGallery, LoosenessDecides) {
  const auto most_slip = [](const std::string& name, const std::string& looseness) {
    const Scenario s = shipped(name, {"terrain.2.uniform.value=" + looseness});
    Running scene(s);
    const Field slip = scene.field(Layer::slip);
    return *std::max_element(slip.values.begin(), slip.values.end());
  };
  EXPECT_LT(most_slip("mars_hidden_valley", "0"), 0.2f);
  EXPECT_EQ(most_slip("mars_dingo_gap", "1"), 1);
}

}  // namespace
}  // namespace desert_sim
