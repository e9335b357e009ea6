// Strokes of a brush as capsules: nothing of the path is lost, and nothing queues up.

#include "src/render/stroke_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace desert_sim::render;

double distance_to(const Capsule& c, const Place& p) {
  const double dx = c.to.x - c.from.x, dy = c.to.y - c.from.y, square = dx * dx + dy * dy;
  const double s =
      square > 0 ? std::clamp(((p.x - c.from.x) * dx + (p.y - c.from.y) * dy) / square, 0.0, 1.0) : 0;
  return std::hypot(p.x - c.from.x - s * dx, p.y - c.from.y - s * dy);
}

std::vector<Capsule> take_all(StrokePath& path) {
  std::vector<Capsule> capsules;
  while (const auto capsule = path.take()) capsules.push_back(*capsule);
  return capsules;
}

Place spiral(int n) {
  const double angle = 0.05 * n;
  return {(1 + angle) * std::cos(angle), (1 + angle) * std::sin(angle)};
}

/// Whether the capsules follow one another, from the first place to the last one, and leave no place out.
void expect_complete(const std::vector<Capsule>& capsules, const std::vector<Place>& places,
                     double tolerance) {
  ASSERT_FALSE(capsules.empty());
  EXPECT_EQ(distance(capsules.front().from, places.front()), 0);
  EXPECT_EQ(distance(capsules.back().to, places.back()), 0);
  for (std::size_t n = 1; n < capsules.size(); ++n)
    EXPECT_EQ(distance(capsules[n - 1].to, capsules[n].from), 0) << "a gap before capsule " << n;
  for (const Place& place : places) {
    double nearest = 1e9;
    for (const Capsule& capsule : capsules) nearest = std::min(nearest, distance_to(capsule, place));
    EXPECT_LE(nearest, tolerance);
  }
}

TEST(StrokePath, HasNoGapsHoweverSlowlyItIsTaken) {
  for (const int places_between_calls : {1, 3, 40, 1000}) {
    StrokePath path(0.5, 0.2);
    std::vector<Place> places;
    std::vector<Capsule> capsules;
    for (int n = 0; n < 400; ++n) {
      places.push_back(spiral(n));
      path.add(places.back());
      if (n % places_between_calls == 0)
        if (const auto capsule = path.take()) capsules.push_back(*capsule);
    }
    path.end();
    for (const Capsule& capsule : take_all(path)) capsules.push_back(capsule);
    EXPECT_TRUE(path.finished());
    expect_complete(capsules, places, 0.2);
  }
}

TEST(StrokePath, AStraightPathThatHasPiledUpIsOneCapsule) {
  StrokePath path(0.5, 0.1);
  for (int n = 0; n <= 250; ++n) path.add({0.04 * n, 0.08 * n});
  const auto capsule = path.take();
  ASSERT_TRUE(capsule);
  EXPECT_EQ(capsule->to.x, 10);
  EXPECT_FALSE(path.take()) << "nothing queues up behind it";
}

TEST(StrokePath, GoingBackIsNotLost) {
  StrokePath path(0.5, 0.1);
  for (const double x : {0.0, 1.0, 2.0, 3.0, 2.0, 1.0, 0.0}) path.add({x, 0});
  path.end();
  const std::vector<Capsule> capsules = take_all(path);
  ASSERT_EQ(capsules.size(), 2u);
  EXPECT_EQ(capsules[0].to.x, 3);
  EXPECT_EQ(capsules[1].to.x, 0);
}

TEST(StrokePath, WaitsForEnoughButKeepsTheRest) {
  StrokePath path(0.5, 0.1);
  path.add({0, 0});
  path.add({0.3, 0});
  EXPECT_FALSE(path.take());
  path.add({0.6, 0});
  EXPECT_TRUE(path.take());
  path.add({0.7, 0});
  EXPECT_FALSE(path.take());
  path.end();
  const auto rest = path.take();
  ASSERT_TRUE(rest);
  EXPECT_NEAR(rest->length(), 0.1, 1e-12);
  EXPECT_FALSE(path.take());
  EXPECT_TRUE(path.finished());
}

TEST(StrokePath, AClickIsOneCircle) {
  StrokePath path(0.5, 0.1);
  path.add({3, 4});
  path.add({3, 4});
  EXPECT_FALSE(path.take()) << "it may become a line";
  path.end();
  const auto click = path.take();
  ASSERT_TRUE(click);
  EXPECT_EQ(click->length(), 0);
  EXPECT_EQ(click->from.x, 3);
  EXPECT_FALSE(path.take());
  EXPECT_TRUE(path.finished());
}

TEST(StrokePath, NothingIsPaintedWhereTheBrushWasLifted) {
  StrokePath path(0.5, 0.1);
  path.lift();
  path.add({0, 0});
  path.add({1, 0});
  path.lift();
  path.lift();
  path.add({50, 0});
  path.add({51, 0});
  path.end();
  const std::vector<Capsule> capsules = take_all(path);
  ASSERT_EQ(capsules.size(), 2u);
  EXPECT_EQ(capsules[0].to.x, 1);
  EXPECT_EQ(capsules[1].from.x, 50);
  EXPECT_TRUE(path.finished());
}

/// The mean depth on the axis of a pass of 60 m, away from its ends.
double mean_depth(double piece, double radius, double inner) {
  double sum = 0;
  int count = 0;
  for (double x = 20; x < 40; x += 0.01, ++count)
    for (double from = 0; from < 60; from += piece) {
      const Capsule capsule{{from, 0}, {from + piece, 0}};
      const double r = distance_to(capsule, {x, 0}) / radius;
      const double weight = r <= inner ? 1 : std::max(0.0, (1 - r) / (1 - inner));
      sum += share_of_depth(capsule, radius, inner) * weight;
    }
  return sum / count;
}

TEST(StrokePath, DepthDoesNotDependOnTheSpeedOfTheMouse) {
  for (const double inner : {0.0, 0.5, 0.9})
    for (const double piece : {0.1, 0.5, 1.0, 2.5, 10.0})
      EXPECT_NEAR(mean_depth(piece, 2, inner), 1, 0.03) << "pieces of " << piece << " m, inner " << inner;
}

TEST(StrokePath, AreasDoNotDependOnTheSpeedOfTheMouse) {
  const double radius = 2;
  for (const double piece : {0.1, 1.0, 10.0}) {
    const Capsule capsule{{0, 0}, {piece, 0}};
    const double area = 2 * radius * piece + 3.14159265358979 * radius * radius;
    EXPECT_NEAR(share_of_area(capsule, radius) * area / piece, 2 * radius, 1e-9);
  }
  EXPECT_EQ(share_of_area({{1, 1}, {1, 1}}, radius), 1);
  EXPECT_EQ(share_of_depth({{1, 1}, {1, 1}}, radius, 0.5), 1);
}

}  // namespace
