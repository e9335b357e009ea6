// Flights of grains beside an integration of their own, the bounds of bounces, what shelter does, and the
// books of whole runs.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "kernels/particles/wang_laws.hpp"
#include "test/support/world.hpp"

namespace desert_sim::particles {
namespace {

/// Position and velocity of a grain along the wind and upward.
struct State {
  double x, z, u, w;
};

/// Length of a hop over level ground [m]: the same forces in double precision, Runge–Kutta of fourth order
/// with steps of 20 µs.
double independent_hop(const ParticleParameters& p, double shear_velocity, double up, double forward) {
  const double d = p.grain_diameter, z0 = d / 30, focus = p.focus_height,
               threshold = 0.1 * std::sqrt((2655 / 1.1644 - 1) * 9.81 * 0.00015),
               drag = 0.75 * p.drag_coefficient * p.air_density / (p.grain_density * d);
  const auto rate = [&](const State& s) {
    const double below = std::log(std::min(s.z, focus) / z0), above = std::log(std::max(s.z, focus) / focus);
    const double wind = s.z > z0 ? (threshold * below + shear_velocity * above) / 0.41 : 0;
    const double slip = std::hypot(wind - s.u, s.w);
    return State{s.u, s.w, drag * slip * (wind - s.u), -drag * slip * s.w - p.gravity};
  };
  const auto moved = [](const State& s, const State& r, double t) {
    return State{s.x + r.x * t, s.z + r.z * t, s.u + r.u * t, s.w + r.w * t};
  };
  constexpr double t = 2e-5;
  State s{0, 0, forward, up};
  for (;;) {
    const State a = rate(s), b = rate(moved(s, a, t / 2)), c = rate(moved(s, b, t / 2)),
                e = rate(moved(s, c, t));
    const State mean{(a.x + 2 * b.x + 2 * c.x + e.x) / 6, (a.z + 2 * b.z + 2 * c.z + e.z) / 6,
                     (a.u + 2 * b.u + 2 * c.u + e.u) / 6, (a.w + 2 * b.w + 2 * c.w + e.w) / 6};
    const State next = moved(s, mean, t);
    if (next.z < 0) return s.x + (next.x - s.x) * s.z / (s.z - next.z);
    s = next;
  }
}

TEST(ParticleFlights, AreAsLongAsThoseOfAnIndependentIntegration) {
  for (float speed : {8.0f, 12.0f, 16.0f})
    for (float lift : {0.8f, 1.4f, 2.0f})
      for (float forward_over_up : {0.0f, 1.0f, 2.6f}) {
        const ParticleParameters p;
        const Wind wind(p, {speed, 0});
        const float up = lift * wind.shear_velocity;
        const double expected =
            independent_hop(p, static_cast<double>(wind.shear_velocity), static_cast<double>(up),
                            static_cast<double>(up * forward_over_up));
        const float found = level_run(p, wind.air, up, up * forward_over_up).first_hop;
        EXPECT_NEAR(static_cast<double>(found), expected, 0.06 * expected)
            << speed << " m/s, lift " << lift << ", forward " << forward_over_up;
      }
}

TEST(ParticleFlights, AreParabolasWithoutAir) {
  ParticleParameters p;
  p.air_density = 0.001f;
  const Wind wind(p, {10, 0});
  const float found = level_run(p, wind.air, 0.4f, 0.3f).first_hop;
  EXPECT_NEAR(found, 2 * 0.4f * 0.3f / p.gravity, 2e-4f);
}

/// Each bounce leaves the share e_n of the speed into the ground, which drag makes no greater than that of
/// the start.
TEST(ParticleFlights, EndAfterAsManyBouncesAsTheRestitutionAllows) {
  for (float speed : {7.0f, 10.0f, 20.0f, 40.0f})
    for (float restitution : {0.3f, 0.5f, 0.8f}) {
      ParticleParameters p;
      p.normal_restitution = restitution;
      p.tangential_restitution = 1.0f;
      p.most_bounces = 100;
      const Wind wind(p, {speed, 0});
      const float up = 2 * wind.shear_velocity;
      const double bound = std::log(up / least_rise(p)) / -std::log(restitution);
      const LevelRun run = level_run(p, wind.air, up, 0);
      EXPECT_LE(run.bounces, bound) << speed << " m/s, e_n " << restitution;
      EXPECT_GE(run.bounces, 1) << "nothing bounced at " << speed << " m/s";
      p.most_bounces = 1;
      EXPECT_EQ(level_run(p, wind.air, up, 0).bounces, 1);
    }
}

TEST(ParticleFlights, ShelterRaisesThePlaneOfZeroWind) {
  const Wind wind(ParticleParameters{}, {10, 0});
  const float open = wind.air.speed(0.004f, 0);
  EXPECT_GT(open, 1);
  EXPECT_EQ(wind.air.speed(0.010f, 0.006f), open);
  EXPECT_EQ(wind.air.speed(0.006f, 0.006f), 0);
  EXPECT_EQ(wind.air.speed(0.003f, 0.006f), 0);
}

TEST(ParticleFlights, CarryNothingBelowTheThreshold) {
  EXPECT_EQ(Wind(ParticleParameters{}, {6, 0}).lift_rate, 0);
  EXPECT_GT(Wind(ParticleParameters{}, {7, 0}).lift_rate, 0);
}

/// A flight over a terrain that is shifted by whole cells over its periodic edges is the same to the bit.
TEST(ParticleFlights, AreShiftedWithTheTerrain) {
  Grid grid;
  grid.width = 40;
  grid.height = 24;
  grid.cell_size = 0.01f;
  const wind::Vector above{9, 4};
  const wind::Downwind order(grid, above);
  const Wind wind(ParticleParameters{}, above);
  const auto landing = [&](int shift_x, int shift_y) {
    std::vector<Column> columns(static_cast<std::size_t>(grid.cells()));
    for (int y = 0; y < grid.height; ++y)
      for (int x = 0; x < grid.width; ++x) {
        const Quanta surface = 2000 * ((7 * x + 5 * y) % 11);
        columns[static_cast<std::size_t>(
            order.slot(wrap(x + shift_x, grid.width), wrap(y + shift_y, grid.height)))] = {
            surface, surface + 500 * (x % 3), surface - 300 * (y % 2)};
      }
    const int x = wrap(30 + shift_x, grid.width), y = wrap(20 + shift_y, grid.height);
    const float quantum = 1.0f / 1048576;
    const Bed bed{order,   columns.data(),
                  quantum, 0.01f,
                  100,     x,
                  y,       0.3f,
                  -0.2f,   columns[static_cast<std::size_t>(order.slot(x, y))].surface};
    Grain g{0, 0, bed.at(0, 0).height, 0.3f, 0.1f, 0.5f};
    hop(bed, wind.air, 0.5f, g, [](float, float) {});
    EXPECT_GT(g.x, 0.03f) << "too short a flight to cross an edge";
    return g;
  };
  const Grain here = landing(0, 0), there = landing(13, 7);
  EXPECT_EQ(std::memcmp(&here, &there, sizeof here), 0);
}

class Particles : public test::OnBackend {
 protected:
  /// 64 × 48 cells of a centimetre; sand over rock, an obstacle of 8 × 8 cells.
  static std::string world(const std::string& boundary, const std::string& more) {
    return "grid: {width: 64, height: 48, cell_size: 0.01, boundary: " + boundary +
           "}\nterrain: [noise: {layer: bedrock, low: 0, high: 0.01, scale: 0.1},\n"
           "  noise: {layer: sand, low: 0, high: 0.01, scale: 0.06, threshold: 0.3},\n"
           "  obstacle: {shape: box, x: 0.32, y: 0.24, size_x: 0.08, size_y: 0.08, height: 0.05}]\n"
           "sand: {model: wang}\nrun: {time_step: 4}\n" +
           more;
  }
};

TEST_P(Particles, LoseAndMakeNoSand) {
  for (const char* boundary : {"periodic", "open"})
    for (int degrees : {0, 37, 90, 200, 315}) {
      SCOPED_TRACE(testing::Message() << boundary << ", " << degrees << " degrees");
      auto s = simulation(world(boundary, "wind: {speed: 12, direction_deg: " + std::to_string(degrees) +
                                              "}\nsaltation: {influx: 2.0e-6}\n"));
      const std::vector<Quanta> before = test::quanta(*s, Layer::sand);
      test::run(*s, 6);
      test::expect_sound(*s, "after six steps");
      EXPECT_NE(before, test::quanta(*s, Layer::sand));
      const auto sand = s->state().balance()[static_cast<std::size_t>(Material::sand)];
      const bool open = boundary == std::string("open");
      EXPECT_EQ(sand.in > 0, open);
      EXPECT_EQ(sand.out > 0, open);
    }
}

TEST_P(Particles, LeaveObstaclesBare) {
  auto s = simulation(world("periodic", "wind: {speed: 12}\n"));
  const std::vector<Quanta> before = test::quanta(*s, Layer::sand);
  const std::vector<float> obstacle = test::real(*s, Layer::obstacle);
  test::run(*s, 8);
  const std::vector<Quanta> after = test::quanta(*s, Layer::sand);
  int cells = 0;
  for (std::size_t i = 0; i < after.size(); ++i)
    if (obstacle[i] > 0) {
      ++cells;
      EXPECT_EQ(after[i], before[i]) << "cell " << i;
    }
  EXPECT_GE(cells, 49);
}

TEST_P(Particles, StayInAWindBelowTheThreshold) {
  const std::string level =
      "grid: {width: 32, height: 32, cell_size: 0.01}\n"
      "terrain: [noise: {layer: sand, low: 0.02, high: 0.021}]\nsand: {model: wang}\n";
  for (const auto& [speed, moves] : {std::pair{"0", false}, {"6", false}, {"8", true}}) {
    auto s = simulation(level + "wind: {speed: " + speed + "}\n");
    const std::vector<Quanta> before = test::quanta(*s, Layer::sand);
    test::run(*s, 3);
    EXPECT_EQ(before != test::quanta(*s, Layer::sand), moves) << speed << " m/s";
  }
}

/// Behind a step of rock of 1 cm: the shelter is higher than ten grains there, and lower than a hundred.
TEST_P(Particles, ShelterHoldsSandByTheWindAtItsHeight) {
  for (const auto& [height, held] : {std::pair{"10", true}, {"100", false}}) {
    auto s = simulation(
        "grid: {width: 48, height: 8, cell_size: 0.01, boundary: open}\n"
        "terrain: [uniform: {layer: sand, value: 0.005}, column: {layer: bedrock, x: 0.1, y: 0.04, size_x: "
        "0.1, size_y: 1, height: 0.01}]\n"
        "wind: {speed: 14}\navalanching: {enabled: false}\nsand: {model: wang}\n"
        "particle: {splash_number: 0, shear_height: " +
        std::string(height) + "}\n");
    const std::vector<Quanta> before = test::quanta(*s, Layer::sand);
    test::run(*s, 4);
    const std::vector<Quanta> after = test::quanta(*s, Layer::sand);
    int lost = 0;
    for (std::size_t y = 0; y < 8; ++y)
      for (std::size_t x = 16; x < 18; ++x) lost += after[48 * y + x] < before[48 * y + x];
    EXPECT_EQ(lost == 0, held) << height;
  }
}

DESERT_ON_EACH_BACKEND(Particles);

}  // namespace
}  // namespace desert_sim::particles
