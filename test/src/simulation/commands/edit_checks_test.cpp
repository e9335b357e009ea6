// Edits that are refused: what is wrong is named, and nothing has changed.

#include <limits>

#include "test/support/edits.hpp"

namespace desert_sim {
namespace {

using command::EditTerrain;
using test::edit_at;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();

class EditRefusals : public test::OnBackend {
 protected:
  void SetUp() override {
    OnBackend::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    s = simulation(test::edit_world("periodic"));
  }
  /// The edit of this shape, spoiled, is refused, and the reason names `what`.
  void refused(BrushShape shape, const std::function<void(EditTerrain&)>& spoil, const std::string& what) {
    EditTerrain e = test::one_of_each_shape()[static_cast<std::size_t>(shape)];
    spoil(e);
    const std::string reason = test::refusal(*s, e);
    EXPECT_NE(reason.find(what), std::string::npos) << "no '" << what << "' in: " << reason;
  }

  std::unique_ptr<Simulation> s;
};

TEST_P(EditRefusals, TheShapesTheyAreMadeOfAreGood) {
  for (const EditTerrain& e : test::one_of_each_shape()) EXPECT_NO_THROW(s->apply(e));
}

TEST_P(EditRefusals, OfPolygons) {
  const auto spoiled = [&](const std::function<void(EditTerrain&)>& spoil, const std::string& what) {
    refused(BrushShape::polygon, spoil, what);
  };
  spoiled([](auto& e) { e.points.clear(); }, "points: 0 are given (allowed for this shape: 3 to 512)");
  spoiled([](auto& e) { e.points.resize(2); }, "points: 2 are given");
  spoiled([](auto& e) { e.points.resize(513); }, "points: 513 are given");
  spoiled([](auto& e) { e.points[1].x = not_a_number; }, "points[1]: nan");
  spoiled([](auto& e) { e.points[2].y = -infinity; }, "points[2]: -inf");
  spoiled([](auto& e) { e.points[2].y = 1e9; }, "points[2]: 1e+09");
  spoiled([](auto& e) { e.points.assign(5, {101, -49}); }, "one line");
  spoiled([](auto& e) { e.points = {{101, -49}, {103, -47}, {102, -48}}; }, "one line");
  spoiled([](auto& e) { e.falloff = -1; }, "falloff: -1");
  spoiled([](auto& e) { e.falloff = not_a_number; }, "falloff: nan");
  spoiled([](auto& e) { e.shape = BrushShape::circle; }, "points: 5 are given (allowed for this shape: 0)");
}

TEST_P(EditRefusals, OfOtherShapes) {
  refused(
      BrushShape::capsule, [](auto& e) { e.points.pop_back(); }, "points: 1 are given");
  refused(
      BrushShape::capsule,
      [](auto& e) {
        e.points.push_back({102, -48});
      },
      "points: 3 are given");
  refused(
      BrushShape::capsule, [](auto& e) { e.radius = 0; }, "radius: 0");
  refused(
      BrushShape::rectangle, [](auto& e) { e.radius_y = -2; }, "radius_y: -2");
  refused(
      BrushShape::rectangle, [](auto& e) { e.angle_deg = infinity; }, "angle_deg: inf");
  refused(
      BrushShape::circle, [](auto& e) { e.shape = static_cast<BrushShape>(6); }, "shape: 6");
  refused(
      BrushShape::circle, [](auto& e) { e.layer = "elevation"; }, "'elevation' is not one of");
}

TEST_P(EditRefusals, OfPatches) {
  const auto spoiled = [&](const std::function<void(EditTerrain&)>& spoil, const std::string& what) {
    refused(BrushShape::patch, spoil, what);
  };
  spoiled([](auto& e) { e.patch = {}; }, "patch: 0 x 0 with 0 values");
  spoiled([](auto& e) { e.patch.values.pop_back(); }, "patch: 5 x 3 with 14 values");
  spoiled([](auto& e) { e.patch.columns = -5, e.patch.rows = -3; }, "patch: -5 x -3");
  spoiled([](auto& e) { e.patch.values[7] = std::numeric_limits<float>::quiet_NaN(); },
          "column 2, row 1: nan");
  spoiled([](auto& e) { e.patch.values[4] = 2e5f; }, "column 4, row 0: 200000");
  spoiled([](auto& e) { e.patch_use = PatchUse::mask; }, "is not in [0, 1]");
  spoiled([](auto& e) { e.patch = {2048, 1024, std::vector<float>(2048 * 1024)}; }, "1048576");
  spoiled([](auto& e) { e.shape = BrushShape::circle; }, "the shape is not patch");
}

TEST_P(EditRefusals, OfSmoothingAndRings) {
  refused(
      BrushShape::circle, [](auto& e) { e.merge = BrushMerge::smooth, e.smooth_radius = 33; },
      "smooth_radius: 33");
  refused(
      BrushShape::circle, [](auto& e) { e.smooth_radius = not_a_number; }, "smooth_radius: nan");
  refused(
      BrushShape::circle, [](auto& e) { e.smooth_passes = 0; }, "smooth_passes: 0");
  refused(
      BrushShape::circle, [](auto& e) { e.smooth_passes = 1000000; }, "smooth_passes: 1e+06");
  refused(
      BrushShape::circle, [](auto& e) { e.ring_width = -1; }, "ring_width: -1");
  refused(
      BrushShape::circle, [](auto& e) { e.conserve = true, e.ring_width = 0.01; }, "no cell");
  refused(
      BrushShape::circle, [](auto& e) { e.conserve = true, e.radius = 100, e.inner = 1; }, "no cell");
  refused(
      BrushShape::circle, [](auto& e) { e.conserve = true, e.value = 50; }, "m^3 of sand");
}

TEST_P(EditRefusals, OfWhatWouldHoldUpTheSimulation) {
  s = simulation("grid: {width: 1500, height: 1500, cell_size: 1, boundary: open}\n");
  EditTerrain e;
  e.merge = BrushMerge::smooth;
  e.smooth_radius = 64;
  e.smooth_passes = 16;
  e.radius = 700;
  e.x = e.y = 750;
  EXPECT_NE(test::refusal(*s, e).find("1960000 cells, too many to smooth"), std::string::npos);
  e.merge = BrushMerge::add;
  e.shape = BrushShape::polygon;
  for (int n = 0; n < 512; ++n) e.points.push_back({n % 2 ? 100.0 : 1500.0, n * 1500.0 / 511});
  EXPECT_NE(test::refusal(*s, e).find("2100000 cells, too many for a polygon of 512 points"),
            std::string::npos);
}

DESERT_ON_EACH_BACKEND(EditRefusals);

}  // namespace
}  // namespace desert_sim
