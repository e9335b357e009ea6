// Looseness of the ground: deposits and slides loosen, impacts pack, water and crusts make firm.

#include "kernels/sand/looseness.hpp"

#include "test/support/bench_terrain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

TEST(LoosenessLaw, ADepthOfFreshSandLeavesOneOverEOfWhatWasPacked) {
  EXPECT_NEAR(looseness::loosened(0, 1), 1 - std::exp(-1.0), 1e-6);
  EXPECT_NEAR(looseness::loosened(0.4f, 1), 1 - 0.6 * std::exp(-1.0), 1e-6);
  EXPECT_EQ(looseness::loosened(0.4f, 0), 0.4f);
  EXPECT_EQ(looseness::loosened(1, 7), 1);
  EXPECT_NEAR(looseness::loosened(0.25f, 1e-4f), 0.25 + 0.75e-4, 1e-7);
}

TEST(LoosenessLaw, TendsToTheBalanceOfLooseningAndPacking) {
  EXPECT_EQ(looseness::after(0.3f, 0, 0), 0.3f);
  EXPECT_NEAR(looseness::after(0.8f, 0, 2), 0.8 * std::exp(-2.0), 1e-6);
  EXPECT_NEAR(looseness::after(0.1f, 3, 0), looseness::loosened(0.1f, 3), 1e-6);
  EXPECT_NEAR(looseness::after(0.9f, 300, 100), 0.75, 1e-6);
  EXPECT_NEAR(looseness::after(0, 0.3f, 0.1f), 0.75 * (1 - std::exp(-0.4)), 1e-6);
}

/// Rates are integrated exactly, so that a hundred short times are one long one.
TEST(LoosenessLaw, AHundredPartsAreTheWhole) {
  float parts = 0.9f;
  for (int n = 0; n < 100; ++n) parts = looseness::after(parts, 0.004f, 0.011f);
  EXPECT_NEAR(parts, looseness::after(0.9f, 0.4f, 1.1f), 1e-5);
}

class Looseness : public test::OnBackend {
 protected:
  using Change = std::function<void(test::BenchTerrain&)>;

  /// Looseness, 0.5 before, after 2 s in which `gain` metres come to lie on `sand` metres, and `impacts`
  /// metres come down in a hop of 1 s.
  double after(double sand, double gain, double impacts, const Change& change = {}) {
    test::BenchTerrain t(exec(), 3, 2);
    t.set(Layer::looseness, 0.5).set(Layer::sand, sand).set(Layer::soil, 1);
    t.set(Layer::wind_shadow, 0);
    t.set_strength([&](int, int) { return impacts; });
    if (change) change(t);
    Buffer<Quanta> before(exec(), t.cells());
    with_backend(exec(), [&](auto& e) {
      looseness::record(e, t.terrain.view(), before.data());
      t.set(Layer::sand, sand + gain);
      looseness::step(e, t.terrain.view(), p, {}, {2, 1, t.strength.data()}, before.data());
    });
    EXPECT_EQ(before.download()[4], t.quanta_at(Layer::sand, 1, 1)) << "what slides is counted from here";
    return t.at(Layer::looseness, 1, 1);
  }
  LoosenessParameters p{true, 0.3f, 0.05f, 0.5f, 0.1f, 0.001f};
};

TEST_P(Looseness, DepositsLoosen) {
  EXPECT_NEAR(after(2, 0.05, 0), 1 - 0.5 * std::exp(-1.0), 1e-4);
  EXPECT_EQ(after(2, -0.05, 0), 0.5) << "what is laid bare stays as it was";
}

TEST_P(Looseness, ImpactsPackWhereTheGrainsFly) {
  EXPECT_NEAR(after(2, 0, 0.25), 0.5 * std::exp(-1.0), 1e-5);
  EXPECT_NEAR(after(2, 0, 0.25, [](auto& t) { t.set(Layer::wind_shadow, 0.5); }), 0.5 * std::exp(-0.5), 1e-5);
  EXPECT_EQ(after(2, 0, 0.25, [](auto& t) { t.set(Layer::wind_shadow, 1); }), 0.5);
}

TEST_P(Looseness, DepositsAndImpactsBalance) {
  const double a = 0.1 / 0.05, b = 0.5;  // over 2 s
  EXPECT_NEAR(after(2, 0.1, 0.125), a / (a + b) + (0.5 - a / (a + b)) * std::exp(-(a + b)), 1e-4);
}

TEST_P(Looseness, WaterAndCrustsMakeFirm) {
  // Two metres of sand and one of soil hold 0.3 m.
  EXPECT_NEAR(after(2, 0, 0, [](auto& t) { t.set(Layer::moisture, 0.075); }), 0.5 * std::exp(-0.1), 1e-5);
  EXPECT_NEAR(after(2, 0, 0, [](auto& t) { t.set(Layer::moisture, 0.3); }), 0.5 * std::exp(-0.2), 1e-5);
  EXPECT_NEAR(after(0.0005, 0, 0), 0.5 * std::exp(-0.2), 1e-5) << "bare soil has a crust";
  EXPECT_EQ(after(0.002, 0, 0), 0.5);
}

TEST_P(Looseness, SlidesLoosenWhereTheyComeFromAndWhereTheyGo) {
  test::BenchTerrain t(exec(), 3, 1);
  Buffer<Quanta> before(exec(), t.cells());
  const double dry = std::tan(33 * 3.14159265 / 180);
  const auto slide = [&](double tangent) {
    t.set(Layer::looseness, 0.5).set(Layer::sand, 2);
    t.set_repose([&](int, int) { return tangent; });
    with_backend(exec(), [&](auto& e) {
      looseness::record(e, t.terrain.view(), before.data());
      t.set(Layer::sand, [](int x, int) { return 1.95 + 0.05 * x; });
      looseness::slides(e, t.terrain.view(), p, {}, t.repose.data(), before.data());
    });
  };
  slide(0.75 * dry);
  EXPECT_NEAR(t.at(Layer::looseness, 0, 0), 1 - 0.5 * std::exp(-0.5), 1e-4) << "half of it is creep";
  slide(0.5 * dry);
  EXPECT_EQ(t.at(Layer::looseness, 0, 0), 0.5) << "impacts make it creep";
  slide(dry);
  EXPECT_NEAR(t.at(Layer::looseness, 0, 0), 1 - 0.5 * std::exp(-1.0), 1e-4);
  EXPECT_EQ(t.at(Layer::looseness, 1, 0), 0.5);
  EXPECT_NEAR(t.at(Layer::looseness, 2, 0), 1 - 0.5 * std::exp(-1.0), 1e-4);
}

DESERT_ON_EACH_BACKEND(Looseness);

}  // namespace
}  // namespace desert_sim
