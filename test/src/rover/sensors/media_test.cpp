// What beams meet besides the ground (plants, obstacles, airborne sand), and the noise of what they measure.

#include "test/support/scenes.hpp"

namespace desert_sim {
namespace {

using test::KnownScene;
using test::unknown;

constexpr int many = 20000;

/// Many beams straight ahead, each of which draws for itself.
LidarParameters bundle(float range_max = 1000) {
  LidarParameters p = test::single_beam(range_max);
  p.rings = 200;
  p.columns = many / p.rings;
  p.first_azimuth_deg = -1e-4f;
  p.last_azimuth_deg = 1e-4f;
  return p;
}

/// A wall across the way at x = 64, in front of which the ground is flat.
float wall(int x, int) { return x < 64 ? 0.0f : 10.0f; }

struct Counts {
  int wall = 0, before = 0, lost = 0;
};
Counts count(const RangeImage& image, float wall_distance) {
  Counts counts;
  for (const float d : image.distances)
    ++(std::isnan(d) ? counts.lost : (std::abs(d - wall_distance) < 0.01f ? counts.wall : counts.before));
  return counts;
}

/// Five standard deviations of a number of events of this probability among many.
double margin(double probability) { return 5 * std::sqrt(many * probability * (1 - probability)) + 1; }

class BeamMedia : public ::testing::Test {
 protected:
  CpuExec exec_{1};
  const SceneGeometry geometry_{80, 40, 1, 0, 0};
  SensorMediaParameters media_;
};

TEST_F(BeamMedia, PlantsLetASharePass) {
  KnownScene known(exec_, geometry_, wall);
  const auto bush = [](float value) {
    return [value](int x, int) { return x >= 20 && x < 30 ? value : 0.0f; };
  };
  known.set(SceneLayer::canopy_height, bush(2));
  known.set(SceneLayer::vegetation, bush(0.25f));
  media_.canopy_extinction = 0.4f;
  Lidar lidar(exec_, bundle(), media_);
  // At 0.5 m, the canopy from 2 m down to 0 between the centres at 19.5 and 20.5 reaches to a quarter of that
  // way; density, interpolated too, is the mean there: 10 cells of it in all, less what is above the canopy.
  const SensorPose pose{{5, 20, 0.5}};
  const double full = 9, side = 0.75, middle_density = 0.25 * (0.25 + 1) / 2;
  const double depth = 0.4 * (full * 0.25 + 2 * side * middle_density), passes = std::exp(-depth);
  const Counts counts = count(lidar.scan(known.scene, pose, 3), 58.55f);
  EXPECT_NEAR(counts.wall, many * passes, margin(passes));
  EXPECT_EQ(counts.lost, 0);
  const RangeImage& image = lidar.scan(known.scene, pose, 3);
  for (std::size_t n = 0; n < image.distances.size(); ++n)
    if (image.distances[n] < 50) {
      ASSERT_GE(image.distances[n], 14.74f) << "where the canopy begins";
      ASSERT_LE(image.distances[n], 25.26f) << "where it ends";
      ASSERT_EQ(image.intensities[n], media_.plant_reflectivity);
    }
  EXPECT_EQ(count(lidar.scan(known.scene, {{5, 20, 2.01}}, 3), 58.7f).wall, many) << "above the plants";
}

TEST_F(BeamMedia, PlantsOnUnevenGroundReachFromItUp) {
  KnownScene known(exec_, geometry_, [](int x, int) { return x < 20 ? 0.0f : (x < 40 ? 3.0f : 0.0f); });
  known.set(SceneLayer::canopy_height, [](int x, int) { return x >= 20 && x < 40 ? 1.0f : 0.0f; });
  known.set(SceneLayer::vegetation, [](int, int) { return 1.0f; });
  media_.canopy_extinction = 100;
  Lidar lidar(exec_, bundle(), media_);
  const auto returns = [&](double z) { return test::returns_of(lidar.scan(known.scene, {{5, 20, z}}, 0)); };
  EXPECT_EQ(returns(3.9), many) << "in the canopy";
  EXPECT_EQ(returns(4.1), 0) << "above it";
  EXPECT_EQ(count(lidar.scan(known.scene, {{5, 20, 1.5}}, 0), 14.9f).lost, 0) << "below, at the step";
}

TEST_F(BeamMedia, PlantsWithoutDensityOrHeightAreNotSeen) {
  KnownScene known(exec_, geometry_, wall);
  known.set(SceneLayer::canopy_height, [](int, int) { return 5.0f; });
  Lidar lidar(exec_, bundle(), media_);
  EXPECT_EQ(count(lidar.scan(known.scene, {{5, 20, 0.5}}, 0), 58.55f).wall, many);
  known.set(SceneLayer::vegetation, [](int x, int) { return x == 75 ? 1.0f : unknown; });
  EXPECT_EQ(count(lidar.scan(known.scene, {{5, 20, 0.5}}, 0), 58.55f).wall, many);
}

TEST_F(BeamMedia, ObstaclesAreColumnsOfTheGround) {
  const KnownScene box(exec_, geometry_,
                       [](int x, int y) { return x >= 30 && x < 34 && y >= 18 && y < 22 ? 1.2f : 0.0f; });
  Lidar lidar(exec_, test::single_beam());
  EXPECT_NEAR(static_cast<double>(lidar.scan(box.scene, {{5, 20, 0.6}}, 0).distances[0]), 25, 1e-3);
  EXPECT_TRUE(std::isnan(lidar.scan(box.scene, {{5, 20, 1.3}}, 0).distances[0])) << "over it";
  EXPECT_TRUE(std::isnan(lidar.scan(box.scene, {{5, 10, 0.6}}, 0).distances[0])) << "beside it";
}

TEST_F(BeamMedia, AirborneSandFollowsBeerAndLambert) {
  KnownScene known(exec_, geometry_, wall);
  known.set(SceneLayer::airborne_sand, [](int, int) { return 0.02f; });
  media_.dust_extinction = 1;
  media_.dust_returns = 0.25f;
  Lidar lidar(exec_, bundle(), media_);
  const float distance = 58.6f;
  const double passes = std::exp(-0.02 * 58.6);
  const Counts counts = count(lidar.scan(known.scene, {{5, 20, 1}}, 0), distance);
  EXPECT_NEAR(counts.wall, many * passes, margin(passes));
  EXPECT_NEAR(counts.before, many * (1 - passes) * 0.25, margin((1 - passes) * 0.25));
  media_.dust_height = 0.5f;
  EXPECT_EQ(count(Lidar(exec_, bundle(), media_).scan(known.scene, {{5, 20, 1}}, 0), distance).wall, many)
      << "above the layer";
}

/// Whether noise drops a beam has nothing to do with what the beam meets. All beams end in dust so thick; a
/// quarter of them return, of which half are left. If one draw decided on both, none would be.
TEST_F(BeamMedia, DropoutDoesNotDependOnWhatABeamMeets) {
  KnownScene known(exec_, geometry_, wall);
  known.set(SceneLayer::airborne_sand, [](int, int) { return 1.0f; });
  media_.dust_extinction = 1;
  media_.dust_returns = 0.25f;
  LidarParameters p = bundle();
  p.dropout = 0.5f;
  Lidar lidar(exec_, p, media_);
  EXPECT_NEAR(test::returns_of(lidar.scan(known.scene, {{5, 20, 1}}, 0)), many * 0.125, margin(0.125));
}

TEST_F(BeamMedia, AirborneSandFillsALayerOverTheGround) {
  KnownScene known(exec_, geometry_, [](int, int) { return 10.0f; });
  known.set(SceneLayer::airborne_sand, [](int, int) { return 0.1f; });
  media_.dust_extinction = 1;
  media_.dust_height = 3;
  media_.dust_returns = 0;
  // From 8 m above the ground, 30° down: 3 m of height in the layer are 6 m of the way.
  const double passes = std::exp(-0.1 * 6);
  Lidar down(exec_, bundle(), media_);
  const int ground = test::returns_of(down.scan(known.scene, pose_from_angles(5, 20, 18, 0, 30, 0), 0));
  EXPECT_NEAR(ground, many * passes, margin(passes));
  // From 1 m above the ground straight up, 2 m are to the top of the layer.
  media_.dust_returns = 1;
  Lidar up(exec_, bundle(), media_);
  const RangeImage& sky = up.scan(known.scene, pose_from_angles(40, 20, 11, 0, -90, 0), 0);
  const double returns = 1 - std::exp(-0.1 * 2);
  EXPECT_NEAR(test::returns_of(sky), many * returns, margin(returns));
  for (const float d : sky.distances) ASSERT_FALSE(d > 2.001f);
}

TEST_F(BeamMedia, MoreAirborneSandShortensEachBeam) {
  media_.dust_extinction = 1;
  media_.dust_returns = 1;
  std::vector<float> before;
  double mean = 1e9;
  for (const float amount : {0.001f, 0.01f, 0.03f, 0.1f, 0.5f}) {
    KnownScene known(exec_, geometry_, wall);
    known.set(SceneLayer::airborne_sand,
              [=](int x, int y) { return amount * (1 + 0.5f * std::sin(static_cast<float>(x + 2 * y))); });
    Lidar lidar(exec_, bundle(), media_);
    const std::vector<float> now = lidar.scan(known.scene, {{5, 20, 1}}, 7).distances;
    double sum = 0;
    for (std::size_t n = 0; n < now.size(); ++n) {
      ASSERT_FALSE(std::isnan(now[n]));
      if (!before.empty()) {
        ASSERT_LE(now[n], before[n]) << "beam " << n;
      }
      sum += static_cast<double>(now[n]);
    }
    EXPECT_LT(sum / many, 0.995 * mean) << amount;
    mean = sum / many;
    before = now;
  }
}

class RangeNoise : public ::testing::Test {
 protected:
  CpuExec exec_{1};
  const KnownScene known_{exec_, {80, 40, 1, 0, 0}, wall};

  RangeImage scan(const LidarParameters& p, double x, std::uint64_t number = 0) {
    return Lidar(exec_, p).scan(known_.scene, {{x, 20, 1}}, number);
  }
};

struct Moments {
  double mean = 0, deviation = 0, skew = 0;
  int count = 0;
};
Moments moments_of(const RangeImage& image) {
  Moments m;
  const auto mean_of = [&](const auto& value) {
    double sum = 0;
    for (const float d : image.distances)
      if (!std::isnan(d)) sum += value(static_cast<double>(d));
    return sum / m.count;
  };
  m.count = test::returns_of(image);
  m.mean = mean_of([](double d) { return d; });
  m.deviation = std::sqrt(mean_of([&](double d) { return (d - m.mean) * (d - m.mean); }));
  m.skew = mean_of([&](double d) { return std::pow((d - m.mean) / m.deviation, 3); });
  return m;
}

TEST_F(RangeNoise, IsNormalWithItsDeviation) {
  LidarParameters p = bundle();
  p.noise = 0.05f;
  p.noise_per_metre = 0.002f;
  for (const double x : {10.0, 40.0}) {
    const double distance = 63.6 - x, sigma = 0.05 + 0.002 * distance;
    const RangeImage image = scan(p, x);
    const Moments m = moments_of(image);
    EXPECT_EQ(m.count, many);
    EXPECT_NEAR(m.mean, distance, 5 * sigma / std::sqrt(many));
    EXPECT_NEAR(m.deviation, sigma, 5 * sigma / std::sqrt(2.0 * many));
    EXPECT_NEAR(m.skew, 0, 5 * std::sqrt(6.0 / many));
    const auto beyond = [&](double sigmas) {
      return std::count_if(image.distances.begin(), image.distances.end(), [&](float d) {
        return std::abs(static_cast<double>(d) - distance) > sigmas * sigma;
      });
    };
    EXPECT_NEAR(static_cast<double>(beyond(1)), many * 0.3173, margin(0.3173));
    EXPECT_NEAR(static_cast<double>(beyond(3)), many * 0.0027, margin(0.0027));
  }
}

TEST_F(RangeNoise, DropsOutAShareOfTheBeams) {
  LidarParameters p = bundle();
  p.dropout = 0.2f;
  const RangeImage image = scan(p, 10);
  EXPECT_NEAR(test::returns_of(image), many * 0.8, margin(0.2));
  for (std::size_t n = 0; n < image.distances.size(); ++n)
    ASSERT_EQ(std::isnan(image.distances[n]), image.intensities[n] == 0);
  p.dropout = 1;
  EXPECT_EQ(test::returns_of(scan(p, 10)), 0);
}

TEST_F(RangeNoise, PutsNothingBeyondTheRange) {
  LidarParameters p = bundle(53.7f);
  p.noise = 0.2f;
  for (const float d : scan(p, 10).distances) ASSERT_FALSE(d > 53.7f);
  EXPECT_GT(test::returns_of(scan(p, 10)), many / 2);
  EXPECT_LT(test::returns_of(scan(p, 10)), many * 9 / 10);
}

TEST_F(RangeNoise, DependsOnSeedAndNumberOfTheScan) {
  LidarParameters p = bundle();
  p.noise = 0.1f;
  p.dropout = 0.05f;
  const RangeImage first = scan(p, 10, 5);
  EXPECT_TRUE(test::same_bits(first.distances, scan(p, 10, 5).distances));
  const auto correlation_is_small = [&](const RangeImage& other) {
    const Moments a = moments_of(first), b = moments_of(other);
    double sum = 0;
    int both = 0;
    for (std::size_t n = 0; n < first.distances.size(); ++n) {
      const double product = (static_cast<double>(first.distances[n]) - a.mean) *
                             (static_cast<double>(other.distances[n]) - b.mean);
      if (!std::isnan(product)) sum += product, ++both;
    }
    EXPECT_NEAR(sum / both / a.deviation / b.deviation, 0, 5 / std::sqrt(both));
  };
  correlation_is_small(scan(p, 10, 6));
  correlation_is_small(scan(p, 10, 5 + (std::uint64_t{1} << 32)));
  p.seed = 77;
  correlation_is_small(scan(p, 10, 5));
}

}  // namespace
}  // namespace desert_sim
