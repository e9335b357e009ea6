#pragma once
/// Plants that a test makes up, on the dunes of MadeUpNode.

#include <desert_sim/Plants.h>

#include <boost/make_shared.hpp>
#include <cstddef>
#include <cstdint>

#include "test/src/rviz/made_up_node.hpp"

namespace rviz_test {

/// So many plants on a square of this side: bushes of 0.2 … 0.8 m, and a palm of 2 … 4 m to each 200 of them.
/// `moment` changes the radii.
inline desert_sim::PlantsPtr made_up_plants(std::size_t count, double side, int moment) {
  auto plants = boost::make_shared<desert_sim::Plants>();
  plants->header.frame_id = "map";
  plants->origin.orientation.w = 1;
  plants->total = count;
  plants->species.resize(2);
  plants->species[0].stem = 1.2F;
  plants->species[0].hue = 90;
  plants->species[1].stem = 3;
  plants->species[1].hue = 140;
  std::uint64_t random = 1;
  const auto next = [&random] {  // 0 … 1
    random = random * 6364136223846793005u + 1442695040888963407u;
    return static_cast<float>(random >> 40) / static_cast<float>(1 << 24);
  };
  for (std::size_t n = 0; n < count; ++n) {
    const float x = next() * static_cast<float>(side), y = next() * static_cast<float>(side), size = next();
    const bool palm = n % 200 == 0;
    plants->x.push_back(x);
    plants->y.push_back(y);
    plants->z.push_back(dunes(static_cast<int>(x), static_cast<int>(y)));
    plants->radius.push_back((palm ? 2 + 2 * size : 0.2F + 0.6F * size) *
                             (1 + 0.01F * static_cast<float>(moment % 10)));
    plants->species_index.push_back(palm ? 1 : 0);
    plants->health.push_back(static_cast<std::uint8_t>(100 + n % 156));
  }
  return plants;
}

}  // namespace rviz_test
