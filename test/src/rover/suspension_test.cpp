// Wheels on the ground: pose and joints by hand, and how well they follow ground that moves.

#include "src/core/error.hpp"
#include "test/src/rover/field.hpp"

namespace desert_sim {
namespace {

using namespace test;

constexpr double radius = 0.1;

class Poses : public testing::TestWithParam<SuspensionKind> {
 protected:
  Rover rover() {
    RoverParameters p;
    p.suspension = GetParam();
    return Rover(p, {});
  }
};

TEST_P(Poses, OnFlatRockItStandsLevelToTheBit) {
  Rover r = rover();
  r.place(1, 2, 0.7, SmoothGround(flat()));
  EXPECT_EQ(r.state().pose.x, 1);
  EXPECT_EQ(r.state().pose.y, 2);
  EXPECT_NEAR(r.state().pose.z, radius, 1e-12);
  EXPECT_NEAR(r.state().pose.roll, 0, 1e-12);
  EXPECT_NEAR(r.state().pose.pitch, 0, 1e-12);
  EXPECT_NEAR(r.state().rocker, 0, 1e-12);
  EXPECT_LT(r.state().contact_error, 1e-12);
}

TEST_P(Poses, OnAPlaneItHasThePlanesSlope) {
  for (const double angle : {5.0, 15.0, 30.0}) {
    SCOPED_TRACE(angle);
    Rover r = rover();
    const SmoothGround ground(plane(angle));
    r.place(0, 0, 0, ground);  // uphill
    EXPECT_NEAR(r.state().pose.pitch, -angle * degree, 1e-6);
    EXPECT_NEAR(r.state().pose.roll, 0, 1e-6);
    r.place(0, 0, pi, ground);  // downhill
    EXPECT_NEAR(r.state().pose.pitch, angle * degree, 1e-6);
    r.place(0, 0, pi / 2, ground);  // uphill to the right: the right side is up
    EXPECT_NEAR(r.state().pose.roll, -angle * degree, 1e-6);
    EXPECT_NEAR(r.state().pose.pitch, 0, 1e-6);
    EXPECT_NEAR(r.state().rocker, 0, 1e-6);
    EXPECT_LT(r.state().contact_error, 1e-6);
  }
}

TEST_P(Poses, ADifferentialSharesTheRiseOfOneSide) {
  // The left wheels' ground is twisted: the pitch is the mean of both sides, the rockers take the
  // difference.
  const double twist = 0.2;
  Rover r = rover();
  r.place(0, 0, 0, SmoothGround([&](double x, double y) { return y > 0 ? twist * x : 0; }));
  EXPECT_NEAR(std::tan(-r.state().pose.pitch), twist / 2, 5e-3);
  EXPECT_NEAR(std::tan(-r.state().rocker), twist / 2, 5e-3);
  EXPECT_LT(r.state().contact_error, 1e-4);
}

TEST_P(Poses, ContactsStayOnGroundThatMovesByTenCentimetresASecond) {
  // Waves that rise and fall by up to 10 cm/s and travel as fast, under a rover that crosses them.
  const double speed = 0.1, length = 2.5, height = speed * length / (2 * pi * speed);
  for (const double sand : {0.0, 2.0}) {
    double time = 0;
    SmoothGround ground(
        [&](double x, double y) {
          return 0.4 * height * std::sin(2 * pi * (x + 0.3 * y - speed * time) / length);
        },
        sand, 0.3);
    Rover r = rover();
    r.place(0, 0, 0.4, ground);
    double worst = 0;
    for (; time < 20; time += Rover::internal_step) {
      r.drive({0.2, 0, 0.05}, 1);
      r.advance(Rover::internal_step, &ground);
      worst = std::max(worst, r.state().contact_error);
    }
    EXPECT_EQ(r.state().condition, RoverCondition::driving) << r.state().reason;
    EXPECT_LT(worst, 1e-3) << "sand " << sand;
  }
}

TEST_P(Poses, AStepOfTheGroundIsFollowedInOneStep) {
  double height = 0;
  SmoothGround ground([&](double, double) { return height; });
  Rover r = rover();
  r.place(0, 0, 0, ground);
  height = -0.5;
  r.advance(Rover::internal_step, &ground);
  EXPECT_NEAR(r.state().pose.z, -0.5 + radius, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Of, Poses, testing::Values(SuspensionKind::rocker, SuspensionKind::rocker_bogie),
                         [](const auto& kind) {
                           return std::string(suspension_kinds[static_cast<int>(kind.param)]);
                         });

TEST(Ground, CellsAreInterpolatedAndWrapWhereTheTerrainDoes) {
  GridGround::Layers layers;
  layers.elevation = {0, 1, 2, 3, 4, 5, 6, 7};
  const GridGround open({4, 2, 2, 10, 20, false, false}, layers),
      torus({4, 2, 2, 10, 20, true, true}, layers);
  EXPECT_EQ(open.elevation(11, 21), 0);
  EXPECT_EQ(open.elevation(12, 21), 0.5);
  EXPECT_EQ(open.elevation(12, 22), 2.5);
  EXPECT_EQ(open.elevation(10, 20), 0);  // constant beyond the outermost centres
  EXPECT_FALSE(open.elevation(9.99, 21));
  EXPECT_EQ(torus.elevation(10, 21), 1.5);  // between 3 and 0
  EXPECT_EQ(torus.elevation(11 - 8 * 3, 21 + 4 * 5), 0);
  layers.elevation[0] = NAN;
  EXPECT_FALSE(GridGround({4, 2, 2, 10, 20, false, false}, layers).elevation(11.5, 21));
}

TEST(Ground, ArraysOfTheWrongSizeAreRefused) {
  GridGround::Layers layers;
  layers.elevation = {0, 1, 2};
  EXPECT_THROW(GridGround({4, 2, 2, 0, 0, false, false}, layers), ConfigError);
}

}  // namespace
}  // namespace desert_sim
