// Slip and sinkage of wheels: the figures of their sources, balances worked out in another way, limits.

#include "kernels/rover/wheel_ground.hpp"

#include <cmath>

#include "src/scenario/rover_presets.hpp"
#include "test/support/refusal.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using wheels::Ground;
using wheels::WheelGround;

constexpr float radians_per_degree = 0.0174532925f;
constexpr Ground loose{1, 1, 0}, packed{0, 1, 0};

WheelGround wheels_of(const std::string& rover) {
  const Scenario s = test::parsed("rover: " + rover + "\n");
  return wheels::make_wheel_ground(s.get<TraversabilityParameters>(), s.get<WheelGroundParameters>());
}

TEST(WheelMath, LogarithmAndPowerAreThoseOfTheLibrary) {
  for (float x = 1e-30f; x < 1e30f; x *= 1.37f) {
    const double exact = std::log(static_cast<double>(x));
    EXPECT_NEAR(logarithm(x), exact, 2e-7 * std::max(1.0, std::abs(exact))) << x;
    for (const float y : {0.625f, 1.0f, 2.1f, -0.7f}) {
      if (std::abs(y * exact) > 80) continue;
      const double raised = std::pow(static_cast<double>(x), static_cast<double>(y));
      EXPECT_NEAR(power(x, y), raised, 1e-6 * raised * (1 + std::abs(y * exact))) << x << "^" << y;
    }
  }
  EXPECT_EQ(logarithm(1), 0);
  EXPECT_EQ(power(0, 0.6f), 0);
  EXPECT_EQ(power(1, 7), 1);
}

/// The paper's formula, with 0.1 m/s: a slip of about 0.2 at 10 degrees and 0.6 at 20.
TEST(LightLaw, HasTheFiguresOfItsSource) {
  const WheelGround w = wheels_of("small");
  EXPECT_NEAR(w.longitudinal_slip(10 * radians_per_degree, 0.1f, loose), 0.18545, 1e-4);
  EXPECT_NEAR(w.longitudinal_slip(20 * radians_per_degree, 0.1f, loose), 0.65705, 1e-4);
  EXPECT_NEAR(w.longitudinal_slip(-10 * radians_per_degree, 0.1f, loose), -0.12895, 1e-4);
  EXPECT_EQ(w.longitudinal_slip(40 * radians_per_degree, 0.1f, loose), 1);
  EXPECT_NEAR(w.lateral_slip(10 * radians_per_degree, loose), 0.105, 1e-4);
  EXPECT_NEAR(w.sinkage(0.5f, 1, loose), 1e-3 * (33.56 * 0.5 + 3.11), 1e-6);
  const double weight = 30 * 9.81 / 4;
  EXPECT_NEAR(w.sinkage(0.5f, 1.1f, loose), 1e-3 * (33.56 * 0.5 + 0.0929 * weight + 3.11), 1e-6);
  EXPECT_EQ(w.sinkage(0, 0, loose), 0) << "not above the ground";
  EXPECT_NEAR(w.longitudinal_slip(10 * radians_per_degree, 0.1f, packed), 0.3 * 0.18545, 1e-4);
}

/// MER on loose ground, every quantity from its formula in double precision.
TEST(BekkerLaw, BalancesThrustWithResistanceAndSlope) {
  const WheelGround w = wheels_of("mer");
  const double load = 185 * 3.71 / 6, r = 0.13, b = 0.16, c = 762,
               tan_phi = std::tan(22.3 * radians_per_degree), n = 1.1, k = 1000 / b + 5e5, shear = 0.025;
  const double z = std::pow(3 * load / (b * (3 - n) * k * std::sqrt(2 * r)), 2 / (2 * n + 1));
  const double length = std::sqrt(z * (2 * r - z)), resistance = b * k * std::pow(z, n + 1) / (n + 1);
  EXPECT_NEAR(w.sinkage(0, 1, loose), z, 1e-5);
  EXPECT_NEAR(w.sinkage(0.5f, 1, loose), z * 1.5 / 0.75, 1e-5);
  EXPECT_NEAR(w.sinkage(1, 1, loose), z * 4, 1e-5);
  for (const double slope : {0.0, 2.0, 4.0}) {
    const double s = w.longitudinal_slip(static_cast<float>(slope) * radians_per_degree, 0.05f, loose),
                 x = s * length / shear;
    const double thrust = (c * b * length + load * tan_phi) * (1 - (1 - std::exp(-x)) / x);
    EXPECT_NEAR(thrust, resistance + load * std::tan(slope * radians_per_degree), 1e-3 * load)
        << slope << " degrees, slip " << s;
  }
  const double across = w.lateral_slip(8 * radians_per_degree, loose), y = across * length / shear;
  EXPECT_NEAR((c * b * length + load * tan_phi) * (1 - (1 - std::exp(-y)) / y),
              load * std::tan(8 * radians_per_degree), 1e-3 * load);
}

TEST(BekkerLaw, SlipGrowsWithSlopeAndLoosenessUntilTheWheelsTurnOnTheSpot) {
  for (const char* rover : {"mer", "msl", "six_wheel_200kg"}) {
    SCOPED_TRACE(rover);
    const WheelGround w = wheels_of(rover);
    for (float looseness = 0; looseness < 1; looseness += 0.125f) {
      const Ground g{looseness, 1, 0}, looser{looseness + 0.125f, 1, 0};
      float before = -1;
      for (float slope = -30; slope <= 40; slope += 2) {
        const float s = w.longitudinal_slip(slope * radians_per_degree, 0.1f, g);
        EXPECT_GE(s, before);
        EXPECT_TRUE(before == 1 || s > before) << slope;
        EXPECT_LE(s, 1);
        if (slope >= 0) {
          EXPECT_GE(w.longitudinal_slip(slope * radians_per_degree, 0.1f, looser), s);
          EXPECT_GE(w.sinkage(s, 1, looser), w.sinkage(s, 1, g));
        }
        before = s;
      }
      EXPECT_EQ(before, 1) << "40 degrees are too steep for any";
    }
    EXPECT_LT(w.longitudinal_slip(-20 * radians_per_degree, 0.1f, packed), 0)
        << "it slides ahead of its wheels";
    EXPECT_EQ(w.lateral_slip(-10 * radians_per_degree, loose),
              -w.lateral_slip(10 * radians_per_degree, loose));
  }
}

TEST(WheelGround, HalfWetGroundIsFirmMudIsNot) {
  const WheelGround w = wheels_of("msl");
  const auto slip = [&](float moisture) {
    return w.longitudinal_slip(8 * radians_per_degree, 0.04f, {1, 1, moisture});
  };
  EXPECT_LT(slip(0.25f), slip(0));
  EXPECT_LT(slip(0.5f), slip(0.25f));
  EXPECT_LT(slip(0.5f), w.longitudinal_slip(8 * radians_per_degree, 0.04f, packed));
  EXPECT_GT(slip(0.8f), slip(0.5f));
  EXPECT_EQ(slip(1), 1);
  EXPECT_GT(w.sinkage(0, 1, {1, 1, 1}), w.sinkage(0, 1, loose));
  const Scenario s = test::scenario_of("rover: msl\nrepose: {half_wet: 3, saturated: 1}\n");
  const WheelGround firm = wheels::make_wheel_ground(
      s.get<TraversabilityParameters>(), s.get<WheelGroundParameters>(), s.get<ReposeParameters>());
  EXPECT_LT(firm.longitudinal_slip(8 * radians_per_degree, 0.04f, {1, 1, 0.5f}), slip(0.5f));
  EXPECT_LT(firm.longitudinal_slip(8 * radians_per_degree, 0.04f, {1, 1, 1}), 1);
}

TEST(WheelGround, ThinSandLetsTheWheelDownOnRock) {
  const WheelGround w = wheels_of("msl");
  EXPECT_EQ(w.sinkage(1, 1, {1, 0, 0}), 0);
  EXPECT_EQ(w.sinkage(1, 1, {1, 0.01f, 0}), 0.01f);
  const float on_rock = w.longitudinal_slip(15 * radians_per_degree, 0.04f, {1, 0, 0});
  EXPECT_LT(on_rock, w.longitudinal_slip(15 * radians_per_degree, 0.04f, packed)) << "rock does not give way";
  EXPECT_GT(w.longitudinal_slip(15 * radians_per_degree, 0.04f, {1, 0.1f, 0}), on_rock);
  EXPECT_EQ(w.longitudinal_slip(15 * radians_per_degree, 0.04f, loose),
            w.longitudinal_slip(15 * radians_per_degree, 0.04f, {1, 0.25f, 0}))
      << "from the depth of a wheel's radius on sand is deep";
}

TEST(WheelGround, SinkageFollowsTheWayOfTheRimHoweverItIsDivided) {
  for (const char* rover : {"mer", "small"}) {
    const WheelGround w = wheels_of(rover);
    const float steady = w.sinkage(0.9f, 1, loose), begin = w.sinkage(0.1f, 1, loose);
    float depth = begin;
    for (int n = 0; n < 50; ++n) depth = w.sinkage_after(depth, 0.002f, 0.9f, 1, loose);
    EXPECT_NEAR(depth, w.sinkage_after(begin, 0.1f, 0.9f, 1, loose), 1e-6);
    EXPECT_NEAR(w.sinkage_after(begin, w.contact_length(steady), 0.9f, 1, loose),
                steady + (begin - steady) * std::exp(-1.0), 1e-6);
    EXPECT_NEAR(w.sinkage_after(depth, 5, 0.1f, 1, loose), begin, 1e-6) << "it comes out again";
    EXPECT_EQ(w.sinkage_after(depth, 0, 0.1f, 1, loose), depth) << "a wheel at rest stays";
    EXPECT_EQ(w.sinkage_after(depth, 0.03f, 0.9f, 1, loose), w.sinkage_after(depth, -0.03f, 0.9f, 1, loose));
  }
}

TEST(RoverClass, EachSetsTheSectionTraversability) {
  EXPECT_EQ(rover_presets(), (std::vector<std::string>{"mer", "msl", "six_wheel_200kg", "small"}));
  for (const std::string& name : rover_presets()) {
    SCOPED_TRACE(name);
    EXPECT_GT(rover_preset_doc(name).size(), 20u);
    EXPECT_NE(rover_preset_text(name).find("rover_dimensions:"), std::string::npos);
    EXPECT_NE(dump_scenario(test::scenario_of("rover: " + name + "\n")),
              dump_scenario(test::scenario_of("{}")));
    const Scenario s = test::scenario_of("rover: " + name + "\n");
    EXPECT_EQ(parse_scenario_text(dump_scenario(s), "again").get<TraversabilityParameters>().mass,
              s.get<TraversabilityParameters>().mass);
  }
  EXPECT_EQ(test::parsed("rover: mer\n").get<TraversabilityParameters>().mass, 185);
  const Scenario heavier = test::parsed("rover: mer\ntraversability: {mass: 200}\n");
  EXPECT_EQ(heavier.get<TraversabilityParameters>().mass, 200) << "what the scenario says overrides it";
  EXPECT_EQ(heavier.get<TraversabilityParameters>().wheelbase, 1.41f);
}

TEST(RoverClass, AnUnknownOneIsRefusedByName) {
  const std::string reason = test::refusal([] { test::parsed("rover: moon\n"); });
  EXPECT_NE(reason.find("rover: 'moon' is not one of: mer, msl, six_wheel_200kg, small"), std::string::npos)
      << reason;
  EXPECT_NE(test::refusal([] { rover_preset_text("moon"); }).find("'moon'"), std::string::npos);
}

}  // namespace
}  // namespace desert_sim
