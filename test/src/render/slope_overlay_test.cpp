// The overlay `slope`, which is in degrees.

#include <gtest/gtest.h>

#include <limits>

#include "test/src/render/fields.hpp"

namespace {

using namespace render_test;

/// The colour of ground that rises by a metre in a metre, with a range of the overlay that ends at `high`.
PackedColour colour_of_45_degrees(float high) {
  TerrainLook look;
  look.materials = look.water = false;
  look.overlay = {slope_layer, 0, high, ColourMap::signal, 1};
  const auto rising = [](int x, int) { return static_cast<float>(x); };
  const TerrainBlock block = build_terrain_block(
      {BlockLayout(33, 33), 1, std::numeric_limits<float>::quiet_NaN()}, 0, 0,
      [&](const std::string& name, const CellRectangle& cells) {
        return name == "elevation" ? window_of(cells, rising) : CellWindow();
      },
      look);
  return block.ground.vertices[16 * 33 + 16].colour;
}

TEST(SlopeOverlay, IsInDegrees) {
  EXPECT_EQ(layer_style(slope_layer).unit, "deg");
  EXPECT_EQ(colour_of_45_degrees(44.9f), colour_of_45_degrees(20)) << "above the range";
  EXPECT_NE(colour_of_45_degrees(60), colour_of_45_degrees(20)) << "in the range";
}

}  // namespace
