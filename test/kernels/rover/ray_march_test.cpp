// Where the beams of sensors end on the ground: analytic surfaces, and tiny steps over random ones.

#include "src/render/ray_cast.hpp"
#include "test/support/scenes.hpp"

namespace desert_sim {
namespace {

using test::KnownScene;
using test::Point;
using test::unknown;

class RayMarch : public ::testing::Test {
 protected:
  CpuExec exec_{1};

  float range_of(const KnownScene& known, const SensorPose& pose, float range_max = 1000) {
    return Lidar(exec_, test::single_beam(range_max)).scan(known.scene, pose, 0).distances[0];
  }
};

/// Rough ground: dunes, and steps from cell to cell.
float rough(int x, int y) {
  return 5 * std::sin(0.31f * static_cast<float>(x)) + 3 * std::cos(0.23f * static_cast<float>(y)) +
         static_cast<float>((x * 7 + y * 13) % 5) * 0.3f;
}

/// All points of a scan lie on the surface, up to a millimetre and the rounding of the heights, and so
/// many beams return.
void expect_on_surface(const KnownScene& known, Lidar& lidar, const SensorPose& pose, int least_returns) {
  const RangeImage& image = lidar.scan(known.scene, pose, 0);
  EXPECT_GE(test::returns_of(image), least_returns);
  double worst = 0;
  for (std::size_t n = 0; n < image.distances.size(); ++n) {
    if (std::isnan(image.distances[n])) continue;
    const Point p = test::point_at(pose, lidar.directions()[n], static_cast<double>(image.distances[n]));
    const double error = std::abs(p.z - known.height_at(p.x, p.y));
    EXPECT_FALSE(std::isnan(error)) << "beam " << n << " returns from outside the grid";
    worst = std::max(worst, error);
  }
  EXPECT_LT(worst, 1e-3);
}

TEST_F(RayMarch, MeasuresAPlane) {
  const KnownScene plane(exec_, {200, 200, 0.5, -50, -50}, [](int, int) { return 3.0f; });
  for (const double down_deg : {90.0, 45.0, 10.0, 3.0}) {
    const SensorPose pose = pose_from_angles(1.234, -5.6, 5, 0, down_deg, 17);
    EXPECT_NEAR(static_cast<double>(range_of(plane, pose)), 2 / std::sin(down_deg * 3.14159265358979 / 180),
                1e-4)
        << down_deg;
  }
  EXPECT_TRUE(std::isnan(range_of(plane, pose_from_angles(0, 0, 5, 0, 0, 0)))) << "parallel to it";
  EXPECT_TRUE(std::isnan(range_of(plane, pose_from_angles(0, 0, 5, 0, -30, 0)))) << "into the sky";
}

TEST_F(RayMarch, MeasuresASlope) {
  // h = 0.5 x at x east of the corner; a horizontal beam at 20 m to the east meets it at x = 40.
  const KnownScene slope(exec_, {100, 40, 1, 0, 0},
                         [](int x, int) { return 0.5f * (static_cast<float>(x) + 0.5f); });
  EXPECT_NEAR(static_cast<double>(range_of(slope, {{10, 20, 20}})), 30, 1e-4);
  Lidar lidar(exec_, test::single_beam());
  const RangeImage& image = lidar.scan(slope.scene, {{10, 20, 20}}, 0);
  const double incidence = 0.5 / std::sqrt(1.25);
  EXPECT_NEAR(static_cast<double>(image.intensities[0]), 0.35 * incidence, 1e-5);
}

/// The ground h = (x − ½)(y − ½)/10 is twisted in every patch: a beam meets the slope at the hit, not that
/// where it enters the patch. The other tests of intensities have planes.
TEST_F(RayMarch, MeasuresTheSlopeWhereItHits) {
  const KnownScene twisted(exec_, {12, 12, 1, 0, 0},
                           [](int x, int y) { return 0.1f * static_cast<float>(x * y); });
  Lidar lidar(exec_, test::exact_lidar(16, 64, -80, -30));
  const SensorPose pose = pose_from_angles(3.3, 4.2, 6, 0, 0, 20);
  const RangeImage& image = lidar.scan(twisted.scene, pose, 0);
  int seen = 0;
  for (std::size_t n = 0; n < image.distances.size(); ++n) {
    if (std::isnan(image.distances[n])) continue;
    const Point p = test::point_at(pose, lidar.directions()[n], static_cast<double>(image.distances[n])),
                ahead = test::point_at(pose, lidar.directions()[n], 1);
    if (p.x < 0.5 || p.y < 0.5 || p.x > 11.5 || p.y > 11.5) continue;  // the ground is level out there
    const double slope_x = 0.1 * (p.y - 0.5), slope_y = 0.1 * (p.x - 0.5);
    const double along_normal = (ahead.z - pose.position.z()) - slope_x * (ahead.x - pose.position.x()) -
                                slope_y * (ahead.y - pose.position.y());
    const double incidence = std::abs(along_normal) / std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
    ASSERT_NEAR(static_cast<double>(image.intensities[n]), 0.35 * incidence, 1e-4) << "beam " << n;
    ++seen;
  }
  EXPECT_GT(seen, 200);
}

TEST_F(RayMarch, FindsPointsOnAGaussianHill) {
  const KnownScene hill(exec_, {256, 256, 0.5, 100, -300}, [](int x, int y) {
    const float dx = 0.5f * (static_cast<float>(x) - 128), dy = 0.5f * (static_cast<float>(y) - 128);
    return 12 * std::exp(-(dx * dx + dy * dy) / 400);
  });
  Lidar lidar(exec_, test::exact_lidar(32, 256, -25, 15));
  expect_on_surface(hill, lidar, pose_from_angles(140, -250, 2, 2, -3, 30), 5000);
}

TEST_F(RayMarch, FindsAStep) {
  const KnownScene step(exec_, {64, 64, 1, 0, 0}, [](int x, int) { return x < 32 ? 0.0f : 4.0f; });
  // Between the centres at 31.5 and 32.5 the surface rises by 4 m.
  EXPECT_NEAR(static_cast<double>(range_of(step, {{10, 20, 1}})), 21.5 + 0.25, 1e-4);
  EXPECT_NEAR(static_cast<double>(range_of(step, {{10, 20, 3}})), 21.5 + 0.75, 1e-4);
  EXPECT_TRUE(std::isnan(range_of(step, {{10, 20, 4.01}})));
}

TEST_F(RayMarch, AgreesWithTinySteps) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  const KnownScene ground(exec_, {61, 47, 2, -30, 10}, [](int x, int y) {
    return x > 20 && x < 26 && y > 8 && y < 14 ? unknown : rough(x, y);
  });
  Lidar lidar(exec_, test::single_beam(300));
  int hits = 0, misses = 0, differences = 0;
  for (int n = 0; n < 1500; ++n) {
    // A third of the rays graze: they look along the dunes at the height of the crests.
    const bool grazing = n % 3 == 0;
    const SensorPose pose = pose_from_angles(
        -40 + 140 * unit(random), 110 * unit(random), grazing ? 6 + 2 * unit(random) : 20 * unit(random), 0,
        grazing ? 4 * unit(random) - 2 : 60 * unit(random) - 10, 360 * unit(random));
    const auto expected = test::by_steps(ground, pose, {1, 0, 0}, 0.02, 200);
    const float found = lidar.scan(ground.scene, pose, 0).distances[0];
    if (expected && *expected > 195) continue;
    const bool returns = !std::isnan(found);
    ++(returns ? hits : misses);
    if (returns == expected.has_value() &&
        (!returns || std::abs(static_cast<double>(found) - *expected) < 2e-3))
      continue;
    // What is left are crests that the ray touches by less than a step, and hits at very grazing angles:
    // the point is on the surface up to rounding, and not behind the one that was expected.
    ++differences;
    ASSERT_TRUE(returns) << "ray " << n << " goes through the ground";
    const Point p = test::point_at(pose, {1, 0, 0}, static_cast<double>(found));
    EXPECT_NEAR(p.z, ground.height_at(p.x, p.y), 1e-4) << "ray " << n;
    EXPECT_LT(static_cast<double>(found), expected.value_or(1e9) + 2e-3) << "ray " << n;
  }
  EXPECT_GT(hits, 600);
  EXPECT_GT(misses, 100);
  EXPECT_LE(differences, 20);
}

TEST_F(RayMarch, AgreesWithTheRaysOfTheMouse) {
  // In double precision and cell by cell.
  const KnownScene ground(exec_, {150, 90, 0.5, 0, 0}, rough);
  const render::HeightField field{
      150, 90, 0.5, [&](int x, int y) { return ground.heights[static_cast<std::size_t>(y * 150 + x)]; }};
  LidarParameters p = test::exact_lidar(60, 300, -40, 20);
  p.range_max = 1000;
  Lidar lidar(exec_, p);
  int hits = 0, different = 0;
  for (const SensorPose& pose :
       {pose_from_angles(30, 20, 12, 0, 0, 0), pose_from_angles(70, 40, 10, 3, 5, 70)}) {
    const RangeImage& image = lidar.scan(ground.scene, pose, 0);
    for (std::size_t n = 0; n < image.distances.size(); ++n) {
      const Point ahead = test::point_at(pose, lidar.directions()[n], 1);
      const render::Ray ray{pose.position, Eigen::Vector3d(ahead.x, ahead.y, ahead.z) - pose.position};
      const auto expected = render::first_hit(field, ray);
      const bool returns = !std::isnan(image.distances[n]);
      hits += returns;
      const Point p_found =
          test::point_at(pose, lidar.directions()[n], static_cast<double>(image.distances[n]));
      different += returns != expected.has_value() ||
                   (returns && std::hypot(p_found.x - expected->x(), p_found.y - expected->y(),
                                          p_found.z - expected->z()) > 1e-3);
    }
  }
  EXPECT_GT(hits, 10000);
  EXPECT_LT(different, 10) << "crests that a ray touches";
}

TEST_F(RayMarch, KeepsPrecisionFarFromTheOrigin) {
  // UTM coordinates, at 2000 m above the sea.
  const double east = 712345.6, north = 3456789.1;
  const KnownScene far(exec_, {512, 512, 0.25, east, north},
                       [](int x, int y) { return 2000 + 0.2f * rough(x, y); });
  Lidar lidar(exec_, test::exact_lidar(32, 512, -25, 5));
  expect_on_surface(far, lidar, pose_from_angles(east + 60.03, north + 70.08, 2003.217, 1, 2, 3), 8000);

  const KnownScene high(exec_, {20, 20, 1, 0, 0}, [](int, int) { return 8000.0f; });
  EXPECT_NEAR(static_cast<double>(range_of(high, pose_from_angles(9, 9, 8002.0002, 0, 90, 0))), 2.0002, 1e-5)
      << "floats of 8000 are half a millimetre apart";

  const KnownScene near(exec_, {512, 512, 0.25, 0, 0}, [](int x, int y) { return 0.2f * rough(x, y); });
  Lidar other(exec_, test::exact_lidar(32, 512, -25, 5));
  const RangeImage& a = lidar.scan(far.scene, pose_from_angles(east + 60, north + 70, 2003, 0, 0, 0), 0);
  const RangeImage& b = other.scan(near.scene, pose_from_angles(60, 70, 3, 0, 0, 0), 0);
  int different = 0;
  for (std::size_t n = 0; n < a.distances.size(); ++n)
    different += !(std::abs(a.distances[n] - b.distances[n]) < 0.05f) &&
                 !(std::isnan(a.distances[n]) && std::isnan(b.distances[n]));
  // Heights of 2000 m are known to a tenth of a millimetre: grazing beams differ by that.
  EXPECT_LT(different, static_cast<int>(a.distances.size() / 200));
}

TEST_F(RayMarch, SeesNothingBehindAHill) {
  const KnownScene ridge(exec_, {200, 50, 1, 0, 0},
                         [](int x, int) { return x == 100 ? 10.0f : (x > 140 ? 8.0f : 0.0f); });
  const SensorPose pose{{50, 25, 5}};
  EXPECT_NEAR(static_cast<double>(range_of(ridge, pose)), 50, 1e-3) << "half-way up the ridge at 100.5";
  EXPECT_NEAR(static_cast<double>(range_of(ridge, {{105, 25, 5}})), 140.5 + 5.0 / 8 - 105, 1e-3);
}

TEST_F(RayMarch, EndsAtItsRange) {
  const KnownScene wall(exec_, {100, 20, 1, 0, 0}, [](int x, int) { return x < 60 ? 0.0f : 10.0f; });
  EXPECT_NEAR(static_cast<double>(range_of(wall, {{10, 10, 5}}, 51)), 50, 1e-3);
  EXPECT_TRUE(std::isnan(range_of(wall, {{10, 10, 5}}, 49.9f)));
  LidarParameters blind = test::single_beam();
  blind.range_min = 50.1f;
  EXPECT_TRUE(std::isnan(Lidar(exec_, blind).scan(wall.scene, {{10, 10, 5}}, 0).distances[0]));
}

TEST_F(RayMarch, SeesNothingWhenBuried) {
  const KnownScene ground(exec_, {20, 20, 1, 0, 0}, [](int, int) { return 2.0f; });
  LidarParameters p = test::single_beam();
  p.range_min = 0.01f;
  Lidar lidar(exec_, p);
  EXPECT_TRUE(std::isnan(lidar.scan(ground.scene, {{10, 10, 1}}, 0).distances[0]));
  EXPECT_TRUE(std::isnan(lidar.scan(ground.scene, pose_from_angles(10, 10, 1, 0, -90, 0), 0).distances[0]));
}

TEST_F(RayMarch, HasOpenEdges) {
  const KnownScene slope(exec_, {8, 4, 2, 0, 0}, [](int x, int) { return static_cast<float>(x); });
  const auto down = [&](double x, double y) { return range_of(slope, pose_from_angles(x, y, 50, 0, 90, 0)); };
  EXPECT_NEAR(static_cast<double>(down(6, 3)), 47.5, 1e-4);
  EXPECT_NEAR(static_cast<double>(down(0.25, 7.75)), 50, 1e-4) << "beyond the outermost centres";
  EXPECT_NEAR(static_cast<double>(down(15.9, 0.1)), 43, 1e-4);
  EXPECT_TRUE(std::isnan(down(-0.1, 3)));
  EXPECT_TRUE(std::isnan(down(16.1, 3)));
  EXPECT_TRUE(std::isnan(down(6, 8.1)));
  EXPECT_TRUE(std::isnan(range_of(slope, {{14, 4, 8}}))) << "it leaves the grid above the ground";
  EXPECT_NEAR(static_cast<double>(range_of(slope, {{-30, 4, 2.5}})), 36, 1e-3) << "it comes in from outside";
  EXPECT_NEAR(static_cast<double>(range_of(slope, {{-30, 4, -1}})), 30, 1e-3) << "the ground ends as a wall";
  EXPECT_TRUE(std::isnan(range_of(slope, pose_from_angles(-30, 4, 2.5, 0, 0, 180))));
  EXPECT_TRUE(std::isnan(range_of(slope, {{1e9, 4, 2.5}})));
}

TEST_F(RayMarch, WorksOnTheSmallestGrids) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 7}, {5, 1}, {3, 3}}) {
    const KnownScene ground(exec_, {width, height, 1, 0, 0}, [](int, int) { return 1.0f; });
    EXPECT_NEAR(static_cast<double>(range_of(ground, pose_from_angles(0.5, 0.5, 3, 0, 90, 0))), 2, 1e-6);
    EXPECT_TRUE(std::isnan(range_of(ground, {{0.5, 0.5, 1.5}})));
  }
}

TEST_F(RayMarch, GoesThroughUnknownGround) {
  const KnownScene hole(exec_, {10, 10, 1, 0, 0}, [](int x, int) { return x < 5 ? unknown : 0.0f; });
  EXPECT_TRUE(std::isnan(range_of(hole, pose_from_angles(2, 5, 5, 0, 90, 0))));
  const HeightFieldScene empty(exec_, {10, 10, 1, 0, 0});
  Lidar lidar(exec_, test::exact_lidar(8, 64, -60, 10));
  EXPECT_EQ(test::returns_of(lidar.scan(empty, {{5, 5, 1}}, 0)), 0) << "nothing is known at the start";
}

}  // namespace
}  // namespace desert_sim
