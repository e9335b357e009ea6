#include "test/support/held_terrain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kernels/view/held_layer.hpp"

namespace desert_sim::test {

namespace {
Grid grid_of(int width, int height) {
  Grid grid;
  grid.width = width;
  grid.height = height;
  return grid;
}
}  // namespace

HeldTerrain::HeldTerrain(Exec& exec, int width, int height, Layer layer)
    : exec_(exec),
      layer_(layer),
      terrain_(exec, grid_of(width, height), HeightScale::covering(0, 300)),
      held_(exec, static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
      staging_(exec) {}

void HeldTerrain::set(const std::vector<float>& values) {
  terrain_.set_values(stored(), std::vector<double>(values.begin(), values.end()));
}

void HeldTerrain::hold() {
  with_backend(exec_, [this](auto& e) {
    held_layer::set_held(e, terrain_.view(), layer_, terrain_.metres(layer_), held_.data());
  });
}

std::vector<TileChange> HeldTerrain::take(const held_layer::Tolerance& tolerance, int tile) {
  const packed_tiles::Tiling tiles = packed_tiles::tiling(terrain_.grid(), tile);
  Staging::Slot& slot = staging_.acquire(
      packed_tiles::max_packed_bytes(static_cast<std::size_t>(tiles.count()), held_.size(), sizeof(float)));
  with_backend(exec_, [&](auto& e) {
    held_layer::pack_changes(e, terrain_.view(), layer_, terrain_.metres(layer_), tiles, tolerance,
                             held_.data(), slot.device());
  });
  std::vector<TileChange> changes;
  auto readback = std::make_shared<Readback>();
  staging_.send(slot, sizeof(packed_tiles::PackHeader), readback,
                [&](Staging::Slot& arrived) { changes = unpacked_changes(arrived, tiles); });
  readback->wait();
  return changes;
}

void hold(Simulation& simulation, Layer layer) {
  HeldQuery query;
  query.hold = HeldQuery::Hold::present;
  simulation.views().begin_changes({{layer, query}});
}

Pending<LayerChanges> begin_changes(Simulation& simulation, float threshold, int tile, Layer layer) {
  HeldQuery query;
  query.changes = true;
  query.tolerance.threshold = threshold;
  query.tile = tile;
  return simulation.views().begin_changes({{layer, query}})[layer];
}

std::vector<TileChange> expected_changes(const std::vector<float>& now, std::vector<float>& held, int width,
                                         const held_layer::Tolerance& tolerance, int tile) {
  const float threshold = tolerance.threshold;
  const int height = static_cast<int>(now.size()) / width;
  std::vector<TileChange> changes;
  for (int y0 = 0; y0 < height; y0 += tile)
    for (int x0 = 0; x0 < width; x0 += tile) {
      TileChange c;
      c.x = x0;
      c.y = y0;
      c.width = std::min(tile, width - x0);
      c.height = std::min(tile, height - y0);
      std::vector<std::size_t> cells;
      float largest = 0;
      for (int y = y0; y < y0 + c.height; ++y)
        for (int x = x0; x < x0 + c.width; ++x)
          cells.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                          static_cast<std::size_t>(x));
      const auto off = [&](std::size_t i) {
        if (std::isnan(now[i]) || std::isnan(held[i]))
          return std::isnan(now[i]) && std::isnan(held[i]) ? 0.0f : HUGE_VALF;
        if (tolerance.zero_is_special && (now[i] == 0) != (held[i] == 0)) return HUGE_VALF;
        return std::abs(now[i] - held[i]);
      };
      for (std::size_t i : cells)
        if (off(i) > threshold) largest = std::max(largest, off(i));
      if (largest == 0) continue;
      for (int bits : {8, 4})
        if (largest / static_cast<float>((1 << (bits - 1)) - 1) <= 1.99f * threshold) c.bits = bits;
      const int most = c.bits ? (1 << (c.bits - 1)) - 1 : 0;
      if (c.bits) c.resolution = largest / static_cast<float>(most);
      for (std::size_t i : cells) {
        const bool changed = off(i) > threshold;
        if (!c.bits) {
          c.values.push_back(changed ? now[i] : -HUGE_VALF);
          if (changed) held[i] = now[i];
          continue;
        }
        const float change = changed ? now[i] - held[i] : 0;
        const long step = std::clamp(std::lround(change / c.resolution), -long{most}, long{most});
        c.steps.push_back(static_cast<std::int8_t>(changed ? step : -128));
        if (changed)
          held[i] = static_cast<float>(double{held[i]} + static_cast<double>(step) * double{c.resolution});
      }
      changes.push_back(std::move(c));
    }
  return changes;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

void expect_same(const std::vector<TileChange>& found, const std::vector<TileChange>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t n = 0; n < found.size(); ++n) {
    const TileChange &a = found[n], &b = expected[n];
    EXPECT_EQ(std::make_pair(a.x, a.y), std::make_pair(b.x, b.y)) << "tile " << n;
    EXPECT_EQ(std::make_pair(a.width, a.height), std::make_pair(b.width, b.height)) << "tile " << n;
    EXPECT_EQ(a.bits, b.bits) << "tile " << n;
    EXPECT_EQ(a.resolution, b.resolution) << "tile " << n;
    EXPECT_EQ(a.steps, b.steps) << "tile " << n;
    EXPECT_TRUE(same_bits(a.values, b.values)) << "tile " << n;
  }
}

}  // namespace desert_sim::test
