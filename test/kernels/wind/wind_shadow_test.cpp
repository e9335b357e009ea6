// Short marches, which a CPU does side by side, against marches one by one.

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "test/support/bench_terrain.hpp"

namespace desert_sim {
namespace {

constexpr std::uint64_t seed = 5;

/// 0 … 1
float noise(int x, int y, std::uint32_t what) {
  return random_unit(seed, Purpose::turbulence, static_cast<std::uint32_t>(y * 1000 + x), what, 0);
}

/// Sand of 0 … 3 m; from block to block winds to all sides, some along an axis or a diagonal, some too weak
/// to shelter from.
void make_weather(test::BenchTerrain& t) {
  t.set(Layer::sand, [](int x, int y) { return 3 * noise(x, y, 1); });
  const auto wind = [](int x, int y, int axis) -> double {
    x /= wind_shadow::side, y /= wind_shadow::side;
    const float u = 8 * noise(x, y, 2) - 4, v = 8 * noise(x, y, 3) - 4, kind = noise(x, y, 4);
    if (kind < 0.05f) return 0;
    if (kind < 0.1f) return 1e-7;
    if (kind < 0.2f) return u;  // a diagonal
    if (kind < 0.3f) return axis == 0 ? u : 0;
    if (kind < 0.4f) return axis == 0 ? 0 : v;
    return axis == 0 ? u : v;
  };
  t.set(Layer::wind_x, [&](int x, int y) { return wind(x, y, 0); });
  t.set(Layer::wind_y, [&](int x, int y) { return wind(x, y, 1); });
}

/// The shadow of each cell by the law for marches of any length.
std::vector<float> one_by_one(const test::BenchTerrain& t, const WindShadowParameters& p) {
  const TerrainView view = t.terrain.view();
  const int steps = wind_shadow::march_steps(view.grid, p);
  std::vector<float> reciprocals(static_cast<std::size_t>(steps) + 1), shadow(t.cells(), -1);
  for (int j = 1; j <= steps; ++j) reciprocals[static_cast<std::size_t>(j)] = 1.0f / static_cast<float>(j);
  const wind_shadow::Shadow law{
      {view.grid, view.real(Layer::wind_x), view.real(Layer::wind_y)},
      p.distance / view.grid.cell_size,
      steps,
      wind_shadow::ShadowFromSlope(p.start_deg, p.full_deg, view.grid.cell_size * view.quanta_per_metre),
      t.heights.cell_heights.data(),
      reciprocals.data(),
      shadow.data(),
      t.heights.blocks,
      nullptr,
      nullptr};
  for (int y = 0; y < view.grid.height; ++y)
    for (int x = 0; x < view.grid.width; ++x) law(x, y);
  return shadow;
}

TEST(ShadowOfBlock, IsThatOfMarchesOneByOne) {
  CpuExec exec(3);
  for (const auto& [width, height] :
       {std::pair{203, 150}, std::pair{64, 17}, std::pair{9, 40}, std::pair{3, 3}})
    for (bool periodic : {true, false}) {
      test::BenchTerrain t(exec, width, height, 2.0, periodic);
      make_weather(t);
      for (double cells : {0.5, 1.0, 2.0, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 12.0, 20.0, 30.0}) {
        WindShadowParameters p;
        p.distance = static_cast<float>(2 * cells);
        t.shadow(p, true);
        const std::vector<float> expected = one_by_one(t, p);
        const float* shadow = t.terrain.view().real(Layer::wind_shadow);
        int shaded = 0;
        for (std::size_t i = 0; i < t.cells(); ++i) {
          ASSERT_EQ(bits_of(shadow[i]), bits_of(expected[i]))
              << width << " x " << height << ", " << cells << " cells, " << i;
          shaded += shadow[i] > 0.0f ? 1 : 0;
        }
        EXPECT_GT(shaded, static_cast<int>(t.cells()) / 5);
        EXPECT_LT(shaded, static_cast<int>(t.cells()) * 19 / 20 + 1);
      }
    }
}

}  // namespace
}  // namespace desert_sim
