// Colours, overlays, plants, wind and what changes are compared with.

#include "src/render/terrain_colours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/render/change_reference.hpp"
#include "src/render/plant_shapes.hpp"
#include "src/render/wind_arrows.hpp"
#include "test/src/render/fields.hpp"

namespace {

using namespace render_test;

float brightness(const Colour& c) { return c.r + c.g + c.b; }

TEST(TerrainColours, TellMaterialsApart) {
  SurfaceMaterials sand, rock, soil, wet;
  sand.sand = 1;
  soil.soil = 1;
  wet.sand = 1;
  wet.moisture = 0.1f;
  EXPECT_GT(ground_colour(sand).r, ground_colour(sand).b + 0.3f);
  EXPECT_LT(ground_colour(rock).r - ground_colour(rock).b, 0.15f);
  EXPECT_LT(brightness(ground_colour(soil)), brightness(ground_colour(rock)));
  EXPECT_LT(brightness(ground_colour(wet)), 0.7f * brightness(ground_colour(sand)));
  SurfaceMaterials hard = rock;
  hard.resistance = 1;
  EXPECT_LT(brightness(ground_colour(hard)), brightness(ground_colour(rock)));
  SurfaceMaterials grown = sand;
  grown.vegetation = 1;
  EXPECT_GT(ground_colour(grown).g, ground_colour(grown).r);
  EXPECT_LT(brightness(water_colour(10)), brightness(water_colour(0.1f)));
  EXPECT_LT(water_opacity(0.02f), water_opacity(0.1f));
}

TEST(TerrainColours, UnknownMaterialsCountAsAbsent) {
  SurfaceMaterials m;
  m.sand = m.moisture = m.vegetation = unknown;
  const Colour colour = ground_colour(m), rock = ground_colour({});
  EXPECT_EQ(colour.r, rock.r);
  EXPECT_EQ(colour.g, rock.g);
}

/// A block of 33 × 33 cells of a terrain that has these layers.
TerrainBlock block_with(const std::map<std::string, Height>& layers, const TerrainLook& look, int reach = 0) {
  const BlockLayout layout(33, 33);
  return build_terrain_block(
      {layout, 1, std::numeric_limits<float>::quiet_NaN(), reach}, 0, 0,
      [&](const std::string& name, const CellRectangle& cells) {
        const auto found = layers.find(name);
        return found == layers.end() ? CellWindow() : window_of(cells, found->second);
      },
      look);
}

// Complaint 3: a crash on a missing layer.
TEST(Complaint3, AMissingLayerLeavesTheGroundAsItIs) {
  const std::map<std::string, Height> layers{{"elevation", dunes}};
  TerrainLook look;
  const TerrainBlock plain = block_with(layers, look);
  for (const char* layer : {"wind_shadow", "no_such_layer"}) {
    look.overlay = {layer, 0, 1, ColourMap::signal, 1};
    const TerrainBlock shown = block_with(layers, look);
    ASSERT_EQ(shown.ground.vertices.size(), plain.ground.vertices.size());
    for (std::size_t n = 0; n < plain.ground.vertices.size(); ++n)
      EXPECT_EQ(shown.ground.vertices[n].colour, plain.ground.vertices[n].colour);
  }
  EXPECT_TRUE(plain.water.empty());
}

TEST(Overlay, ShowsValuesInItsRangeAndNothingWhereTheyAreUnknown) {
  TerrainLook look;
  look.overlay = {"moisture", 0, 10, ColourMap::sequential, 1};
  look.materials = false;
  const std::map<std::string, Height> layers{
      {"elevation", [](int, int) { return 0.0f; }},
      {"moisture", [](int x, int) { return x == 7 ? unknown : static_cast<float>(x); }}};
  const TerrainBlock block = block_with(layers, look);
  SurfaceMaterials sand;
  sand.sand = 1;
  for (const Vertex& v : block.ground.vertices) {
    const int x = static_cast<int>(v.x);
    const Colour expected =
        x == 7 ? ground_colour(sand) : colour_of(ColourMap::sequential, static_cast<float>(x) / 10);
    EXPECT_EQ(v.colour, pack(expected)) << x;
  }
}

/// Equal but for the rounding of mixtures.
void expect_alike(const Colour& a, const Colour& b) {
  EXPECT_NEAR(a.r, b.r, 1e-6f);
  EXPECT_NEAR(a.g, b.g, 1e-6f);
  EXPECT_NEAR(a.b, b.b, 1e-6f);
}

TEST(TerrainColours, AreThoseOfThePalette) {
  Palette palette;
  float n = 0;
  for (const NamedColour& one : palette_colours) palette.*one.colour = {0.1f * ++n, 0, 1 - 0.1f * n};
  SurfaceMaterials m;
  m.sand = 1;
  expect_alike(ground_colour(m, palette), palette.sand);
  m = {};
  m.soil = 1;
  expect_alike(ground_colour(m, palette), palette.soil);
  m = {};
  m.resistance = 0;
  expect_alike(ground_colour(m, palette), palette.weak_rock);
  m.resistance = 1;
  expect_alike(ground_colour(m, palette), palette.hard_rock);
  m.obstacle = 1;
  expect_alike(ground_colour(m, palette), palette.obstacle);
  m = {};
  m.vegetation = 1;
  const Colour grown = ground_colour(m, palette);
  EXPECT_EQ(pack(grown),
            pack(mix(mix(palette.weak_rock, palette.hard_rock, 0.5f), palette.vegetation, 0.9f)));
  expect_alike(water_colour(0, palette), palette.shallow_water);
  expect_alike(water_colour(1000, palette), palette.deep_water);
}

constexpr auto level = [](int, int) { return 0.0f; };

/// The colours of the vertices in the row of cell 16, by column.
std::vector<PackedColour> row_of(const TerrainBlock& block) {
  std::vector<PackedColour> colours(33);
  for (const Vertex& v : block.ground.vertices)
    if (static_cast<int>(v.y) == 16) colours[static_cast<std::size_t>(v.x)] = v.colour;
  return colours;
}

TEST(Overlay, TwoLieOnEachOtherOrStandSideBySide) {
  TerrainLook look;
  look.materials = false;
  look.overlay = {"moisture", 0, 1, ColourMap::sequential, 1};
  look.second = {"vegetation", 0, 1, ColourMap::signal, 0.25f};
  const std::map<std::string, Height> layers{{"elevation", level},
                                             {"moisture", [](int, int) { return 0.0f; }},
                                             {"vegetation", [](int, int) { return 1.0f; }}};
  const Colour first = colour_of(ColourMap::sequential, 0), second = colour_of(ColourMap::signal, 1);
  for (const PackedColour colour : row_of(block_with(layers, look)))
    EXPECT_EQ(colour, pack(mix(first, second, 0.25f)));
  look.second.opacity = 1;
  look.divide = 0.25;
  const std::vector<PackedColour> beside = row_of(block_with(layers, look));
  for (std::size_t x = 0; x < beside.size(); ++x) EXPECT_EQ(beside[x], pack(x < 8 ? first : second)) << x;
  const std::vector<std::string> needed = layers_for(look);
  EXPECT_EQ(std::count(needed.begin(), needed.end(), "moisture"), 1);
  EXPECT_EQ(std::count(needed.begin(), needed.end(), "vegetation"), 1);
}

TEST(Shading, IlluminationDarkensTheGroundAloneOrWithTheSun) {
  const std::map<std::string, Height> layers{
      {"elevation", [](int x, int) { return -0.3f * static_cast<float>(x); }},
      {"illumination", [](int x, int) { return x == 5 ? unknown : 0.5f; }}};
  TerrainLook look;
  look.materials = look.shadows = false;
  const std::vector<PackedColour> sunny = row_of(block_with(layers, look));
  SurfaceMaterials sand;
  sand.sand = 1;
  const Colour bright = ground_colour(sand);
  look.shading = Shading::illumination;
  const std::vector<PackedColour> shaded = row_of(block_with(layers, look));
  EXPECT_EQ(shaded[9], pack({0.5f * bright.r, 0.5f * bright.g, 0.5f * bright.b}));
  EXPECT_EQ(shaded[5], pack(bright)) << "unknown light is as in the open";
  look.shading = Shading::both;
  const std::vector<PackedColour> both = row_of(block_with(layers, look));
  EXPECT_EQ(both[5], sunny[5]);
  EXPECT_NEAR(static_cast<float>(both[9] & 255), 0.5f * static_cast<float>(sunny[9] & 255), 1);
  EXPECT_EQ(layers_for(look).back(), "illumination");
}

TEST(Overlay, RangesMayGoDown) {
  const Overlay overlay{"traversability", 1, 0, ColourMap::signal, 1};
  EXPECT_EQ(overlay.share(1), 0);
  EXPECT_EQ(overlay.share(0.25f), 0.75f);
  EXPECT_EQ(overlay.share(-3), 1);
  const ValueRange range = range_of({unknown, 3, -2, unknown});
  EXPECT_EQ(range.low, -2);
  EXPECT_EQ(range.high, 3);
  EXPECT_EQ(range_of({unknown}).high, 1);
}

TEST(TerrainBlock, HasWaterWhereThereIsSome) {
  const std::map<std::string, Height> layers{
      {"elevation", [](int, int) { return 0.0f; }},
      {"water_depth", [](int x, int) { return x < 10 ? 2.0f : 0.0f; }}};
  TerrainLook look;
  const TerrainBlock block = block_with(layers, look);
  ASSERT_FALSE(block.water.empty());
  const Box box = bounding_box(block.water);
  EXPECT_EQ(box.max().z(), 2);
  EXPECT_EQ(box.max().x(), 10.5) << "to the first dry cell";
  look.water = false;
  EXPECT_TRUE(block_with(layers, look).water.empty());
}

TEST(Plants, TheWidestTenthIsDetailed) {
  std::vector<Plant> plants(20);
  for (std::size_t n = 0; n < plants.size(); ++n) plants[n] = {double(n), 0, 1, 0.5 + 0.1 * double(n), 2, 1};
  const Mesh mesh = plants_mesh(plants, std::vector<std::uint8_t>(20, 0), {{{0, 1, 0}}, 3});
  EXPECT_EQ(mesh.indices.size(), 3u * (18 * 4 + 2 * 15));
  const Box box = bounding_box(mesh);
  EXPECT_FLOAT_EQ(static_cast<float>(box.min().z()), 3) << "feet are exaggerated";
  EXPECT_FLOAT_EQ(static_cast<float>(box.max().z()), 3 + 2 * 2.4f) << "plants keep their shape";
}

TEST(WindArrows, LieOnTheGroundAndPointToWhereTheAirMoves) {
  WindGrid wind{10, 10, 5, 0, 0, std::vector<float>(100, 3), std::vector<float>(100, 0), 3};
  wind.u[0] = unknown;
  const auto slope = [](double x, double) { return x > 45 ? std::nan("") : 0.1 * x; };
  const Mesh mesh = wind_arrows(wind, 1000, slope);
  EXPECT_EQ(mesh.vertices.size(), 9u * (100 - 10 - 10 - 1))
      << "no arrow where wind or ground is unknown at its tip";
  for (std::size_t n = 0; n < mesh.vertices.size(); n += 9) {
    const Vertex &tail = mesh.vertices[n], &tip = mesh.vertices[n + 8];
    EXPECT_NEAR(tip.x - tail.x, 3.75, 1e-4);
    EXPECT_NEAR(tip.z, slope(static_cast<double>(tip.x), 0) + 0.2, 1e-4);
  }
  EXPECT_LE(wind_arrows(wind, 25, slope).vertices.size(), 9u * 25);
}

TEST(ChangeReference, IsTheMarkedMap) {
  ChangeReference<int> reference;
  EXPECT_EQ(reference.reference(), nullptr);
  for (int n = 0; n < 10; ++n) reference.add(n, std::make_shared<int>(n));
  EXPECT_EQ(*reference.reference(), 0);
  reference.mark();
  reference.add(10, std::make_shared<int>(10));
  EXPECT_EQ(*reference.reference(), 9);
  reference.add(3, std::make_shared<int>(3));
  EXPECT_EQ(*reference.reference(), 3) << "after a reset";
}

// Complaint 6: memory that grows.
TEST(Complaint6, ChangesOverAPeriodKeepFewMaps) {
  ChangeReference<int> reference(8);
  for (int n = 0; n < 10000; ++n) {
    reference.add(0.01 * n, std::make_shared<int>(n));
    EXPECT_LE(reference.size(), ChangeReference<int>::samples + 2);
    if (n < 1000) continue;
    EXPECT_NEAR(0.01 * *reference.reference(), 0.01 * n - 8, 1.05) << "a part of the period";
  }
}

}  // namespace
