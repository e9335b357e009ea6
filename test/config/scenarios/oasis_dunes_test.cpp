// The scenario `oasis` shows what its header says: palms at water alone, dunes that move on, a pond that
// stays.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "test/support/running.hpp"

namespace desert_sim {
namespace {

constexpr double spring_x = 96, spring_y = 72;  // of the scenario [m]

double from_spring(double x, double y) { return std::hypot(x - spring_x, y - spring_y); }

/// Distance of each palm from the spring [m].
std::vector<double> palm_distances(Running& scene) {
  const plants::Workspace& palms = scene.simulation().state().plants;
  const std::vector<std::uint32_t> words = plants::words(palms);
  const auto count = static_cast<std::size_t>(palms.count);
  std::vector<double> distances;
  for (std::size_t n = 0; n < count; ++n)
    distances.push_back(from_spring(float_from_bits(words[n]), float_from_bits(words[count + n])));
  return distances;
}

/// Water deeper than 0.1 m.
struct Pond {
  double area = 0, depth = 0, farthest = 0;  ///< [m²], [m], [m from the spring]
};
Pond pond(Running& scene) {
  const Field water = scene.field(Layer::water);
  Pond p;
  for (int y = 0; y < water.height; ++y)
    for (int x = 0; x < water.width; ++x) {
      if (water.at(x, y) < 0.1) continue;
      p.area += 1;
      p.depth = std::max<double>(p.depth, water.at(x, y));
      p.farthest = std::max(p.farthest, from_spring(x + 0.5, y + 0.5));
    }
  return p;
}

double mean_in_ring(const Field& layer, double inner, double outer) {
  double sum = 0, cells = 0;
  for (int y = 0; y < layer.height; ++y)
    for (int x = 0; x < layer.width; ++x) {
      const double distance = from_spring(x + 0.5, y + 0.5);
      if (distance >= inner && distance < outer) sum += layer.at(x, y), cells += 1;
    }
  return sum / cells;
}

/// The dunes of the southern 40 m, which pass the oasis by.
Field southern_dunes(Running& scene) {
  Field f = scene.field(Layer::elevation);
  f.height = 40;
  f.values.resize(f.index(0, f.height));
  f.periodic = false;
  return f;
}

/// Seeds 1 to 4 have 278 to 358 palms, half of them within 31 m, all within 50 m; a pond of 1700 and then
/// 1500 m², 5.6 m deep; 2.6 m of sand on its bank, 0.85 to 1.18 m on the plain; and dunes that run 10 m in
/// 10 s.
TEST(Oasis, PalmsLiveAroundThePondAndDunesMoveOn) {
  Running scene(shipped("oasis"));
  scene.run(300);
  const Pond early = pond(scene);
  scene.run(140);
  const Field before = southern_dunes(scene);
  scene.run(10);
  const std::optional<Displacement> moved = displacement(before, southern_dunes(scene), 0.3);
  const Pond late = pond(scene);
  const std::vector<double> palms = palm_distances(scene);
  const Field sand = scene.field(Layer::sand);
  const double bank = mean_in_ring(sand, 20, 30), plain = mean_in_ring(sand, 45, 72);
  DESERT_REPORT(
      "%zu palms, half within %.0f m, all within %.0f m; pond %.0f then %.0f m2, %.1f m deep, to %.0f m",
      palms.size(), quantile(palms, 0.5), quantile(palms, 1), early.area, late.area, late.depth,
      late.farthest);
  DESERT_REPORT("sand of the bank %.2f m, of the plain %.2f m; dunes moved %.1f, %.1f m in 10 s", bank, plain,
                moved ? moved->x : NAN, moved ? moved->y : NAN);
  EXPECT_GT(palms.size(), 150u);
  EXPECT_LT(quantile(palms, 0.5), 36);
  EXPECT_LT(quantile(palms, 1), 60) << "no palm far from the water";
  EXPECT_GT(late.area, 0.75 * early.area) << "the pond stays";
  EXPECT_GT(late.depth, 4);
  EXPECT_LT(late.farthest, 35) << "the pond keeps within its bank";
  EXPECT_GT(bank, 1.7 * plain);
  ASSERT_TRUE(moved);
  EXPECT_GT(moved->x, 7);
  EXPECT_LT(std::abs(moved->y), 3);
  scene.expect_balanced();
}

/// Without the spring and what the pond has to begin with, no palm comes up.
TEST(Oasis, NeedsItsWater) {
  Running scene(shipped("oasis", {"water.springs.0.discharge=0", "water.sea_level=-100"}));
  EXPECT_TRUE(palm_distances(scene.run(150)).empty());
}

}  // namespace
}  // namespace desert_sim
