// What others lack of the costs, found where the terrain lies, against the same done cell by cell.

#include <cmath>
#include <limits>
#include <random>

#include "src/simulation/pipeline/memory.hpp"
#include "support/world.hpp"

namespace desert_sim {
namespace {

using held_costs::cost_of;
using held_costs::lethal_cost;
using held_costs::unknown_cost;
using Costs = std::vector<std::int8_t>;

auto corners(const CellBox& box) { return std::make_tuple(box.x0, box.y0, box.x1, box.y1); }

/// Costs that a test chooses, and what subscribers make of what they are told.
class Told {
 public:
  Told(Exec& exec, int width, int height) : exec_(exec), staging_(exec), width_(width), height_(height) {
    Grid grid;
    grid.width = width;
    grid.height = height;
    costs_ = HeldCosts(exec, grid);
    held_.assign(static_cast<std::size_t>(width * height), 77);
  }
  /// Bytes of a piece on its way: 1 makes it a row of tiles.
  void set_slot_bytes(std::size_t bytes) { staging_.set_slot_bytes(bytes); }
  void set(const Costs& now) { exec_.upload(costs_.now(), now.data(), now.size()); }
  PendingCosts take(const CostQuery& query) { return costs_.begin_copy(exec_, staging_, query); }
  /// Takes the whole map.
  void hold() {
    CostQuery query;
    query.whole = true;
    const std::shared_ptr<const CostChanges> all = take(query).whole.get();
    EXPECT_EQ(corners(all->box), corners({0, 0, width_, height_}));
    all->write_to(held_, width_);
  }
  /// Takes an update.
  CostChanges update(int threshold, const CellBox& recent = {}) {
    CostQuery query;
    query.update = true;
    query.threshold = threshold;
    query.recent = recent;
    const PendingCosts taken = take(query);
    EXPECT_FALSE(taken.whole);
    const CostChanges changes = *taken.update.get();
    changes.write_to(held_, width_);
    return changes;
  }
  const Costs& held() const { return held_; }

 private:
  Exec& exec_;
  Staging staging_;
  int width_, height_;
  HeldCosts costs_;
  Costs held_;
};

/// The same with plain arithmetic: the box of the cells that changed.
CellBox changed_cells(const Costs& now, const Costs& held, int width, int threshold) {
  CellBox box;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto special = [](int cost) { return cost == 100 || cost == -1; };
    const bool exact = special(now[i]) || special(held[i]);
    if (now[i] == held[i] || (!exact && std::abs(now[i] - held[i]) <= threshold)) continue;
    const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
    box = box.united_with({x, y, x + 1, y + 1});
  }
  return box;
}

/// What is held after `box` was sent; counts the tiles that have a cell of it that is new.
Costs after(const Costs& now, Costs held, int width, const CellBox& box, std::size_t& tiles) {
  std::vector<bool> touched(now.size());
  tiles = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
    if (!box.contains_cell(x, y) || now[i] == held[i]) continue;
    held[i] = now[i];
    const std::size_t tile = static_cast<std::size_t>(y / 32 * ((width - 1) / 32 + 1) + x / 32);
    tiles += touched[tile] ? 0 : 1;
    touched[tile] = true;
  }
  return held;
}

TEST(Costs, OfTraversability) {
  EXPECT_EQ(cost_of(1), 0);
  EXPECT_EQ(cost_of(2), 0);
  EXPECT_EQ(cost_of(0.5f), 50);  // 49.5
  EXPECT_EQ(cost_of(1e-6f), 99);
  EXPECT_EQ(cost_of(0), lethal_cost);
  EXPECT_EQ(cost_of(-1), lethal_cost);
  EXPECT_EQ(cost_of(std::numeric_limits<float>::quiet_NaN()), unknown_cost);
  for (int n = 1; n <= 100000; ++n) {
    const float worth = static_cast<float>(n) / 100000;
    ASSERT_EQ(cost_of(worth), std::lround(99 * (1 - worth))) << worth;
  }
}

class HeldCostsTold : public test::OnBackend {};

TEST_P(HeldCostsTold, BoxesAndTilesAreThoseOfABruteForceComparison) {
  std::mt19937 random(7);
  const auto below = [&random](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (const auto& [width, height] : {std::pair{70, 45}, {1, 1}, {32, 33}, {200, 7}, {3, 150}, {160, 170}}) {
    Told told(exec(), width, height);
    Costs now(static_cast<std::size_t>(width * height));
    for (std::int8_t& cost : now) cost = static_cast<std::int8_t>(below(102) - 1);
    told.set(now);
    told.hold();
    ASSERT_EQ(told.held(), now);
    for (int round = 0; round < 12; ++round) {
      const int threshold = std::vector<int>{0, 3, 10, 99}[static_cast<std::size_t>(round) % 4];
      told.set_slot_bytes(round % 3 == 2 ? 1 : std::size_t{1} << 20);
      for (std::size_t n = 0; n < now.size() / 9; ++n) {  // drift
        std::int8_t& cost = now[random() % now.size()];
        if (cost != unknown_cost && cost != lethal_cost)
          cost = static_cast<std::int8_t>(std::min(99, cost + below(4)));
      }
      for (int n = 0; n < round / 2; ++n)  // jumps
        now[random() % now.size()] = static_cast<std::int8_t>(below(102) - 1);
      const CellBox recent = round % 2 ? CellBox{width / 3, height / 4, width / 2, height} : CellBox{};
      SCOPED_TRACE(testing::Message() << width << " x " << height << ", round " << round);
      const CellBox changed = changed_cells(now, told.held(), width, threshold);
      const CellBox box = changed.empty() ? CellBox{} : changed.united_with(recent);
      std::size_t tiles = 0;
      const Costs expected = after(now, told.held(), width, box, tiles);
      told.set(now);
      const CostChanges found = told.update(threshold, recent);
      EXPECT_EQ(found.changed.empty(), changed.empty());
      if (!changed.empty()) {
        EXPECT_EQ(corners(found.changed), corners(changed));
      }
      EXPECT_EQ(corners(found.box), corners(box));
      EXPECT_EQ(found.tiles.size(), tiles) << "no more than those of the box that differ";
      ASSERT_EQ(told.held(), expected);
      EXPECT_TRUE(told.update(threshold).box.empty()) << "they are held now";
    }
    told.hold();
    EXPECT_EQ(told.held(), now);
  }
}

TEST_P(HeldCostsTold, SmallChangesWaitUntilTheyAddUp) {
  constexpr int width = 8;
  Told told(exec(), width, 5);
  Costs now(width * 5, 40);
  told.set(now);
  told.hold();
  for (int change = 1; change <= 3; ++change) {
    now[2 * width + 6] = static_cast<std::int8_t>(40 + change);
    told.set(now);
    EXPECT_TRUE(told.update(3).box.empty()) << change;
  }
  now[2 * width + 6] = 44;
  now[3 * width + 1] = 36;
  now[4 * width + 7] = 42;
  told.set(now);
  EXPECT_EQ(corners(told.update(3).box), corners({1, 2, 7, 4}));
  EXPECT_EQ(told.held()[2 * width + 6], 44);
  EXPECT_EQ(told.held()[3 * width + 1], 36);
  EXPECT_EQ(told.held()[4 * width + 7], 40) << "off the box";
  now[4 * width + 7] = 44;
  told.set(now);
  EXPECT_EQ(corners(told.update(3).box), corners({7, 4, 8, 5}));
}

TEST_P(HeldCostsTold, LethalAndUnknownAreAlwaysRight) {
  Told told(exec(), 8, 1);
  Costs now(8, 99);
  told.set(now);
  told.hold();
  now[1] = 5;
  told.set(now);
  EXPECT_TRUE(told.update(98).box.empty());
  now[3] = lethal_cost;
  told.set(now);
  EXPECT_EQ(corners(told.update(98).box), corners({3, 0, 4, 1}));
  now[3] = 99;
  now[5] = unknown_cost;
  told.set(now);
  EXPECT_EQ(corners(told.update(98).box), corners({3, 0, 6, 1}));
}

const char* const world =
    "grid: {width: 90, height: 70, cell_size: 1}\n"
    "terrain: [noise: {layer: bedrock, low: 100, high: 130, scale: 19},\n"
    "          noise: {layer: sand, low: 0.5, high: 3, scale: 9, seed: 2}]\n";

TEST_P(HeldCostsTold, OfASimulationFollowItsTraversability) {
  auto s = simulation(world);
  EXPECT_FALSE(s->begin_costs({}).update);
  EXPECT_FALSE(s->terrain().has(Layer::traversability));
  const std::size_t before = exec().bytes_held(), parts = total_bytes(s->memory());
  CostQuery query;
  query.update = true;
  query.threshold = 2;
  const PendingCosts first = s->begin_costs(query);
  EXPECT_FALSE(first.update) << "nothing was held";
  Costs held(90 * 70, unknown_cost);
  first.whole.get()->write_to(held, 90);
  s->staging().release();
  EXPECT_EQ(exec().bytes_held() - before, 2 * 90 * 70 + sizeof(held_costs::BoundingBox));
  EXPECT_EQ(total_bytes(s->memory()) - parts, exec().bytes_held() - before);
  EXPECT_FALSE(s->terrain().has(Layer::traversability)) << "nobody asked for the layer";
  for (int round = 0; round < 5; ++round) {
    test::run(*s, 3);
    query.whole = round == 3;
    const PendingCosts taken = s->begin_costs(query);
    const std::shared_ptr<const Snapshot> snapshot = s->snapshot({Layer::traversability});
    Costs now;
    for (float worth : snapshot->layers.at(Layer::traversability)) now.push_back(cost_of(worth));
    test::run(*s, 1);  // meanwhile
    const CellBox changed = changed_cells(now, held, 90, 2);
    ASSERT_FALSE(changed.empty()) << "too little happened to tell anything";
    EXPECT_EQ(corners(taken.update.get()->box), corners(changed));
    std::size_t tiles = 0;
    const Costs expected = after(now, held, 90, changed, tiles);
    taken.update.get()->write_to(held, 90);
    ASSERT_EQ(held, expected) << round;
    EXPECT_EQ(static_cast<bool>(taken.whole), query.whole);
    if (!query.whole) continue;
    taken.whole.get()->write_to(held, 90);
    ASSERT_EQ(held, now);
  }
  s->release_requested_layers();
  s->staging().release();
  s->forget_costs();
  EXPECT_EQ(exec().bytes_held(), before);
}

DESERT_ON_EACH_BACKEND(HeldCostsTold);

}  // namespace
}  // namespace desert_sim
