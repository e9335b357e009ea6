// Slope, normal, roughness, steps and traversability, by hand.

#include <cmath>
#include <cstring>

#include "kernels/rover/wheel_ground.hpp"
#include "test/support/bench_terrain.hpp"
#include "test/support/cases.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using test::BenchTerrain;

constexpr double degree = 3.14159265358979 / 180;
const std::vector<Layer> judged{Layer::slope,          Layer::normal_x,  Layer::normal_y,
                                Layer::normal_z,       Layer::roughness, Layer::step_height,
                                Layer::traversability, Layer::slip,      Layer::slip_downhill,
                                Layer::slip_across,    Layer::sinkage};

class TraversabilityLaw : public test::OnBackend {
 protected:
  using Height = std::function<double(int, int)>;

  /// Bare rock of these heights on a firm open grid.
  std::unique_ptr<BenchTerrain> rock(int width, int height, double cell, const Height& h,
                                     const TraversabilityParameters& p = {}, bool periodic = false,
                                     const std::function<void(BenchTerrain&)>& more = {}) {
    auto t = std::make_unique<BenchTerrain>(exec(), width, height, cell, periodic);
    t->set(Layer::bedrock, h);
    if (more) more(*t);
    t->surface();
    t->judge(p);
    return t;
  }
  static double worth(const BenchTerrain& t, int x, int y) { return t.at(Layer::traversability, x, y); }
  /// Of flat ground with something on it, in its middle.
  double worth_with(const std::function<void(BenchTerrain&)>& more, const TraversabilityParameters& p = {}) {
    return worth(*rock(
                     5, 5, 1, [](int, int) { return 7; }, p, false, more),
                 2, 2);
  }
};

TEST_P(TraversabilityLaw, APlaneHasItsSlopeUpToOpenEdgesAndIsSmooth) {
  const auto t = rock(9, 7, 2, [](int x, int y) { return 0.3 * x - 0.2 * y; });
  const double gx = 0.15, gy = -0.1, length = std::sqrt(1 + gx * gx + gy * gy);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 9; ++x) {
      EXPECT_NEAR(t->at(Layer::slope, x, y), std::atan(std::hypot(gx, gy)), 2e-6);
      EXPECT_NEAR(t->at(Layer::normal_x, x, y), -gx / length, 2e-6);
      EXPECT_NEAR(t->at(Layer::normal_y, x, y), -gy / length, 2e-6);
      EXPECT_NEAR(t->at(Layer::normal_z, x, y), 1 / length, 2e-6);
      EXPECT_NEAR(t->at(Layer::roughness, x, y), 0, 3e-6);
      EXPECT_NEAR(t->at(Layer::step_height, x, y), 0, 3e-6);
      EXPECT_NEAR(worth(*t, x, y), 1 - std::atan(std::hypot(gx, gy)) / (25 * degree), 2e-5);
    }
}

TEST_P(TraversabilityLaw, DifferencesReachOverAPeriodicEdge) {
  const auto t = rock(
      8, 3, 1, [](int x, int) { return x; }, {}, true);
  EXPECT_NEAR(t->at(Layer::slope, 0, 1), std::atan(3.0), 1e-5);  // (1 − 7)/2
  EXPECT_NEAR(t->at(Layer::normal_x, 0, 1), 3 / std::sqrt(10.0), 1e-6);
  EXPECT_NEAR(t->at(Layer::slope, 3, 1), std::atan(1.0), 1e-6);
  EXPECT_NEAR(t->at(Layer::step_height, 7, 1), 7, 1e-5);
}

TEST_P(TraversabilityLaw, AGridOfOneCellIsFlat) {
  for (bool periodic : {false, true}) {
    const auto t = rock(
        1, 1, 1, [](int, int) { return 9; }, {}, periodic);
    EXPECT_EQ(t->at(Layer::slope, 0, 0), 0);
    EXPECT_EQ(t->at(Layer::normal_z, 0, 0), 1);
    EXPECT_EQ(t->at(Layer::roughness, 0, 0), 0);
    EXPECT_EQ(worth(*t, 0, 0), 1);
  }
}

TEST_P(TraversabilityLaw, AStepCountsInFullOnBothSides) {
  const auto t = rock(8, 5, 1, [](int x, int) { return x >= 4 ? 0.6 : 0; });
  EXPECT_NEAR(t->at(Layer::slope, 3, 2), std::atan(0.3), 1e-6);
  for (int x : {3, 4}) {
    EXPECT_NEAR(t->at(Layer::step_height, x, 2), 0.6, 1e-5) << x;
    EXPECT_EQ(worth(*t, x, 2), 0) << x;
  }
  for (int x : {1, 2, 5, 6}) {
    EXPECT_EQ(t->at(Layer::step_height, x, 2), 0) << x;
    EXPECT_EQ(worth(*t, x, 2), 1) << x;
  }
  TraversabilityParameters wide;
  wide.window = 2.9f;  // two cells, but from two cells away it is a slope of 17 degrees
  EXPECT_EQ(rock(
                8, 5, 1, [](int x, int) { return x >= 4 ? 0.6 : 0; }, wide)
                ->at(Layer::step_height, 2, 2),
            0);
  EXPECT_NEAR(rock(
                  8, 5, 1, [](int x, int) { return x >= 4 ? 2 : 0; }, wide)
                  ->at(Layer::step_height, 2, 2),
              2, 1e-5);
}

/// The slope beside a step is the flatter difference, and does not count: up or down, along x or y.
TEST_P(TraversabilityLaw, AStepOnASlopeIsAsHighAsOnFlatGround) {
  for (const double sign : {1.0, -1.0}) {
    const auto along = [=](int n) { return sign * (0.1 * n + (n >= 4 ? 0.6 : 0)); };
    const auto in_x = rock(8, 5, 1, [&](int x, int) { return along(x); }),
               in_y = rock(5, 8, 1, [&](int, int y) { return along(y); });
    for (int n = 1; n < 7; ++n) {
      const double step = n == 3 || n == 4 ? 0.6 : 0;
      EXPECT_NEAR(in_x->at(Layer::step_height, n, 2), step, 1e-5) << sign << ", x = " << n;
      EXPECT_NEAR(in_y->at(Layer::step_height, 2, n), step, 1e-5) << sign << ", y = " << n;
    }
  }
}

TEST_P(TraversabilityLaw, ABreakOfASlopeThatARoverDrivesIsNoStep) {
  const double tangent = std::tan(20 * degree);
  const auto t = rock(9, 3, 10, [&](int x, int) { return 10 * tangent * (x < 4 ? x : 8 - x); });
  EXPECT_EQ(t->at(Layer::step_height, 4, 1), 0);
  EXPECT_NEAR(t->at(Layer::slope, 2, 1), 20 * degree, 1e-5);
}

// One cell of nine is 1 m high. On it: variance 1/9 − 1/81; beside it the plane takes 1/6 of the squares.
TEST_P(TraversabilityLaw, ASingleRock) {
  const auto t = rock(7, 7, 1, [](int x, int y) { return x == 3 && y == 3 ? 1 : 0; });
  EXPECT_NEAR(t->at(Layer::roughness, 3, 3), std::sqrt(8.0) / 9, 2e-6);
  EXPECT_NEAR(t->at(Layer::roughness, 2, 3), std::sqrt((1 - 1.0 / 9 - 1.0 / 6) / 9), 2e-6);
  EXPECT_NEAR(t->at(Layer::roughness, 3, 4), std::sqrt((1 - 1.0 / 9 - 1.0 / 6) / 9), 2e-6);
  EXPECT_NEAR(t->at(Layer::roughness, 4, 4), std::sqrt((1 - 1.0 / 9 - 1.0 / 3) / 9), 2e-6);
  EXPECT_EQ(t->at(Layer::roughness, 1, 3), 0);
  EXPECT_EQ(t->at(Layer::slope, 3, 3), 0);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 7; ++x)
      EXPECT_NEAR(t->at(Layer::step_height, x, y), std::abs(x - 3) <= 1 && std::abs(y - 3) <= 1 ? 1 : 0, 1e-5)
          << x << ", " << y;
}

// Three cells on a line, the middle one 1 m high: squares 1 less the mean's 1/3.
TEST_P(TraversabilityLaw, RoughnessAtAnOpenEdgeTakesWhatThereIs) {
  const auto t = rock(4, 1, 1, [](int x, int) { return x == 1 ? 1 : 0; });
  EXPECT_NEAR(t->at(Layer::roughness, 0, 0), 0, 1e-6);  // two cells lie on a line
  EXPECT_NEAR(t->at(Layer::roughness, 1, 0), std::sqrt((1 - 1.0 / 3) / 3), 2e-6);
}

TEST_P(TraversabilityLaw, ACliffBeyondTheSumsIsStillRough) {
  const auto t = rock(4, 4, 1, [](int x, int) { return x > 1 ? 400 : 0; });
  EXPECT_GT(t->at(Layer::roughness, 1, 1), 10);
  EXPECT_NEAR(t->at(Layer::step_height, 1, 1), 400, 1e-3);
}

TEST_P(TraversabilityLaw, EachCriterionAlone) {
  const auto put = [](Layer layer, double value) { return [=](BenchTerrain& t) { t.set(layer, value); }; };
  EXPECT_EQ(worth_with({}), 1);
  EXPECT_NEAR(worth_with(put(Layer::sand, 5)), 0.8, 1e-6);
  EXPECT_NEAR(worth_with(put(Layer::sand, 0.15)), 0.9, 1e-5);
  EXPECT_NEAR(worth_with(put(Layer::water, 0.15)), 0.5, 1e-5);
  EXPECT_EQ(worth_with(put(Layer::water, 0.31)), 0);
  const auto stream = [](double depth, double east, double north) {
    return [=](BenchTerrain& t) {
      t.terrain.allocate(Layer::water_velocity_x);
      t.terrain.allocate(Layer::water_velocity_y);
      t.set(Layer::water, depth).set(Layer::water_velocity_x, east).set(Layer::water_velocity_y, north);
    };
  };
  EXPECT_NEAR(worth_with(stream(0.1, 0.6, -0.8)), 0.5, 1e-5);  // 0.1 of 0.2 m²/s
  EXPECT_NEAR(worth_with(stream(0.15, 0.1, 0)), 0.5, 1e-5) << "its depth is worse than its speed";
  EXPECT_EQ(worth_with(stream(0.1, -1.3, 1.6)), 0);
  EXPECT_EQ(worth_with(stream(0, 5, 5)), 1) << "where there is no water, nothing flows";
  const auto wet = [](double moisture) {
    return [=](BenchTerrain& t) { t.set(Layer::sand, 5).set(Layer::moisture, moisture); };
  };
  EXPECT_NEAR(worth_with(wet(0.15)), 0.8, 1e-5);  // half of what it can hold: firm
  EXPECT_NEAR(worth_with(wet(0.21)), 0.5, 1e-4);
  EXPECT_EQ(worth_with(wet(0.29)), 0);  // mud
  EXPECT_NEAR(worth_with(put(Layer::vegetation, 0.4)), 0.5, 1e-6);
  EXPECT_EQ(worth_with(put(Layer::vegetation, 0.9)), 0);
  EXPECT_EQ(worth_with([](BenchTerrain& t) {
              t.set(Layer::obstacle, [](int x, int y) { return x == 2 && y == 2 ? 1 : 0; });
            }),
            0);
}

TEST_P(TraversabilityLaw, LooseSandStopsARoverOnSlopesThatFirmGroundDoesNot) {
  const auto incline = [&](double deg, double sand) {
    return worth(*rock(
                     5, 5, 1, [=](int x, int) { return x * std::tan(deg * degree); }, {}, false,
                     [=](BenchTerrain& t) { t.set(Layer::sand, sand); }),
                 2, 2);
  };
  EXPECT_NEAR(incline(12.5, 0), 0.5, 1e-4);
  EXPECT_NEAR(incline(8, 3), 0.5, 1e-4);
  EXPECT_NEAR(incline(20, 0), 0.2, 1e-4);
  EXPECT_EQ(incline(20, 3), 0);
  EXPECT_EQ(incline(26, 0), 0);
}

/// On a plane all wheels stand alike: the layers are the laws of wheel_ground.hpp.
TEST_P(TraversabilityLaw, SlipAndSinkageOfAPlaneAreThoseOfItsSlopeAndGround) {
  const wheels::WheelGround law =
      wheels::make_wheel_ground(TraversabilityParameters{}, WheelGroundParameters{});
  const auto expect = [&](double deg, const BenchTerrain& t, const wheels::Ground& g) {
    const float slope = static_cast<float>(deg * degree), slip = law.longitudinal_slip(slope, 0.1f, g);
    EXPECT_NEAR(t.at(Layer::slip, 2, 2), slip, 1e-4);
    EXPECT_NEAR(t.at(Layer::slip_downhill, 2, 2), law.longitudinal_slip(-slope, 0.1f, g), 1e-4);
    EXPECT_NEAR(t.at(Layer::slip_across, 2, 2), law.lateral_slip(slope, g), 1e-4);
    EXPECT_NEAR(t.at(Layer::sinkage, 2, 2), law.sinkage(slip, 1, g), 1e-5);
    return slip;
  };
  for (const double deg : {0.0, 6.0, 12.0}) {
    SCOPED_TRACE(deg);
    const auto plane = [&](const std::function<void(BenchTerrain&)>& more) {
      return rock(
          5, 5, 0.3, [=](int x, int) { return 0.3 * x * std::tan(deg * degree); }, {}, false,
          [&](BenchTerrain& t) {
            t.set(Layer::sand, 1);
            more(t);
          });
    };
    expect(deg, *plane([](BenchTerrain&) {}), {0.3f, 1, 0});  // as loose as is assumed
    for (const double looseness : {0.0, 0.4}) {
      const auto t =
          plane([&](BenchTerrain& b) { b.set(Layer::looseness, looseness).set(Layer::moisture, 0.03); });
      const float slip = expect(deg, *t, {static_cast<float>(looseness), 1, 0.1f});
      const double going = std::max({deg / 25, slip / 0.4, t->at(Layer::sinkage, 2, 2) / (0.6 * 0.15)});
      EXPECT_NEAR(worth(*t, 2, 2), std::max(1 - going, 0.0), 1e-3);
    }
  }
}

/// Half a wheelbase of 3 cells ahead and behind: of ripples of 6 cells the three axles climb +, −, + by a
/// third in all, of ridges of 24 cells they climb together.
TEST_P(TraversabilityLaw, RipplesShorterThanTheRoverCountLess) {
  TraversabilityParameters p;
  p.wheelbase = 6;
  const auto slip_on = [&](double wavelength) {
    const auto t = rock(
        48, 9, 1, [=](int x, int) { return 0.1 * std::abs(std::remainder(x, wavelength)); }, p, true,
        [](BenchTerrain& b) { b.set(Layer::sand, 1).set(Layer::looseness, 0.2); });
    double worst = 0;
    for (int x = 0; x < 48; ++x) worst = std::max(worst, t->at(Layer::slip, x, 4));
    return worst;
  };
  const wheels::WheelGround law = wheels::make_wheel_ground(p, {});
  const auto at = [&](double tangent) {
    return law.longitudinal_slip(static_cast<float>(std::atan(tangent)), 0.1f, {0.2f, 1, 0});
  };
  EXPECT_NEAR(slip_on(6), at(0.1 / 3), 1e-4);
  EXPECT_NEAR(slip_on(24), at(0.1), 1e-4);
}

TEST_P(TraversabilityLaw, GroundIsTheMeanUnderTheRover) {
  TraversabilityParameters p;
  p.wheelbase = 4;  // two cells along x and y, one along the diagonals
  const auto slip_with = [&](const std::function<double(int, int)>& looseness) {
    return rock(
               9, 9, 1, [](int, int) { return 0; }, p, false,
               [&](BenchTerrain& b) { b.set(Layer::sand, 1).set(Layer::looseness, looseness); })
        ->at(Layer::slip, 4, 4);
  };
  const double mean = slip_with([](int, int) { return 1.0 / 3; });
  EXPECT_NEAR(slip_with([](int x, int y) { return x == y && x >= 3 && x <= 5 ? 1 : 0; }), mean, 1e-5);
  EXPECT_NEAR(slip_with([](int x, int y) { return y == 4 && (x == 2 || x == 4 || x == 6) ? 1 : 0; }), mean,
              1e-5);
  EXPECT_EQ(slip_with([](int x, int y) { return x == 3 && y == 4 ? 1 : 0; }),
            slip_with([](int, int) { return 0; }))
      << "no wheel stands there";
}

TEST_P(TraversabilityLaw, WithLoosenessFirmSandIsFreeAndSlopeIsTheLimitOfTipping) {
  const auto incline = [&](double deg, double looseness) {
    return worth(*rock(
                     5, 5, 1, [=](int x, int) { return x * std::tan(deg * degree); }, {}, false,
                     [=](BenchTerrain& t) { t.set(Layer::sand, 3).set(Layer::looseness, looseness); }),
                 2, 2);
  };
  EXPECT_GT(incline(16, 0), 0.1) << "is lethal by sand_slope_deg where nobody knows how firm it is";
  EXPECT_GT(incline(0, 0), 0.75);
  EXPECT_EQ(incline(12, 1), 0);
  EXPECT_EQ(incline(26, 0), 0);
}

TEST_P(TraversabilityLaw, ArctangentIsGoodToAMillionth) {
  for (double degrees : {0.001, 0.1, 5.0, 30.0, 45.0, 60.0, 80.0, 89.0, 89.99}) {
    const double found = arctangent(static_cast<float>(std::tan(degrees * degree)));
    EXPECT_NEAR(found / (degrees * degree), 1, 1e-6) << degrees;
  }
  EXPECT_EQ(arctangent(0), 0);
}

/// Where (x, y) goes on an n × n grid, and what becomes of a normal's parts.
struct Motion {
  const char* name;
  std::function<std::pair<int, int>(int, int)> move;
  std::function<std::pair<float, float>(float, float)> turn;
};

TEST_P(TraversabilityLaw, MovesWithTheTerrainToTheBit) {
  constexpr int n = 24;
  const Motion motions[] = {
      {"mirrored in x",
       [](int x, int y) {
         return std::pair{n - 1 - x, y};
       },
       [](float a, float b) {
         return std::pair{-a, b};
       }},
      {"transposed",
       [](int x, int y) {
         return std::pair{y, x};
       },
       [](float a, float b) {
         return std::pair{b, a};
       }},
      {"turned by 90 degrees",
       [](int x, int y) {
         return std::pair{n - 1 - y, x};
       },
       [](float a, float b) {
         return std::pair{-b, a};
       }},
      {"shifted",
       [](int x, int y) {
         return std::pair{(x + 5) % n, (y + 11) % n};
       },
       [](float a, float b) {
         return std::pair{a, b};
       }},
  };
  const auto height = [](int x, int y) {
    return static_cast<Quanta>(900000 * std::sin(0.7 * x + 1.3 * std::cos(0.5 * y)) +
                               (x * 7919 + y * 104729) % 99991);
  };
  const auto sand = [](int x, int y) { return static_cast<Quanta>((x * 31 + y * 17) % 13 * 40000); };
  TraversabilityParameters p;
  p.window = 3;
  p.wheelbase = 5;
  for (const Motion& m : motions)
    for (bool periodic : {true, false}) {
      if (!periodic && std::string(m.name) == "shifted") continue;
      SCOPED_TRACE(std::string(m.name) + (periodic ? ", periodic" : ", open"));
      BenchTerrain plain(exec(), n, n, 1, periodic), moved(exec(), n, n, 1, periodic);
      for (const auto& [layer, f] :
           {std::pair<Layer, std::function<Quanta(int, int)>>{Layer::bedrock, height}, {Layer::sand, sand}}) {
        std::vector<Quanta> there(n * n);
        for (int y = 0; y < n; ++y)
          for (int x = 0; x < n; ++x) {
            const auto [u, v] = m.move(x, y);
            there[static_cast<std::size_t>(v * n + u)] = f(x, y);
          }
        plain.set_quanta(layer, f);
        moved.set_quanta(layer, [&](int x, int y) { return there[static_cast<std::size_t>(y * n + x)]; });
      }
      for (BenchTerrain* t : {&plain, &moved}) {
        t->surface();
        t->judge(p);
      }
      for (Layer layer : judged) {
        const auto a = plain.terrain.values(layer), b = moved.terrain.values(layer);
        const auto nx = plain.terrain.values(Layer::normal_x), ny = plain.terrain.values(Layer::normal_y);
        int different = 0;
        for (int y = 0; y < n; ++y)
          for (int x = 0; x < n; ++x) {
            const auto i = static_cast<std::size_t>(y * n + x);
            const auto [u, v] = m.move(x, y);
            const auto turned = m.turn(nx[i], ny[i]);
            const float expected =
                layer == Layer::normal_x ? turned.first : (layer == Layer::normal_y ? turned.second : a[i]);
            different += expected != b[static_cast<std::size_t>(v * n + u)];
          }
        EXPECT_EQ(different, 0) << info(layer).name;
      }
    }
}

TEST_P(TraversabilityLaw, IsComputedOnlyForWhoAsksAndIsNoPartOfTheState) {
  auto s = simulation(test::grid_yaml(20, 12, "open") +
                      "terrain: [noise: {layer: sand, low: 0, high: 4, scale: 6}]\nwind: {speed: 5}\n");
  s->step();
  const std::uint64_t hash = s->state().hash();
  s->views().snapshot({Layer::elevation});
  for (Layer layer : judged) EXPECT_FALSE(s->terrain().has(layer)) << info(layer).name;
  const auto one = s->views().snapshot({Layer::traversability});
  EXPECT_FALSE(s->terrain().has(Layer::slope));
  const auto all = s->views().snapshot(judged);
  EXPECT_EQ(one->layers.at(Layer::traversability), all->layers.at(Layer::traversability));
  EXPECT_EQ(s->state().hash(), hash);
  s->step();
  EXPECT_NE(s->views().snapshot(judged)->layers.at(Layer::slope), all->layers.at(Layer::slope))
      << "of the new state";
}

/// A band of rows has what these rows of the whole have, over periodic edges too, and less what is off open
/// ones.
TEST_P(TraversabilityLaw, ABandOfRowsIsThatOfTheWhole) {
  for (const char* boundary : {"periodic", "open"}) {
    const std::string yaml = test::grid_yaml(20, 12, boundary) +
                             "terrain: [noise: {layer: sand, low: 0, high: 4, scale: 6}]\nwind: {speed: 5}\n";
    auto s = simulation(yaml);
    std::vector<Layer> layers = judged;
    layers.insert(layers.end(), {Layer::elevation, Layer::sand, Layer::wind_x});
    const auto all = s->views().snapshot(layers);
    const bool periodic = all->periodic_y;
    for (const RowBand band :
         {RowBand{0, 12}, {3, 4}, {11, 1}, {-3, 7}, {9, 6}, {-40, 5}, {50, 3}, {-5, 90}}) {
      SCOPED_TRACE(std::string(boundary) + ", " + std::to_string(band.count) + " rows from " +
                   std::to_string(band.first));
      const auto part = s->views().snapshot(layers, band);
      const int first = static_cast<int>(std::lround(part->origin_y - all->origin_y));
      const int wanted = std::min(band.first + band.count, 12) - std::max(band.first, 0);
      if (periodic) {
        ASSERT_EQ(part->height, std::min(band.count, 12));
      } else {
        ASSERT_EQ(part->height, std::max(1, wanted));
        ASSERT_TRUE(first >= 0 && first + part->height <= 12);
      }
      if (band.count < 12 && (periodic || wanted == band.count)) {
        EXPECT_EQ(first, band.first);
      }
      for (Layer layer : layers) {
        const auto &a = all->layers.at(layer), &b = part->layers.at(layer);
        ASSERT_EQ(b.size(), 20u * static_cast<std::size_t>(part->height));
        for (int y = 0; y < part->height; ++y)
          for (int x = 0; x < 20; ++x)
            ASSERT_EQ(b[static_cast<std::size_t>(y * 20 + x)],
                      a[static_cast<std::size_t>(wrap(first + y, 12) * 20 + x)])
                << info(layer).name << " " << x << ", " << y;
      }
    }
  }
}

TEST_P(TraversabilityLaw, OfABandOnlyTheRowsAreComputed) {
  auto s = simulation(test::grid_yaml(20, 12, "open") +
                      "terrain: [noise: {layer: sand, low: 0, high: 4, scale: 6}]\nwind: {speed: 5}\n");
  s->views().snapshot({Layer::slope}, {3, 2});
  const std::vector<float> slope = s->terrain().values(Layer::slope);
  for (int i = 0; i < 20 * 12; ++i) {
    const bool computed = i >= 3 * 20 && i < 5 * 20;
    EXPECT_EQ(slope[static_cast<std::size_t>(i)] > 0, computed) << i % 20 << ", " << i / 20;
  }
}

DESERT_ON_EACH_BACKEND(TraversabilityLaw);

}  // namespace
}  // namespace desert_sim
