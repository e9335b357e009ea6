// Where rays meet the terrain, against tiny steps along them.

#include "src/render/ray_cast.hpp"

#include <gtest/gtest.h>

#include <random>

#include "test/src/render/fields.hpp"

namespace {

using namespace render_test;

HeightField field_of(int width, int height, double cell_size, const Height& heights) {
  return {width, height, cell_size, heights};
}

Point along(const Ray& ray, double t) { return ray.origin + t * ray.direction; }

/// The first change of side in steps of `step`; grazing rays whose way below the surface is shorter are
/// missed.
std::optional<Point> by_steps(const HeightField& field, const Ray& ray, double step, double end) {
  const auto above = [&](double t) {
    const Point p = along(ray, t);
    return p.z() - field.height_at({p.x(), p.y()});
  };
  double before = above(0);
  for (double t = step; t < end; t += step) {
    const double now = above(t);
    if ((before > 0 && now <= 0) || (before < 0 && now >= 0)) {
      double low = t - step, high = t;
      for (int n = 0; n < 60; ++n)
        ((above(0.5 * (low + high)) > 0) == (before > 0) ? low : high) = 0.5 * (low + high);
      return along(ray, high);
    }
    before = now;
  }
  return std::nullopt;
}

TEST(RayCast, AgreesWithTinySteps) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  const HeightField field = field_of(40, 30, 2, [](int x, int y) {
    const bool hole = x > 10 && x < 16 && y > 8 && y < 12;
    return hole ? unknown : dunes(x, y) + static_cast<float>((x * 7 + y * 13) % 5);
  });
  int hits = 0, differences = 0;
  for (int n = 0; n < 3000; ++n) {
    const Point from{120 * unit(random) - 20, 100 * unit(random) - 20, 60 * unit(random) - 10};
    const Point to{80 * unit(random), 60 * unit(random), 20 * unit(random) - 10};
    const Ray ray{from, to - from};
    const double length = ray.direction.norm();
    const auto expected = by_steps(field, ray, 0.01 / length, 150 / length);
    const auto found = first_hit(field, ray);
    if (found) {
      ++hits;
      EXPECT_NEAR(found->z(), field.height_at({found->x(), found->y()}), 1e-6)
          << "the point is on the surface";
    }
    const auto away = [&](const Point& p) { return (p - from).norm(); };
    // A ray that touches a crest, or the edge of a hole, is found by the exact equation only.
    if (expected.has_value() != found.has_value() ||
        (found && std::abs(away(*found) - away(*expected)) > 1e-3)) {
      ++differences;
      ASSERT_TRUE(found) << "ray " << n << ": the exact equation misses nothing";
      EXPECT_LT(away(*found), expected ? away(*expected) : 1e9) << "ray " << n;
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_LE(differences, 15);
}

TEST(RayCast, TakesTheNearestOfSeveral) {
  const HeightField ridges = field_of(100, 10, 1, [](int x, int) { return x % 20 == 10 ? 10.0f : 0.0f; });
  const auto hit = first_hit(ridges, {{100, 5, 5}, {-1, 0, 0}});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->x(), 91, 1e-9);  // halfway up the ridge at 90.5, which is one cell wide on each side
}

TEST(RayCast, KnowsVerticalRaysAndEdges) {
  const HeightField slope = field_of(8, 4, 2, [](int x, int) { return static_cast<float>(x); });
  const auto down = first_hit(slope, {{6, 3, 50}, {0, 0, -2}});
  ASSERT_TRUE(down);
  EXPECT_NEAR(down->z(), 2.5, 1e-12);
  const auto corner = first_hit(slope, {{0.25, 7.75, 50}, {0, 0, -1}});
  ASSERT_TRUE(corner) << "beyond the outermost centres";
  EXPECT_NEAR(corner->z(), 0, 1e-12);
  EXPECT_TRUE(first_hit(slope, {{6, 3, -5}, {0, 0, 1}})) << "from below";
  EXPECT_FALSE(first_hit(slope, {{6, 3, 50}, {0, 0, 1}})) << "away from it";
  EXPECT_FALSE(first_hit(slope, {{-0.1, 3, 50}, {0, 0, -1}})) << "beside it";
  EXPECT_FALSE(first_hit(slope, {{6, 3, 50}, {0, 0, 0}})) << "no direction";
  EXPECT_FALSE(first_hit({}, {{6, 3, 50}, {0, 0, -1}})) << "no terrain";
}

TEST(RayCast, GoesThroughHoles) {
  const HeightField hole = field_of(10, 10, 1, [](int x, int) { return x < 5 ? unknown : 0.0f; });
  EXPECT_FALSE(first_hit(hole, {{2, 5, 5}, {0, 0, -1}}));
  const auto behind = first_hit(hole, {{-5, 5, 5}, {1, 0, -0.4}});
  ASSERT_TRUE(behind);
  EXPECT_NEAR(behind->x(), 7.5, 1e-9);
}

TEST(RayCast, LooksAtTheCellsBelowTheRayOnlyAlsoAtGrazingAngles) {
  constexpr int side = 2048;
  int looks = 0;
  const HeightField field = field_of(side, side, 1, [&looks](int x, int y) {
    ++looks;
    return dunes(x, y);
  });
  EXPECT_FALSE(first_hit(field, {{-1, -1, 12}, {1, 0.99, -1e-6}})) << "it passes above all crests";
  EXPECT_GT(looks, side) << "it passes over the whole terrain";
  EXPECT_LE(looks, 4 * 2 * (side + 1)) << "the corners of each quad of cells that it crosses";
}

}  // namespace
