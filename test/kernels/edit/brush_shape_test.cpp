// The shapes of a brush by hand, on a small grid: rectangle, polygon, capsule, patch, smooth; soil; borders.

#include <cmath>
#include <limits>

#include "test/support/edits.hpp"

namespace desert_sim {
namespace {

using command::EditTerrain;
using test::edit_at;

/// 20 × 16 cells of half a metre with the corner at (100, −50); two metres of sand on rock at 30 m.
class BrushShapes : public test::OnBackend {
 protected:
  void SetUp() override {
    OnBackend::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    s = world("periodic");
  }
  std::unique_ptr<Simulation> world(const std::string& boundary, const std::string& more = "") {
    return simulation(test::edit_world(boundary, more));
  }
  double value(Layer layer, int x, int y) {
    return s->terrain().values(layer)[static_cast<std::size_t>(y * 20 + x)];
  }
  double sand(int x, int y) { return value(Layer::sand, x, y); }
  std::string refusal(const EditTerrain& e) { return test::refusal(*s, e); }

  std::unique_ptr<Simulation> s;
};

TEST_P(BrushShapes, ARectangleCoversItsHalfSidesAndFallsOffFromItsInnerPart) {
  EditTerrain e = edit_at(10, 8, BrushShape::rectangle);
  e.radius = 0.5 * 4.2;
  e.radius_y = 0.5 * 2.2;
  e.inner = 1;
  s->apply(e);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 20; ++x)
      EXPECT_EQ(sand(x, y), std::abs(x - 10) <= 4 && std::abs(y - 8) <= 2 ? 3 : 2) << x << ", " << y;
  s = world("periodic");
  e.radius = e.radius_y = 0.5 * 4;
  e.inner = 0.5;
  s->apply(e);
  EXPECT_EQ(sand(12, 8), 3);
  EXPECT_NEAR(sand(13, 8), 2.5, 1e-6) << "r = 3/4";
  EXPECT_NEAR(sand(13, 11), 2.5, 1e-6) << "on the diagonal too";
  EXPECT_NEAR(sand(14, 8), 2, 1e-6);
}

TEST_P(BrushShapes, ARectangleIsTurned) {
  EditTerrain e = edit_at(10, 8, BrushShape::rectangle);
  e.radius = 0.5 * 6;
  e.radius_y = 0.5 * 1;
  e.inner = 1;
  e.angle_deg = 45;
  s->apply(e);
  EXPECT_EQ(sand(14, 12), 3) << "u = 5.7";
  EXPECT_EQ(sand(15, 13), 2) << "u = 7.1";
  EXPECT_EQ(sand(6, 4), 3);
  EXPECT_EQ(sand(11, 8), 3) << "v = 0.7";
  EXPECT_EQ(sand(12, 8), 2) << "v = 1.4";
  EXPECT_EQ(sand(14, 4), 2) << "the other diagonal";
}

TEST_P(BrushShapes, APolygonIsFilledByTheEvenOddRule) {
  // An L: 8 × 8 cells without its upper right quarter.
  EditTerrain e = edit_at(0, 0, BrushShape::polygon);
  e.points = {{101, -49}, {105, -49}, {105, -47}, {103, -47}, {103, -45}, {101, -45}};
  s->apply(e);
  int raised = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 20; ++x) {
      const bool inside = x >= 2 && y >= 2 && x < 10 && y < 10 && !(x >= 6 && y >= 6);
      EXPECT_EQ(sand(x, y), inside ? 3 : 2) << x << ", " << y;
      raised += inside;
    }
  EXPECT_EQ(raised, 48);
  // The other way round, and beginning elsewhere, it is the same.
  const auto once = s->terrain().raw_words(Layer::sand);
  s = world("periodic");
  e.points = {{103, -45}, {103, -47}, {105, -47}, {105, -49}, {101, -49}, {101, -45}};
  s->apply(e);
  EXPECT_TRUE(once == s->terrain().raw_words(Layer::sand));
  // A bow tie has two insides.
  s = world("periodic");
  e.points = {{101, -49}, {105, -45}, {105, -49}, {101, -45}};
  s->apply(e);
  EXPECT_EQ(sand(3, 5), 3);
  EXPECT_EQ(sand(9, 5), 3);
  EXPECT_EQ(sand(5, 2), 2);
  EXPECT_EQ(sand(5, 9), 2);
}

TEST_P(BrushShapes, APolygonRisesFromItsEdgeOverItsFalloff) {
  EditTerrain e = edit_at(0, 0, BrushShape::polygon);
  e.points = {{101, -49}, {107, -49}, {107, -43}, {101, -43}};  // cells 2 … 13
  e.falloff = 2;                                                // four cells
  s->apply(e);
  for (int d = 0; d < 6; ++d) {
    const double weight = std::min(1.0, (d + 0.5) / 4);
    EXPECT_NEAR(sand(2 + d, 8), 2 + weight, 1e-6) << d;
    EXPECT_NEAR(sand(8, 13 - d), 2 + weight, 1e-6) << d;
  }
  EXPECT_NEAR(sand(3, 3), 2 + 1.5 / 4, 1e-6) << "in the corner the nearer edge counts";
  EXPECT_EQ(sand(1, 8), 2);
}

TEST_P(BrushShapes, ACapsuleIsAStrokeWithRoundEnds) {
  EditTerrain e = edit_at(0, 0, BrushShape::capsule);
  e.points = {{102.25, -45.75}, {106.25, -45.75}};  // centres of the cells (4, 8) and (12, 8)
  e.radius = 0.5 * 2.5;
  e.inner = 1;
  s->apply(e);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 20; ++x) {
      const int dx = x < 4 ? 4 - x : (x > 12 ? x - 12 : 0), dy = y - 8;
      EXPECT_EQ(sand(x, y), dx * dx + dy * dy <= 6.25 ? 3 : 2) << x << ", " << y;
    }
  s = world("periodic");
  e.inner = 0;
  s->apply(e);
  EXPECT_NEAR(sand(7, 8), 3, 1e-6);
  EXPECT_NEAR(sand(7, 9), 2.6, 1e-6) << "1 − 1/2.5";
  // Both ends in one place: a circle.
  s = world("periodic");
  e.points[1] = e.points[0];
  s->apply(e);
  const auto dot = s->terrain().raw_words(Layer::sand);
  s = world("periodic");
  EditTerrain circle = edit_at(4, 8, BrushShape::circle);
  circle.radius = e.radius;
  s->apply(circle);
  EXPECT_TRUE(dot == s->terrain().raw_words(Layer::sand));
}

TEST_P(BrushShapes, APatchLiesAsAPictureDoes) {
  EditTerrain e = edit_at(0, 0, BrushShape::patch);
  e.x = 105;
  e.y = -46;
  e.radius = 1.5;  // six cells wide, four high, of which the picture has as many
  e.radius_y = 1;
  e.value = 0.25;
  e.patch = {6, 4, {}};
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 6; ++column)
      e.patch.values.push_back(static_cast<float>(column + 10 * row) / 64);
  s->apply(e);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 6; ++column)
      EXPECT_NEAR(sand(7 + column, 9 - row), 2.25 + (column + 10 * row) / 64.0, 1e-6)
          << column << ", " << row;
  EXPECT_EQ(sand(6, 8), 2);
  EXPECT_EQ(sand(13, 8), 2);
  // Turned by a quarter to the left, the top row stands at the west.
  s = world("periodic");
  e.angle_deg = 90;
  s->apply(e);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 6; ++column)
      EXPECT_NEAR(sand(8 + row, 5 + column), 2.25 + (column + 10 * row) / 64.0, 1e-6)
          << column << ", " << row;
}

TEST_P(BrushShapes, APatchIsSampledBilinearly) {
  EditTerrain e = edit_at(0, 0, BrushShape::patch);
  e.x = 105;
  e.y = -46;
  e.radius = e.radius_y = 2;  // eight cells for two values: centres of the values at 2 and 6 cells
  e.value = 0;
  e.merge = BrushMerge::replace;
  e.patch = {2, 1, {1, 5}};
  s->apply(e);
  const double expected[] = {1, 1, 1.5, 2.5, 3.5, 4.5, 5, 5};
  for (int x = 0; x < 8; ++x) EXPECT_NEAR(sand(6 + x, 8), expected[x], 1e-6) << x;
}

TEST_P(BrushShapes, AMaskWeighsTheValue) {
  EditTerrain e = edit_at(0, 0, BrushShape::patch);
  e.x = 105;
  e.y = -46;
  e.radius = 1;
  e.radius_y = 0.25;
  e.patch_use = PatchUse::mask;
  e.merge = BrushMerge::replace;
  e.value = 6;
  e.patch = {4, 1, {0, 0.25, 0.5, 1}};
  s->apply(e);
  const double expected[] = {2, 3, 4, 6};
  for (int x = 0; x < 4; ++x) {
    EXPECT_NEAR(sand(8 + x, 7), expected[x], 1e-6) << x;
    EXPECT_EQ(sand(8 + x, 9), 2);
  }
}

TEST_P(BrushShapes, HeightsOfAPatchMayTakeSandAway) {
  EditTerrain e = edit_at(0, 0, BrushShape::patch);
  e.x = 105;
  e.y = -46.25;  // the middle of row 7
  e.radius = 1;
  e.radius_y = 0.25;
  e.value = 0;
  e.patch = {4, 1, {-1, -5, 1, 0}};
  const CommandResult result = s->apply(e);
  const double expected[] = {1, 0, 3, 2};
  for (int x = 0; x < 4; ++x) EXPECT_NEAR(sand(8 + x, 7), expected[x], 1e-6) << x;
  EXPECT_NEAR(result.volume_m3, (-1 - 2 + 1) * 0.25, 1e-6);
  e.merge = BrushMerge::replace;
  EXPECT_NE(refusal(e).find("depth"), std::string::npos);
}

TEST_P(BrushShapes, SmoothTakesTheMeanOfASquare) {
  EditTerrain peak = edit_at(10, 8, BrushShape::circle);
  peak.radius = 0.1;
  peak.value = 9;
  s->apply(peak);
  EditTerrain e = edit_at(10, 8, BrushShape::circle);
  e.radius = 3;
  e.inner = 1;
  e.merge = BrushMerge::smooth;
  e.smooth_radius = 0.5;
  s->apply(e);
  for (int y = 6; y <= 10; ++y)
    for (int x = 8; x <= 12; ++x)
      EXPECT_NEAR(sand(x, y), std::abs(x - 10) <= 1 && std::abs(y - 8) <= 1 ? 3 : 2, 1e-6) << x << ", " << y;
  // A second pass makes 1, 2, 3, 2, 1 ninths along each axis of it.
  s = world("periodic");
  s->apply(peak);
  e.smooth_passes = 2;
  s->apply(e);
  EXPECT_NEAR(sand(10, 8), 2 + 9.0 * 9 / 81, 1e-5);
  EXPECT_NEAR(sand(11, 8), 2 + 9.0 * 6 / 81, 1e-5);
  EXPECT_NEAR(sand(12, 10), 2 + 9.0 * 1 / 81, 1e-5);
  EXPECT_EQ(sand(13, 8), 2);
  test::expect_sound(*s, "after smoothing");
}

TEST_P(BrushShapes, SmoothLeavesAPlainAsItIsAtEveryBorder) {
  for (const char* boundary : {"periodic", "open"}) {
    s = world(boundary);
    const auto before = s->terrain().raw_words(Layer::sand);
    EditTerrain e = edit_at(0, 0, BrushShape::rectangle);
    e.radius = e.radius_y = 100;
    e.merge = BrushMerge::smooth;
    e.smooth_radius = 7;
    e.smooth_passes = 3;
    e.inner = 1;
    s->apply(e);
    EXPECT_TRUE(before == s->terrain().raw_words(Layer::sand)) << boundary;
  }
}

TEST_P(BrushShapes, SoilIsEditedWhereThereIsSome) {
  EditTerrain e = edit_at(10, 8, BrushShape::circle);
  e.layer = "soil";
  e.inner = 1;
  EXPECT_NE(refusal(e).find("soil"), std::string::npos);
  s = world("periodic", ", uniform: {layer: soil, value: 1}");
  s->apply(e);
  EXPECT_NEAR(value(Layer::soil, 10, 8), 2, 1e-6);
  e.merge = BrushMerge::sub;
  e.value = 7;
  s->apply(e);
  EXPECT_EQ(value(Layer::soil, 10, 8), 0);
  EXPECT_EQ(sand(10, 8), 2);
  test::run(*s, 2);
  test::expect_sound(*s, "after edits of soil");
}

TEST_P(BrushShapes, EveryShapeWrapsOverPeriodicBorders) {
  for (const EditTerrain& inside : test::one_of_each_shape()) {
    s = world("periodic");
    s->apply(inside);
    const auto here = s->terrain().raw_words(Layer::sand);
    s = world("periodic");
    s->apply(test::shifted(inside, 10 * 0.5, 9 * 0.5));  // over both borders
    const auto there = s->terrain().raw_words(Layer::sand);
    const char* name = brush_shapes[static_cast<int>(inside.shape)];
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 20; ++x)
        ASSERT_NEAR(static_cast<double>(here[static_cast<std::size_t>(y * 20 + x)]),
                    static_cast<double>(there[static_cast<std::size_t>((y + 9) % 16 * 20 + (x + 10) % 20)]),
                    2)
            << name << " " << x << ", " << y;
  }
}

TEST_P(BrushShapes, ThatReachAroundATorusAreRefused) {
  EditTerrain e = edit_at(0, 0, BrushShape::polygon);
  e.points = {{100, -50}, {111, -50}, {105, -45}};
  EXPECT_NE(refusal(e).find("11.0"), std::string::npos);
  e = edit_at(0, 0, BrushShape::capsule);
  e.points = {{100, -50}, {101, -40}};
  refusal(e);
  e = test::one_of_each_shape().back();
  e.angle_deg = 0;
  e.radius = 6;
  refusal(e);
  e.radius = 5;
  e.radius_y = 4;
  EXPECT_NO_THROW(s->apply(e)) << "just as large as the torus";
  s = world("open");
  e.radius = e.radius_y = 1000;
  EXPECT_NO_THROW(s->apply(e)) << "on an open terrain";
}

DESERT_ON_EACH_BACKEND(BrushShapes);

}  // namespace
}  // namespace desert_sim
