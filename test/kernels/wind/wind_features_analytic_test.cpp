// Features of the wind: their speed, sense and life time, smooth on the torus.

#include "test/kernels/wind/wind_field.hpp"

namespace desert_sim {
namespace {

struct Perturbation {
  Grid grid;
  std::vector<float> u, v;

  Perturbation(Exec& exec, const Grid& of, const std::vector<WindFeature>& features, double time = 0)
      : grid(of) {
    std::vector<wind_features::Prepared> prepared;
    for (const WindFeature& f : features)
      prepared.push_back(
          wind_features::prepare(f, unit_vector(f.direction_deg), grid, origin_x, origin_y, time));
    const auto cells = static_cast<std::size_t>(grid.cells());
    Buffer<wind_features::Prepared> buffer(exec, prepared.size());
    buffer.upload(prepared);
    Buffer<float> stream(exec, cells), px(exec, cells), py(exec, cells);
    with_backend(exec,
                 [&](auto& e) { wind_features::step(e, grid, buffer, stream.data(), px.data(), py.data()); });
    u = px.download();
    v = py.download();
  }
  static constexpr double origin_x = 420000, origin_y = 5280000;  // UTM

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>((y + grid.height) % grid.height * grid.width +
                                    (x + grid.width) % grid.width);
  }
  wind::Vector at(int x, int y) const { return {u[index(x, y)], v[index(x, y)]}; }
  double fastest() const {
    double most = 0;
    for (std::size_t n = 0; n < u.size(); ++n) most = std::max(most, std::hypot<double>(u[n], v[n]));
    return most;
  }
  /// The greatest change from one cell to the next; over the seam of a periodic grid, too.
  double greatest_step() const {
    double worst = 0;
    const int last = grid.periodic_x ? 0 : 1;
    for (int y = 0; y < grid.height - last; ++y)
      for (int x = 0; x < grid.width - last; ++x)
        for (const wind::Vector next : {at(x + 1, y), at(x, y + 1)})
          worst = std::max(worst, std::hypot<double>(next.x - at(x, y).x, next.y - at(x, y).y));
    return worst;
  }
  /// Central differences; an open grid is searched two cells from its edge and beyond.
  double greatest_divergence() const {
    double worst = 0;
    const int margin = grid.periodic_x ? 0 : 2;
    for (int y = margin; y < grid.height - margin; ++y)
      for (int x = margin; x < grid.width - margin; ++x)
        worst = std::max(worst, std::abs(static_cast<double>(at(x + 1, y).x) - at(x - 1, y).x +
                                         at(x, y + 1).y - at(x, y - 1).y));
    return worst;
  }
};

WindFeature feature(WindFeatureKind kind, double x, double y, float radius, float speed) {
  WindFeature f;
  f.kind = kind;
  f.x = Perturbation::origin_x + x;
  f.y = Perturbation::origin_y + y;
  f.radius = radius;
  f.speed = speed;
  return f;
}

WindPathPoint path_point(double time, double x, double y) {
  return {time, Perturbation::origin_x + x, Perturbation::origin_y + y};
}

/// Near the seams of the torus, with radii up to its extent: the stream function of a jet jumped there, which
/// made 105 m/s of 3 m/s once its radius passed a sixth of the extent.
TEST_P(WindField, FeaturesAreSmoothAcrossTheSeamAtAnyRadius) {
  for (const bool periodic : {true, false})
    for (const WindFeatureKind kind :
         {WindFeatureKind::vortex, WindFeatureKind::jet, WindFeatureKind::turbulence, WindFeatureKind::sink})
      for (const float radius : {10.0f, 40.0f, 90.0f, 180.0f, 1e4f})
        for (const auto& [x, y] : {std::pair{90.0, 70.0}, {1.0, 139.0}, {179.0, 70.0}, {0.0, 0.0}}) {
          SCOPED_TRACE(std::string(wind_feature_kinds[static_cast<int>(kind)]) + " of radius " +
                       std::to_string(radius) + " at " + std::to_string(x) + ", " + std::to_string(y) +
                       (periodic ? "" : ", open"));
          WindFeature f = feature(kind, x, y, radius, 3);
          for (const float direction : {0.0f, 30.0f, 90.0f, 225.0f}) {
            f.direction_deg = direction;
            const Perturbation wind(exec(), Grid{90, 70, 2, periodic, periodic}, {f}, 12.5);
            EXPECT_LE(wind.fastest(), kind == WindFeatureKind::turbulence ? 4 * 3 : 1.01 * 3);
            if (kind != WindFeatureKind::sink)
              EXPECT_LE(wind.greatest_divergence(), radius > 1000 ? 3e-3 : 2e-4);
            else
              EXPECT_LE(wind.greatest_step(), 3 * 2 * 2.2 / std::min(radius, 140.0f)) << "it jumps";
          }
        }
}

TEST_P(WindField, VortexAndJetHaveTheirSpeedAndSense) {
  const Grid grid{200, 200, 1, true, true};
  const auto wind = [&](const WindFeature& f, int x, int y) {
    return Perturbation(exec(), grid, {f}).at(x, y);
  };
  WindFeature vortex = feature(WindFeatureKind::vortex, 100.5, 100.5, 30, 4);
  EXPECT_NEAR(wind(vortex, 130, 100).y, 4, 0.03);  // counter-clockwise: north on its east side
  EXPECT_NEAR(wind(vortex, 70, 100).y, -4, 0.03);
  EXPECT_NEAR(wind(vortex, 100, 130).x, -4, 0.03);
  EXPECT_NEAR(wind(vortex, 100, 100).x, 0, 1e-4);
  vortex.speed = -4;
  EXPECT_NEAR(wind(vortex, 130, 100).y, -4, 0.03);
  WindFeature jet = feature(WindFeatureKind::jet, 100.5, 100.5, 20, 6);
  jet.direction_deg = 90;
  jet.length = 60;
  EXPECT_NEAR(wind(jet, 100, 100).y, 6, 0.05);
  EXPECT_NEAR(wind(jet, 100, 100).x, 0, 1e-4);
  EXPECT_LT(wind(jet, 135, 100).y, 0) << "return flow beside it";
}

/// speed (r/R) exp(½ (1 − r²/R²)) towards the centre: fastest at the radius, calm in the centre and far away.
TEST_P(WindField, ASinkFlowsTowardsItsCentre) {
  for (const bool periodic : {false, true})
    for (const float speed : {5.0f, -5.0f}) {
      const Perturbation wind(exec(), Grid{201, 201, 1, periodic, periodic},
                              {feature(WindFeatureKind::sink, 100.5, 100.5, 20, speed)});
      for (const int away : {5, 20, 33}) {
        SCOPED_TRACE(std::to_string(speed) + " m/s, " + std::to_string(away) + " m away");
        const double ratio = away / 20.0, law = speed * ratio * std::exp(0.5 * (1 - ratio * ratio));
        const double slack = periodic ? 0.03 : 1e-5;  // on a torus a distance is almost one
        const auto expect = [&](int x, int y, double u, double v) {
          EXPECT_NEAR(wind.at(100 + x, 100 + y).x, u, slack);
          EXPECT_NEAR(wind.at(100 + x, 100 + y).y, v, slack);
        };
        expect(away, 0, -law, 0);
        expect(-away, 0, law, 0);
        expect(0, away, 0, -law);
        expect(0, -away, 0, law);
      }
      EXPECT_EQ(wind.at(100, 100).x, 0);
      EXPECT_EQ(wind.at(100, 100).y, 0);
      EXPECT_NEAR(wind.fastest(), 5, 0.03);
      EXPECT_LT(std::abs(wind.at(100 + 90, 100).x), 0.05);
    }
}

/// Bit for bit as a feature that stands where the moving one is at that time, over the seams of the torus,
/// too.
TEST_P(WindField, FeaturesComeGoAndMove) {
  const Grid grid{60, 50, 2, true, true};
  for (const WindFeatureKind kind :
       {WindFeatureKind::vortex, WindFeatureKind::jet, WindFeatureKind::turbulence, WindFeatureKind::sink}) {
    WindFeature moving = feature(kind, 20, 30, 12, 4);
    moving.begin = 10;
    moving.end = 60;
    moving.velocity_x = 3;
    moving.velocity_y = -1.5f;
    for (const double time : {0.0, 9.999, 60.0, 1e6})
      EXPECT_EQ(Perturbation(exec(), grid, {moving}, time).fastest(), 0) << time;
    for (const double time : {10.0, 10.5, 45.25, 59.999}) {
      SCOPED_TRACE(std::to_string(time) + " s, kind " + std::to_string(static_cast<int>(kind)));
      const WindFeature there =
          feature(kind, 20 + 3 * (time - 10), 30 - 1.5 * (time - 10), moving.radius, moving.speed);
      const Perturbation wind(exec(), grid, {moving}, time), expected(exec(), grid, {there}, time);
      EXPECT_EQ(wind.u, expected.u);
      EXPECT_EQ(wind.v, expected.v);
      EXPECT_GT(wind.fastest(), 0.5);
    }
  }
}

/// Bit for bit as the velocity that it stands for, and over the seams of the torus, too.
TEST_P(WindField, APathOfTwoPointsIsAVelocity) {
  const Grid grid{60, 50, 2, true, true};
  WindFeature moving = feature(WindFeatureKind::vortex, 20, 30, 12, 4), on_path = moving;
  moving.begin = on_path.begin = 10;
  moving.velocity_x = 3;
  moving.velocity_y = -1.5f;
  on_path.path = {path_point(10, 20, 30), path_point(90, 260, -90)};
  for (const double time : {10.0, 10.1, 33.3, 60.0, 89.99}) {
    SCOPED_TRACE(time);
    const Perturbation wind(exec(), grid, {on_path}, time), expected(exec(), grid, {moving}, time);
    EXPECT_EQ(wind.u, expected.u);
    EXPECT_EQ(wind.v, expected.v);
    EXPECT_GT(wind.fastest(), 0.5);
  }
}

/// It stands at the first point before the path begins and at the last when it is over, and turns in between.
TEST_P(WindField, APathGoesAroundItsCorners) {
  const Grid grid{60, 50, 2, false, false};
  WindFeature on_path = feature(WindFeatureKind::jet, 0, 0, 12, 4);
  on_path.path = {path_point(10, 20, 30), path_point(20, 60, 30), path_point(40, 60, 70)};
  struct Place {
    double time, x, y;
  };
  for (const Place& place : {Place{0, 20, 30}, Place{10, 20, 30}, Place{15, 40, 30}, Place{20, 60, 30},
                             Place{25, 60, 40}, Place{40, 60, 70}, Place{1e6, 60, 70}}) {
    SCOPED_TRACE(place.time);
    const WindFeature there = feature(WindFeatureKind::jet, place.x, place.y, on_path.radius, on_path.speed);
    const Perturbation wind(exec(), grid, {on_path}, place.time), expected(exec(), grid, {there}, place.time);
    EXPECT_EQ(wind.u, expected.u);
    EXPECT_EQ(wind.v, expected.v);
    EXPECT_GT(wind.fastest(), 0.5);
  }
}

/// The speed of turbulence is its root mean square in the middle, whenever that is, and it renews itself in a
/// life time: with the time in single precision it stood still from 1e9 s on.
TEST_P(WindField, TurbulenceHasItsSpeedAndLifeTimeAtAnyTime) {
  const Grid grid{240, 240, 1, true, true};
  WindFeature f = feature(WindFeatureKind::turbulence, 120, 120, 1e4f, 2);
  f.scale = 12;
  f.life_time = 5;
  for (const double start : {0.0, 1e5, 1e9, 1e12}) {
    SCOPED_TRACE(start);
    double square = 0, change_soon = 0, change_later = 0;
    constexpr int looks = 10;
    for (int look = 0; look < looks; ++look) {
      const double time = start + 8.5 * look;
      const Perturbation now(exec(), grid, {f}, time), soon(exec(), grid, {f}, time + 0.25),
          later(exec(), grid, {f}, time + 10);
      for (std::size_t n = 0; n < now.u.size(); ++n) {
        const double share = 1.0 / (looks * static_cast<double>(now.u.size()));
        square += share * (now.u[n] * now.u[n] + now.v[n] * now.v[n]);
        change_soon += share * std::pow(std::hypot(soon.u[n] - now.u[n], soon.v[n] - now.v[n]), 2);
        change_later += share * std::pow(std::hypot(later.u[n] - now.u[n], later.v[n] - now.v[n]), 2);
      }
    }
    EXPECT_NEAR(std::sqrt(square), 2, 0.15);
    EXPECT_GT(std::sqrt(change_soon), 0.05) << "it stands still";
    EXPECT_LT(std::sqrt(change_soon), 0.5) << "it jumps";
    EXPECT_NEAR(std::sqrt(change_later), 2 * std::sqrt(2.0), 0.3) << "another one after two life times";
  }
}

}  // namespace
}  // namespace desert_sim
