// Strokes of a brush as capsules: nothing of the path is lost, and its pace does not matter.

#include "src/render/stroke_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
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

TEST(StrokePath, IsCutInTheSameWayHoweverSlowlyItIsTaken) {
  std::vector<std::vector<double>> lengths;
  for (const int places_between_calls : {1, 7, 1000}) {
    StrokePath path(0.5, 0.1);
    lengths.emplace_back();
    const auto take = [&](const std::vector<Capsule>& capsules) {
      for (const Capsule& capsule : capsules) lengths.back().push_back(capsule.length());
    };
    for (int n = 0; n <= 250; ++n) {
      path.add({0.03 * n, 0.04 * n});
      if (n % places_between_calls == 0) take(take_all(path));
    }
    path.end();
    take(take_all(path));
    ASSERT_EQ(lengths.back().size(), 25u) << places_between_calls;
    for (const double length : lengths.back()) EXPECT_NEAR(length, 0.5, 1e-9);
  }
}

TEST(StrokePath, AJumpOfTheMouseIsCutToo) {
  StrokePath path(0.5, 0.1);
  path.add({0, 0});
  path.add({4.2, 0});
  EXPECT_EQ(take_all(path).size(), 8u);
  path.end();
  EXPECT_NEAR(take_all(path).at(0).length(), 0.2, 1e-9);
}

TEST(StrokePath, NoMoreThanSixtyFourPiecesWait) {
  StrokePath path(0.5, 0.1);
  path.add({0, 0});
  path.add({1e5, 0});
  path.end();
  const std::vector<Capsule> capsules = take_all(path);
  EXPECT_NEAR(capsules.front().length(), 1e5 / 64, 1e-6);
  EXPECT_LT(capsules.size(), 1000u) << "shorter as fewer wait";
  expect_complete(capsules, {{0, 0}, {1e5, 0}}, 0.1);
}

TEST(StrokePath, GoingBackIsNotLost) {
  StrokePath path(5, 0.1);
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
  path.add({0.5, 0});
  EXPECT_TRUE(path.take());
  path.add({0.6, 0});
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
  ASSERT_EQ(capsules.size(), 4u);
  EXPECT_EQ(capsules[1].to.x, 1);
  EXPECT_EQ(capsules[2].from.x, 50);
  EXPECT_TRUE(path.finished());
}

/// The least and the greatest depth on the axis of a pass of 60 m, away from its ends.
std::pair<double, double> depths(double piece, double radius, double inner) {
  std::pair<double, double> range{1e9, 0};
  for (double x = 20; x < 40; x += 0.01) {
    double sum = 0;
    for (double from = 0; from < 60; from += piece) {
      const Capsule capsule{{from, 0}, {from + piece, 0}};
      const double r = distance_to(capsule, {x, 0}) / radius;
      const double weight = r <= inner ? 1 : std::max(0.0, (1 - r) / (1 - inner));
      sum += share_of_depth(capsule, radius, inner) * weight;
    }
    range = {std::min(range.first, sum), std::max(range.second, sum)};
  }
  return range;
}

TEST(StrokePath, PiecesOfHalfARadiusGiveAnEvenDepth) {
  for (const double inner : {0.0, 0.5}) {
    EXPECT_NEAR(depths(1, 2, inner).first, 1, 1e-6) << inner;
    EXPECT_NEAR(depths(1, 2, inner).second, 1, 1e-6) << inner;
    EXPECT_GT(depths(20, 2, inner).second, 1.5) << "long pieces do not";
  }
  EXPECT_NEAR(depths(1, 2, 0.9).first, 0.83, 0.01) << "a hard brush hardly";
  EXPECT_NEAR(depths(1, 2, 0.9).second, 1.04, 0.01);
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
