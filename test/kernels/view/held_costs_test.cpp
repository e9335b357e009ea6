// What others lack of the costs, found where the terrain lies, against the same done cell by cell.

#include <cmath>
#include <limits>
#include <random>

#include "src/simulation/memory/memory.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

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
    all->write_to(held_, width_);
  }
  struct Update {
    std::size_t tiles = 0;
    CellBox box;  ///< of the cells that it changes
  };
  /// Takes an update.
  Update update(int threshold) {
    CostQuery query;
    query.update = true;
    query.threshold = threshold;
    const PendingCosts taken = take(query);
    EXPECT_FALSE(taken.whole);
    const std::shared_ptr<const CostChanges> changes = taken.update.get();
    Update update;
    update.tiles = changes->tiles.size();
    for (const CellBox& box : changes->write_to(held_, width_)) update.box = update.box.united_with(box);
    return update;
  }
  const Costs& held() const { return held_; }

 private:
  Exec& exec_;
  Staging staging_;
  int width_, height_;
  HeldCosts costs_;
  Costs held_;
};

bool differ(int now, int held, int threshold) {
  const auto special = [](int cost) { return cost == 100 || cost == -1; };
  return special(now) || special(held) ? now != held : std::abs(now - held) > threshold;
}

/// The same with plain arithmetic: what is held after the tiles were sent that have a cell which changed;
/// counts them.
Costs after(const Costs& now, Costs held, int width, int threshold, std::size_t& tiles) {
  const int columns = (width - 1) / 32 + 1;
  const auto tile_of = [=](std::size_t i) {
    const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
    return static_cast<std::size_t>(y / 32 * columns + x / 32);
  };
  std::vector<bool> changed(tile_of(now.size() - 1) + 1);
  for (std::size_t i = 0; i < now.size(); ++i)
    if (differ(now[i], held[i], threshold)) changed[tile_of(i)] = true;
  tiles = static_cast<std::size_t>(std::count(changed.begin(), changed.end(), true));
  for (std::size_t i = 0; i < now.size(); ++i)
    if (changed[tile_of(i)]) held[i] = now[i];
  return held;
}

/// The smallest box that has all cells in which they differ.
CellBox difference(const Costs& now, const Costs& held, int width) {
  CellBox box;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
    if (now[i] != held[i]) box = box.united_with({x, y, x + 1, y + 1});
  }
  return box;
}

TEST(Costs, OfTraversability) {
  EXPECT_EQ(cell_cost::of(1), 0);
  EXPECT_EQ(cell_cost::of(2), 0);
  EXPECT_EQ(cell_cost::of(0.5f), 50);  // 49.5
  EXPECT_EQ(cell_cost::of(1e-6f), 99);
  EXPECT_EQ(cell_cost::of(0), cell_cost::lethal);
  EXPECT_EQ(cell_cost::of(-1), cell_cost::lethal);
  EXPECT_EQ(cell_cost::of(std::numeric_limits<float>::quiet_NaN()), cell_cost::unknown);
  for (int n = 1; n <= 100000; ++n) {
    const float worth = static_cast<float>(n) / 100000;
    ASSERT_EQ(cell_cost::of(worth), std::lround(99 * (1 - worth))) << worth;
  }
}

class HeldCostsTold : public test::OnBackend {};

TEST_P(HeldCostsTold, TilesAreThoseOfABruteForceComparison) {
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
        if (cost != cell_cost::unknown && cost != cell_cost::lethal)
          cost = static_cast<std::int8_t>(std::min(99, cost + below(4)));
      }
      for (int n = 0; n < round / 2; ++n)  // jumps
        now[random() % now.size()] = static_cast<std::int8_t>(below(102) - 1);
      SCOPED_TRACE(testing::Message() << width << " x " << height << ", round " << round);
      std::size_t tiles = 0;
      const Costs held = told.held(), expected = after(now, held, width, threshold, tiles);
      told.set(now);
      const Told::Update found = told.update(threshold);
      EXPECT_EQ(found.tiles, tiles);
      ASSERT_EQ(told.held(), expected);
      EXPECT_EQ(corners(found.box), corners(difference(expected, held, width)));
      EXPECT_EQ(told.update(threshold).tiles, 0u) << "they are held now";
    }
    told.hold();
    EXPECT_EQ(told.held(), now);
  }
}

TEST_P(HeldCostsTold, SmallChangesWaitUntilTheyAddUp) {
  constexpr int width = 40;
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
  now[4 * width + 37] = 42;
  told.set(now);
  EXPECT_EQ(corners(told.update(3).box), corners({1, 2, 8, 5}));
  EXPECT_EQ(told.held()[2 * width + 6], 44);
  EXPECT_EQ(told.held()[3 * width + 1], 36);
  EXPECT_EQ(told.held()[4 * width + 7], 42) << "in the tile of one that changed";
  EXPECT_EQ(told.held()[4 * width + 37], 40) << "in another one";
  now[4 * width + 37] = 44;
  told.set(now);
  EXPECT_EQ(corners(told.update(3).box), corners({37, 4, 38, 5}));
}

TEST_P(HeldCostsTold, LethalAndUnknownAreAlwaysRight) {
  Told told(exec(), 8, 1);
  Costs now(8, 99);
  told.set(now);
  told.hold();
  now[1] = 5;
  told.set(now);
  EXPECT_TRUE(told.update(98).box.empty());
  now[3] = cell_cost::lethal;
  told.set(now);
  EXPECT_EQ(corners(told.update(98).box), corners({1, 0, 4, 1}));
  now[3] = 99;
  now[5] = cell_cost::unknown;
  told.set(now);
  EXPECT_EQ(corners(told.update(98).box), corners({3, 0, 6, 1}));
}

const char* const world =
    "grid: {width: 90, height: 70, cell_size: 1}\n"
    "terrain: [noise: {layer: bedrock, low: 100, high: 130, scale: 19},\n"
    "          noise: {layer: sand, low: 0.5, high: 3, scale: 9, seed: 2}]\n";

TEST_P(HeldCostsTold, OfASimulationFollowItsTraversability) {
  auto s = simulation(world);
  EXPECT_FALSE(s->views().begin_costs({}).update);
  EXPECT_FALSE(s->terrain().has(Layer::traversability));
  const std::size_t before = exec().bytes_held(), parts = total_bytes(s->memory());
  CostQuery query;
  query.update = true;
  query.threshold = 2;
  const PendingCosts first = s->views().begin_costs(query);
  EXPECT_FALSE(first.update) << "nothing was held";
  Costs held(90 * 70, cell_cost::unknown);
  first.whole.get()->write_to(held, 90);
  s->views().staging().release();
  EXPECT_EQ(exec().bytes_held() - before, 2 * 90 * 70);
  EXPECT_EQ(total_bytes(s->memory()) - parts, exec().bytes_held() - before);
  EXPECT_FALSE(s->terrain().has(Layer::traversability)) << "nobody asked for the layer";
  for (int round = 0; round < 5; ++round) {
    test::run(*s, 3);
    query.whole = round == 3;
    const PendingCosts taken = s->views().begin_costs(query);
    const std::shared_ptr<const Snapshot> snapshot = s->views().snapshot({Layer::traversability});
    Costs now;
    for (float worth : snapshot->layers.at(Layer::traversability)) now.push_back(cell_cost::of(worth));
    test::run(*s, 1);  // meanwhile
    std::size_t tiles = 0;
    const Costs expected = after(now, held, 90, 2, tiles);
    ASSERT_GT(tiles, 0u) << "too little happened to tell anything";
    EXPECT_EQ(taken.update.get()->tiles.size(), tiles);
    taken.update.get()->write_to(held, 90);
    ASSERT_EQ(held, expected) << round;
    EXPECT_EQ(static_cast<bool>(taken.whole), query.whole);
    if (!query.whole) continue;
    taken.whole.get()->write_to(held, 90);
    ASSERT_EQ(held, now);
  }
  s->views().release_requested_layers();
  s->views().staging().release();
  s->views().forget_costs();
  EXPECT_EQ(exec().bytes_held(), before);
}

DESERT_ON_EACH_BACKEND(HeldCostsTold);

}  // namespace
}  // namespace desert_sim
