// Sand that the wind brings to a step of rock piles up against it until it climbs over the edge.

#include <algorithm>

#include "test/support/running.hpp"

namespace desert_sim {
namespace {

/// Of sand against a step that faces west; means along the step.
struct Ramp {
  double volume = 0;   ///< of sand from 40 m before the foot to the edge, by width [m²]
  double at_foot = 0;  ///< depth at the foot [m]
  double reach = 0;    ///< highest surface of sand 0.3 m deep on the step, by the height of the step
  double plateau = 0;  ///< depth from 5 to 40 m behind the edge [m]
};

Ramp ramp_of(Running& scene) {
  const Field sand = scene.field(Layer::sand), rock = scene.field(Layer::bedrock);
  const auto mean = [](const Field& f, int x) {
    double sum = 0;
    for (int y = 0; y < f.height; ++y) sum += static_cast<double>(f.at(x, y)) / f.height;
    return sum;
  };
  int foot = 0, edge = 0;
  const double top = mean(rock, rock.width - 1);
  while (mean(rock, foot + 1) < 0.05 * top) ++foot;
  while (mean(rock, edge) < 0.99 * top) ++edge;
  Ramp r;
  for (int x = foot - 40; x < edge; ++x) r.volume += mean(sand, x);
  r.at_foot = mean(sand, foot);
  for (int x = foot; x <= edge; ++x)
    if (mean(sand, x) > 0.3) r.reach = std::max(r.reach, (mean(sand, x) + mean(rock, x)) / top);
  for (int x = edge + 5; x < edge + 40; ++x) r.plateau += mean(sand, x) / 35;
  return r;
}

/// A ramp grows, and climbs until sand lies on the plateau.
TEST(Climbing, Dune) {
  Running scene(shipped("climbing_dune", {"grid.height=64"}));
  double volume = 0;
  for (int look = 0; look < 3; ++look) {
    const Ramp r = ramp_of(scene.run(look ? 300 : 100));
    DESERT_REPORT("ramp: %.0f m2, %.1f m at the foot, reaches %.2f of the step; plateau %.2f m", r.volume,
                  r.at_foot, r.reach, r.plateau);
    EXPECT_GT(r.volume, 1.25 * volume);
    volume = r.volume;
    if (look < 2) continue;
    EXPECT_GT(r.at_foot, 6);
    EXPECT_GT(r.reach, 0.85);
    EXPECT_GT(r.plateau, 0.1);
  }
  scene.expect_balanced();
}

/// The dune comes to the step, fills its foot, and climbs over. It begins nearer than in the scenario.
TEST(Climbing, OfDesertscape) {
  Running scene(shipped("desertscape_climbing", {"grid.width=210", "grid.height=32"}));
  const Ramp before = ramp_of(scene.run(600)), filled = ramp_of(scene.run(500)),
             over = ramp_of(scene.run(200));
  for (const Ramp& r : {before, filled, over})
    DESERT_REPORT("ramp: %.0f m2, %.1f m at the foot, reaches %.2f of the step; plateau %.2f m", r.volume,
                  r.at_foot, r.reach, r.plateau);
  EXPECT_LT(before.at_foot, 1);
  EXPECT_GT(filled.at_foot, 6);
  EXPECT_GT(filled.reach, 0.8);
  EXPECT_GT(over.plateau, filled.plateau + 0.3);
  scene.expect_balanced();
}

}  // namespace
}  // namespace desert_sim
