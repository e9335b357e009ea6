// Sand in slabs that random events move, at once in all cells, beside one event after the other
// (support/sequential_desertscape.hpp).

#include <string>
#include <vector>

#include "test/support/patterns.hpp"
#include "test/support/running.hpp"
#include "test/support/sequential_desertscape.hpp"

namespace desert_sim {
namespace {

constexpr int desertscape_side = 48;

/// A sheet of sand in which dunes grow.
std::string sheet(double depth, double slab, double creeping, double speed, int seed) {
  const std::string size = std::to_string(desertscape_side), lift = std::to_string(slab);
  return "grid: {width: " + size + ", height: " + size +
         "}\nterrain: [uniform: {layer: sand, value: " + std::to_string(depth) +
         "}]\nwind: {speed: " + std::to_string(speed) +
         ", speedup_law: venturi, speedup: 0, warping: false, projection: false}\nsand: {model: "
         "desertscape_2019}\nsaltation: {lift: " +
         lift + "}\ndesertscape_2019: {slab: " + lift + "}\nreptation: {slab: " + std::to_string(creeping) +
         "}\nseed: " + std::to_string(seed) + "\n";
}

TEST(Desertscape, EventsAtOnceAreAsOneEventAfterTheOther) {
  constexpr double depth = 1, slab = 0.3, creeping = 0.02, speed = 4;
  constexpr int steps = 24;
  std::vector<test::Pattern> parallel, sequential;
  const auto in_slabs = [](std::vector<double> heights) {
    for (double& h : heights) h /= slab;
    return test::pattern_of(heights);
  };
  for (int seed = 1; seed <= test::seeds; ++seed) {
    Running scene(parse_scenario_text(sheet(depth, slab, creeping, speed, seed), "sheet"));
    scene.run(steps).expect_balanced();
    const Field sand = scene.field(Layer::sand);
    parallel.push_back(in_slabs({sand.values.begin(), sand.values.end()}));
    test::SequentialDesertscape reference(desertscape_side, depth, slab, creeping, speed, 0.6,
                                          static_cast<unsigned>(seed));
    reference.run(steps);
    sequential.push_back(in_slabs(reference.sand));
  }
  test::expect_alike(parallel, sequential);
}

}  // namespace
}  // namespace desert_sim
