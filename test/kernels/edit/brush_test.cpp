// Brushes: shapes, falloff, merges, borders, what is refused.

#include <limits>

#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class BrushEdit : public test::OnBackend {
 protected:
  void SetUp() override {
    OnBackend::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    s = world("periodic");
  }
  std::unique_ptr<Simulation> world(const std::string& boundary) {
    return simulation(
        "grid: {width: 20, height: 16, cell_size: 0.5, origin_x: 100, origin_y: -50, boundary: " + boundary +
        "}\nterrain: [uniform: {layer: bedrock, value: 30}, uniform: {layer: sand, value: 2}]\n");
  }
  /// A brush at the centre of cell (x, y), radius in cells.
  static command::EditTerrain brush_at(int x, int y, double cells, double value,
                                       BrushMerge merge = BrushMerge::add) {
    command::EditTerrain e;
    e.x = 100 + 0.5 * (x + 0.5);
    e.y = -50 + 0.5 * (y + 0.5);
    e.radius = 0.5 * cells;
    e.value = value;
    e.merge = merge;
    return e;
  }
  double sand(int x, int y) { return s->terrain().values(Layer::sand)[static_cast<std::size_t>(y * 20 + x)]; }
  double bedrock(int x, int y) {
    return s->terrain().values(Layer::bedrock)[static_cast<std::size_t>(y * 20 + x)];
  }
  std::string refusal(const command::EditTerrain& e) {
    const std::uint64_t before = s->state().hash();
    std::string reason;
    try {
      s->apply(e);
      ADD_FAILURE() << "was not refused";
    } catch (const ConfigError& error) {
      reason = error.what();
    }
    EXPECT_EQ(before, s->state().hash()) << "refused, but changed something";
    return reason;
  }

  std::unique_ptr<Simulation> s;
};

TEST_P(BrushEdit, FallsOffLinearlyFromItsInnerPartToItsEdge) {
  command::EditTerrain e = brush_at(10, 8, 5, 1);
  e.inner = 0.4;
  s->apply(e);
  for (int d = 0; d < 8; ++d) {
    const double r = d / 5.0, weight = r > 1 ? 0 : (r <= 0.4 ? 1 : (1 - r) / 0.6);
    EXPECT_NEAR(sand(10 + d, 8), 2 + weight, 1e-6) << d;
    EXPECT_NEAR(sand(10, 8 - d), 2 + weight, 1e-6) << d;
  }
  EXPECT_EQ(sand(14, 12), 2) << "outside the circle";
  EXPECT_NEAR(sand(13, 12), 2, 1e-6) << "on its edge";
}

TEST_P(BrushEdit, OfInnerOneHasAHardEdge) {
  command::EditTerrain e = brush_at(10, 8, 2.5, 1);
  e.inner = 1;
  s->apply(e);
  int raised = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 20; ++x) {
      EXPECT_TRUE(sand(x, y) == 2 || sand(x, y) == 3);
      raised += sand(x, y) == 3;
      EXPECT_EQ(sand(x, y) == 3, (x - 10) * (x - 10) + (y - 8) * (y - 8) <= 6.25) << x << ", " << y;
    }
  EXPECT_EQ(raised, 21);
}

TEST_P(BrushEdit, MergesByWeight) {
  struct Expected {
    BrushMerge merge;
    double value, full, half;  // at weight 1 and ½, from 2
  };
  for (const Expected& e : {Expected{BrushMerge::add, 3, 5, 3.5},
                            {BrushMerge::sub, 1, 1, 1.5},
                            {BrushMerge::sub, 9, 0, 0},
                            {BrushMerge::replace, 6, 6, 4},
                            {BrushMerge::replace, 0, 0, 1},
                            {BrushMerge::min, 1, 1, 1.5},
                            {BrushMerge::min, 5, 2, 2},
                            {BrushMerge::max, 5, 5, 3.5},
                            {BrushMerge::max, 1, 2, 2},
                            {BrushMerge::avg, 4, 3, 2.5}}) {
    s = world("periodic");
    s->apply(brush_at(6, 6, 4, e.value, e.merge));
    EXPECT_NEAR(sand(6, 6), e.full, 1e-6) << brush_merges[static_cast<int>(e.merge)] << " " << e.value;
    EXPECT_NEAR(sand(8, 6), e.half, 1e-6) << brush_merges[static_cast<int>(e.merge)] << " " << e.value;
    EXPECT_NEAR(sand(6, 11), 2, 1e-6);
  }
}

TEST_P(BrushEdit, OfBedrockIsAnElevationOrAChange) {
  command::EditTerrain e = brush_at(6, 6, 4, 31.5, BrushMerge::replace);
  e.layer = "bedrock";
  s->apply(e);
  EXPECT_NEAR(bedrock(6, 6), 31.5, 1e-5);
  e.merge = BrushMerge::add;
  e.value = -3;
  s->apply(e);
  EXPECT_NEAR(bedrock(6, 6), 28.5, 1e-5);
  EXPECT_EQ(sand(6, 6), 2);
  test::expect_sound(*s, "after edits of bedrock");
}

TEST_P(BrushEdit, OfAnEllipseIsTurned) {
  command::EditTerrain e = brush_at(10, 8, 6, 1);
  e.shape = BrushShape::ellipse;
  e.radius_y = 1;  // two cells
  e.angle_deg = 90;
  e.inner = 1;
  s->apply(e);
  EXPECT_EQ(sand(10, 13), 3);
  EXPECT_EQ(sand(10, 3), 3);
  EXPECT_EQ(sand(12, 8), 3);
  EXPECT_EQ(sand(13, 8), 2);
  s = world("periodic");
  e.angle_deg = 45;
  s->apply(e);
  EXPECT_EQ(sand(13, 11), 3);
  EXPECT_EQ(sand(7, 5), 3);
  EXPECT_EQ(sand(13, 5), 2);
}

TEST_P(BrushEdit, WrapsOverPeriodicBordersAndStopsAtOpenOnes) {
  for (const char* boundary : {"periodic", "open"}) {
    s = world(boundary);
    const CommandResult result = s->apply(brush_at(0, 0, 3, 1));
    const bool periodic = std::string(boundary) == "periodic";
    EXPECT_NEAR(sand(0, 0), 3, 1e-6);
    EXPECT_EQ(sand(19, 0) > 2, periodic);
    EXPECT_EQ(sand(0, 15) > 2, periodic);
    EXPECT_EQ(sand(19, 15) > 2, periodic);
    EXPECT_EQ(sand(10, 8), 2);
    EXPECT_LE(result.changed_cells.x0, 0);
    EXPECT_GE(result.changed_cells.x1, periodic ? 20 : 3);
    EXPECT_LE(result.changed_cells.x1, 20);
    EXPECT_LE(result.changed_cells.y1, 16);
  }
}

TEST_P(BrushEdit, TouchesNothingOutsideTheRectangleItReports) {
  for (const char* boundary : {"periodic", "open"})
    for (const auto& [x, y, r] : {std::tuple{4, 5, 2.7}, {19, 2, 4.0}, {-3, 18, 6.0}, {10, 8, 40.0}}) {
      s = world(boundary);
      const CellRectangle t = s->apply(brush_at(x, y, r, 1)).changed_cells;
      for (int j = 0; j < 16; ++j)
        for (int i = 0; i < 20; ++i)
          EXPECT_TRUE((i >= t.x0 && i < t.x1 && j >= t.y0 && j < t.y1) || sand(i, j) == 2)
              << boundary << ": " << i << ", " << j;
    }
}

TEST_P(BrushEdit, OnATorusDoesNotDependOnWhichCopyOfTheCentreIsGiven) {
  s->apply(brush_at(3, 4, 4, 1));
  const auto here = s->terrain().raw_words(Layer::sand);
  s = world("periodic");
  s->apply(brush_at(3 - 20 * 7, 4 + 16 * 3, 4, 1));
  EXPECT_TRUE(here == s->terrain().raw_words(Layer::sand));
}

TEST_P(BrushEdit, LargerThanTheTorusTouchesEachCellOnce) {
  command::EditTerrain e = brush_at(10, 8, 1000, 1);
  e.inner = 1;
  s->apply(e);
  for (float v : s->terrain().values(Layer::sand)) EXPECT_EQ(v, 3.0f);
}

TEST_P(BrushEdit, ReportsTheVolumeThatItChanged) {
  command::EditTerrain e = brush_at(10, 8, 2.5, 1);
  e.inner = 1;
  EXPECT_NEAR(s->apply(e).volume_m3, 21 * 0.25, 1e-6);
  e.merge = BrushMerge::sub;
  e.value = 100;
  EXPECT_NEAR(s->apply(e).volume_m3, -21 * 0.25 * 3, 1e-6) << "no more than there is";
  EXPECT_EQ(sand(10, 8), 0);
  const auto balance = s->state().balance()[static_cast<std::size_t>(Material::sand)];
  EXPECT_EQ(balance.residual(), 0);
  EXPECT_NEAR(balance.cubic_metres(balance.in), 21 * 0.25, 1e-6);
  EXPECT_NEAR(balance.cubic_metres(balance.out), 63 * 0.25, 1e-6);
}

TEST_P(BrushEdit, BeyondTheTerrainsHeightsIsRefusedWithTheValue) {
  const std::string reason = refusal(brush_at(6, 6, 3, 5000));
  EXPECT_NE(reason.find("5000"), std::string::npos) << reason;
  EXPECT_NE(reason.find("value"), std::string::npos) << reason;
  command::EditTerrain e = brush_at(6, 6, 3, -5000, BrushMerge::replace);
  e.layer = "bedrock";
  refusal(e);
  // Many edits in a row must not creep beyond the limit either.
  int done = 0;
  try {
    for (; done < 100; ++done) s->apply(brush_at(6, 6, 3, 100));
  } catch (const ConfigError&) {
  }
  EXPECT_LT(done, 10);
  test::run(*s, 2);
  test::expect_sound(*s, "after edits up to the limit");
}

TEST_P(BrushEdit, IsRefusedWithWhatIsWrong) {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  const auto with = [](const std::function<void(command::EditTerrain&)>& change) {
    command::EditTerrain e = brush_at(6, 6, 3, 1);
    change(e);
    return e;
  };
  const auto names = [&](const command::EditTerrain& e, const std::string& key) {
    const std::string reason = refusal(e);
    EXPECT_NE(reason.find(key), std::string::npos) << reason;
  };
  names(with([](command::EditTerrain& e) { e.layer = "water"; }), "layer");
  names(with([](command::EditTerrain& e) { e.layer = ""; }), "layer");
  names(with([](command::EditTerrain& e) { e.radius = 0; }), "radius");
  names(with([](command::EditTerrain& e) { e.radius = -1; }), "radius");
  names(with([](command::EditTerrain& e) { e.radius_y = 0; }), "radius_y");
  names(with([&](command::EditTerrain& e) { e.radius = nan; }), "radius");
  names(with([&](command::EditTerrain& e) { e.value = nan; }), "value");
  names(with([&](command::EditTerrain& e) { e.x = infinity; }), "x");
  names(with([](command::EditTerrain& e) { e.inner = 1.1; }), "inner");
  names(with([](command::EditTerrain& e) { e.value = -1; }), "value");
  names(with([](command::EditTerrain& e) { e.merge = static_cast<BrushMerge>(17); }), "merge");
  names(with([](command::EditTerrain& e) { e.shape = static_cast<BrushShape>(-1); }), "shape");
}

TEST_P(BrushEdit, ThatTouchesNoCellIsRefused) {
  s = world("open");
  command::EditTerrain e = brush_at(60, 6, 3, 1);
  refusal(e);
}

DESERT_ON_EACH_BACKEND(BrushEdit);

}  // namespace
}  // namespace desert_sim
