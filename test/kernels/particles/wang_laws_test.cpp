// The laws of flying grains by themselves: bounces, the shelter, what the wind lifts, and what impacts do.

#include "kernels/particles/wang_laws.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "test/support/world.hpp"

namespace desert_sim::particles {
namespace {

constexpr float quantum = 1.0f / 1048576;
constexpr int side = 16;

/// A periodic bed of a square of cells of a centimetre, in a wind to the east.
struct Ground {
  ParticleParameters parameters;
  Grid grid{side, side, 0.01f, true, true};
  Wind wind{parameters, {12, 0}};
  Downwind order{grid, {12, 0}};
  std::vector<Column> columns;
  std::vector<Quanta> sand, water, impacts, splash, landed;
  std::vector<float> vegetation;
  TerrainView terrain;

  Ground()
      : columns(static_cast<std::size_t>(grid.cells()), Column{5000, 5000, 5000}),
        sand(columns.size(), 1000000),
        water(columns.size()),
        impacts(columns.size()),
        splash(columns.size()),
        landed(columns.size()),
        vegetation(columns.size()) {}

  void set(int x, int y, Quanta surface) {
    columns[static_cast<std::size_t>(order.slot(x, y))] = {surface, surface, surface};
  }
  Quanta landed_at(int x, int y) const { return landed[static_cast<std::size_t>(grid.index(x, y))]; }

  Flights flights() {
    return {order, columns.data(), quantum, 1 / quantum, wind.air,      make_starts(parameters),
            0.5f,  0.4f,           0.05f,   nullptr,     landed.data(), {}};
  }
  Loose loose() {
    return {sand.data(),
            vegetation.data(),
            water.data(),
            quantum,
            repose::RelativeMoisture(terrain, ReposeParameters{}),
            saltation::Dryness(SaltationParameters().moisture_cutoff)};
  }
  LiftOff lift_off() {
    return {flights(),      loose(),      wind.shear_velocity,
            0.04f,          1.0f,         0.0015f,
            0.007f,         2.0f,         0.0f,
            0.0f,           0.5f,         12,
            {1, nullptr},   {2, nullptr}, {3, nullptr},
            impacts.data(), splash.data()};
  }
};

/// Off a slope of 3 in 4: the speed into it, 2.2 m/s, is turned round and halved; 0.4 of the rest is left.
TEST(ParticleLaws, ABounceDampsBothPartsOfTheVelocity) {
  Grain g{0, 0, 0, 1.0f, 0.5f, -2.0f};
  EXPECT_NEAR(bounce({0, 0, 0.75f, 0}, 0.5f, 0.4f, g), 1.1f, 1e-6f);
  EXPECT_NEAR(g.velocity_x, -0.66f - 0.128f, 1e-6f);
  EXPECT_NEAR(g.velocity_y, 0.2f, 1e-6f);
  EXPECT_NEAR(g.velocity_z, 0.88f - 0.096f, 1e-6f);
}

/// One sweep downwind on one thread, over a periodic edge in two rounds.
void sweep(const FindShelter& find) {
  const Downwind& order = find.order;
  std::vector<std::array<Quanta, 2>> ways(static_cast<std::size_t>(order.length()),
                                          {FindShelter::none, FindShelter::none});
  for (int line = order.periodic_along() ? -order.lines() : 0; line < order.lines(); ++line)
    for (int way = 0; way < order.length(); ++way) {
      std::array<Quanta, 2>& words = ways[static_cast<std::size_t>(way)];
      const std::array<Quanta, 2> before = words;
      find.store(line, way,
                 find.pass(
                     find.load(line, way), [&](int k) { return before[static_cast<std::size_t>(k)]; },
                     [&](int k) -> Quanta& { return words[static_cast<std::size_t>(k)]; }));
    }
}

TEST(ParticleLaws, ShelterFallsByItsAngle) {
  Ground ground;
  ground.set(12, 9, 9000);
  sweep({ground.order, 0, 600, 0.1f, ground.columns.data()});
  for (int d = 1; d < side; ++d) {
    const int x = wrap(12 + d, side);
    EXPECT_EQ(ground.columns[static_cast<std::size_t>(ground.order.slot(x, 9))].shelter,
              std::max(9000 - 600 * d, 5000))
        << d;
    EXPECT_EQ(ground.columns[static_cast<std::size_t>(ground.order.slot(x, 8))].shelter, 5000);
  }
}

/// Behind a step the mean of the ground upwind tends to it by exp(−distance/ℓ).
TEST(ParticleLaws, GroundUpwindIsAMeanWithALength) {
  Ground ground;
  ground.grid.periodic_x = ground.grid.periodic_y = false;
  ground.order = Downwind(ground.grid, {12, 0});
  for (int x = 4; x < side; ++x)
    for (int y = 0; y < side; ++y) ground.set(x, y, 105000);
  sweep({ground.order, 0, 600, static_cast<float>(1 - std::exp(-0.01 / 0.03)), ground.columns.data()});
  for (int x = 0; x < side; ++x)
    EXPECT_NEAR(ground.columns[static_cast<std::size_t>(ground.order.slot(x, 5))].upwind,
                5000 + 100000 * (1 - std::exp(-std::max(x - 3, 0) / 3.0)), 10)
        << x;
}

/// 1 + cot α ∂h/∂s with cot α = 2, on slopes of a tenth.
TEST(ParticleLaws, SlopesThatFaceTheWindGiveMoreSand) {
  Ground ground;
  const auto tenth = static_cast<Quanta>(0.1 * 0.01 / static_cast<double>(quantum));
  ground.set(6, 5, 5000 + tenth);
  ground.set(4, 5, 5000 - tenth);
  ground.set(6, 9, 5000 - tenth);
  ground.set(4, 9, 5000 + tenth);
  ground.set(6, 12, 5000 - 9 * tenth);
  ground.set(4, 12, 5000 + 9 * tenth);
  ground.set(5, 2, 5000 + 9 * tenth);  // beside the wind
  const LiftOff lift_off = ground.lift_off();
  const Flights flights = ground.flights();
  EXPECT_NEAR(lift_off.exposure_at(flights.bed_at(5, 5)), 1.2f, 1e-3f);
  EXPECT_NEAR(lift_off.exposure_at(flights.bed_at(5, 9)), 0.8f, 1e-3f);
  EXPECT_EQ(lift_off.exposure_at(flights.bed_at(5, 12)), 0);
  EXPECT_EQ(lift_off.exposure_at(flights.bed_at(5, 1)), 1);
}

/// By ln((z_e + h − h_u)/z_0)/ln(z_e/z_0), z_0 = d/30.
TEST(ParticleLaws, CrestsStandInFasterWind) {
  Ground ground;
  const LiftOff lift_off = ground.lift_off();
  const float u = ground.wind.shear_velocity;
  const double roughness = 0.00015 / 30, above = 3000 * static_cast<double>(quantum);
  EXPECT_NEAR(lift_off.shear_velocity_at({5000, 5000, 5000}), u, 1e-5f * u);
  EXPECT_NEAR(static_cast<double>(lift_off.shear_velocity_at({8000, 8000, 5000})),
              static_cast<double>(u) * std::log((0.007 + above) / roughness) / std::log(0.007 / roughness),
              1e-4);
  EXPECT_LT(lift_off.shear_velocity_at({5000, 8000, 5000}), 0.5f * u) << "under a shelter of 3 mm";
}

TEST(ParticleLaws, ImpactsThrowUpGrainsByTheirSpeed) {
  Ground ground;
  RandomSequence words{1};
  ground.lift_off().strike(7, 10000, 3.0f, words);
  EXPECT_EQ(ground.impacts[7], 10000);
  EXPECT_EQ(ground.splash[7], 15000) << "half a grain for each metre a second";
}

/// Speeds are exponentially distributed with the mean v_e, but bounded by that of the impact.
TEST(ParticleLaws, SplashIsNoFasterThanTheImpact) {
  Ground ground;
  const Starts starts = make_starts(ground.parameters);
  for (const float impact : {0.2f, 1.0f, 5.0f}) {
    const double root = std::sqrt(9.81 * 0.00015), v = static_cast<double>(impact),
                 mean = 0.3 * root / 0.02 * (1 - std::exp(-v / (40 * root)));
    RandomSequence words{1};
    double sum = 0;
    constexpr int grains = 20000;
    for (int n = 0; n < grains; ++n) {
      Grain g{};
      starts.splash(ground.wind.air, impact, words, g);
      ASSERT_LE(g.speed(), 1.0001f * impact);
      sum += static_cast<double>(g.speed()) / grains;
    }
    EXPECT_NEAR(sum, mean * (1 - std::exp(-v / mean)), 0.03 * mean) << impact << " m/s";
  }
}

/// With λ_c/l² = 2/m, a splash of 10⁶ quanta moves 2 · 10⁶ times the drop in metres to each lower neighbour.
TEST(ParticleLaws, CreepGoesDownhillByTheDrop) {
  Ground ground;
  ground.set(6, 5, 4000);
  ground.set(5, 4, 3000);
  ground.set(4, 5, 6000);
  Splash{ground.flights(),      ground.loose(),      1.0f, 2.0f, {1, nullptr}, {2, nullptr}, {3, nullptr},
         ground.impacts.data(), ground.splash.data()}
      .creep_down(5, 5, ground.grid.index(5, 5), 1e6f);
  EXPECT_EQ(ground.landed_at(6, 5), static_cast<Quanta>(std::lround(2e9 / 1048576)));
  EXPECT_EQ(ground.landed_at(5, 4), static_cast<Quanta>(std::lround(4e9 / 1048576)));
  EXPECT_EQ(ground.landed_at(4, 5), 0);
  EXPECT_EQ(ground.landed_at(5, 6), 0);
  EXPECT_EQ(ground.sand[static_cast<std::size_t>(ground.grid.index(5, 5))],
            1000000 - ground.landed_at(6, 5) - ground.landed_at(5, 4));
}

TEST(ParticleLaws, RoughnessAndSplashGoByTheirNumbers) {
  ParticleParameters p;
  const Wind usual(p, {8, 0});
  const float per_speed = make_starts(p).per_impact_speed;
  p.grains_per_roughness = 15;
  p.splash_speed = 80;
  EXPECT_FLOAT_EQ(usual.air.per_roughness, 30 / p.grain_diameter);
  EXPECT_FLOAT_EQ(Wind(p, {8, 0}).air.per_roughness, 15 / p.grain_diameter);
  EXPECT_FLOAT_EQ(make_starts(p).per_impact_speed, 0.5f * per_speed);
}

TEST(ParticleLaws, MoistureHoldsTheSandFromItsCutOffOn) {
  const saltation::Dryness dry(0.4f);
  EXPECT_FLOAT_EQ(dry(0), 1);
  EXPECT_FLOAT_EQ(dry(0.1f), 0.75f);
  EXPECT_EQ(dry(0.5f), 0);
}

TEST(ParticleLaws, WaterAndPlantsHoldTheSand) {
  Ground ground;
  ground.water[3] = 1000;
  ground.vegetation[4] = 0.25f;
  const Loose loose = ground.loose();
  EXPECT_EQ(loose.share(2), 1);
  EXPECT_EQ(loose.share(3), 0);
  EXPECT_EQ(loose.share(4), 0.75f);
}

/// Grains that gain Δv take up the stress above the threshold: φ ρ_s E Δv = ρ_a (u_*² − u_*t²).
TEST(ParticleLaws, LiftOffTakesUpTheStressAboveTheThreshold) {
  const ParticleParameters p;
  for (const float speed : {8.0f, 12.0f, 20.0f}) {
    const Wind wind(p, {speed, 0});
    double gain = 0;
    constexpr int parts = 24;
    for (int n = 0; n < parts; ++n)
      for (int m = 0; m < parts; ++m) {
        const double up = (0.8 + 1.2 * (n + 0.5) / parts) * static_cast<double>(wind.shear_velocity),
                     angle = (21 + 69 * (m + 0.5) / parts) * 3.14159265 / 180;
        gain += static_cast<double>(
                    level_run(p, wind.air, static_cast<float>(up), static_cast<float>(up / std::tan(angle)))
                        .gain) /
                (parts * parts);
      }
    const auto u = static_cast<double>(wind.shear_velocity), threshold = static_cast<double>(wind.threshold);
    EXPECT_NEAR(0.6 * 2655 * static_cast<double>(wind.lift_rate) * gain,
                1.1644 * (u * u - threshold * threshold), 0.03 * 1.1644 * u * u)
        << speed << " m/s";
  }
}

}  // namespace
}  // namespace desert_sim::particles
