// What goes to the host beside the steps: the same bits as on the CPU, no trace in the simulation, and time
// saved. Times are compared with one another only.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "test/support/cases.hpp"
#include "test/support/held_terrain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class Overlap : public test::OnBoth {};

const char* const dunes =
    "terrain: [noise: {layer: bedrock, low: 0, high: 10, scale: 30}, noise: {layer: sand, low: 0.5, high: 4, "
    "scale: 12}]\nwind: {speed: 6, direction_deg: 20, warping: false, projection: false}\n";

TEST_F(Overlap, SnapshotsAndChangesAreThoseOfTheCpu) {
  for (const char* boundary : {"periodic", "open"}) {
    auto a = test::simulate(cpu(), test::grid_yaml(150, 131, boundary) + dunes);
    auto b = test::simulate(cuda(), test::grid_yaml(150, 131, boundary) + dunes);
    for (Simulation* s : {a.get(), b.get()}) test::hold(*s);
    for (int round = 0; round < 8; ++round) {
      const float threshold = round % 3 == 2 ? 0.0f : 0.003f * static_cast<float>(round + 1);
      for (Simulation* s : {a.get(), b.get()}) {
        s->views().staging().set_slot_bytes(round < 4 ? std::size_t{1} << 26 : 100000);
        test::run(*s, 2);
      }
      const auto x = a->views().begin_snapshot(a->state().layers_in_use()),
                 y = b->views().begin_snapshot(b->state().layers_in_use());
      const auto c = test::begin_changes(*a, threshold, 32), d = test::begin_changes(*b, threshold, 32);
      test::run(*a, 1);
      test::run(*b, 1);
      EXPECT_TRUE(x.get()->layers == y.get()->layers) << "round " << round;
      EXPECT_FALSE(c.get()->tiles.empty());
      test::expect_same(d.get()->tiles, c.get()->tiles);
      CostQuery query;
      query.update = true;
      query.threshold = round;
      query.whole = round == 5;
      std::vector<std::int8_t> held[2]{std::vector<std::int8_t>(150 * 131), held[0]};
      std::size_t tiles[2]{};
      for (int n = 0; n < 2; ++n) {
        const PendingCosts taken = (n == 0 ? a : b)->views().begin_costs(query);
        for (const auto& changes : {taken.update.get(), taken.whole.get()}) {
          if (!changes) continue;
          changes->write_to(held[n], 150);
          tiles[n] += changes->tiles.size();
        }
      }
      EXPECT_EQ(held[1], held[0]) << "round " << round;
      EXPECT_EQ(tiles[1], tiles[0]);
    }
  }
}

TEST_F(Overlap, ChangesOfLayersAreThoseOfTheCpu) {
  auto a = test::simulate(cpu(), test::grid_yaml(150, 131, "open") + dunes);
  auto b = test::simulate(cuda(), test::grid_yaml(150, 131, "open") + dunes);
  HeldQueries queries;
  for (Layer layer : {Layer::sand, Layer::bedrock, Layer::wind_x, Layer::wind_shadow, Layer::slope,
                      Layer::traversability, Layer::water_surface, Layer::moisture})
    queries[layer].hold = HeldQuery::Hold::present;
  for (Simulation* s : {a.get(), b.get()}) EXPECT_TRUE(s->views().begin_changes(queries).empty());
  std::map<Layer, std::size_t> tiles;
  for (int round = 0; round < 6; ++round) {
    for (auto& [layer, query] : queries)
      query = {true, {0.002f * static_cast<float>(round), layer == Layer::traversability}, 32};
    for (Simulation* s : {a.get(), b.get()}) test::run(*s, 2);
    const PendingChanges x = a->views().begin_changes(queries), y = b->views().begin_changes(queries);
    ASSERT_EQ(x.size(), queries.size());
    for (const auto& [layer, pending] : x) {
      SCOPED_TRACE(testing::Message() << info(layer).name << ", round " << round);
      test::expect_same(y.at(layer).get()->tiles, pending.get()->tiles);
      tiles[layer] += pending.get()->tiles.size();
    }
  }
  for (Layer layer : {Layer::sand, Layer::wind_x, Layer::slope, Layer::traversability})
    EXPECT_GT(tiles[layer], 10u) << info(layer).name;
}

/// Steps are replayed as CUDA graphs meanwhile.
TEST_F(Overlap, LookingLeavesNoTraceInTheSimulation) {
  auto alone = test::simulate(cuda(), test::grid_yaml(200, 160, "periodic") + dunes);
  auto watched = test::simulate(cuda(), test::grid_yaml(200, 160, "periodic") + dunes);
  test::hold(*watched);
  std::vector<PendingSnapshot> pending;
  for (int n = 0; n < 60; ++n) {
    alone->step();
    watched->step();
    pending.push_back(watched->views().begin_snapshot({Layer::elevation, Layer::sand, Layer::wind_x}));
    if (n % 3 == 0) test::begin_changes(*watched, 0.01f, 32);  // and nobody waits for it
    if (n == 30) watched->views().staging().release();
  }
  EXPECT_EQ(alone->state().hash(), watched->state().hash());
  EXPECT_EQ(pending.back().get()->layers.at(Layer::sand), alone->terrain().values(Layer::sand));
  for (std::size_t n = 0; n < pending.size(); ++n) EXPECT_EQ(pending[n].get()->step, n + 1);
}

// ---- Time: under a sanitizer it tells nothing

class OverlapTiming : public Overlap {};

template <class Work>
double milliseconds(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

template <class Work>
double best_milliseconds(const Work& work) {
  double best = HUGE_VAL;
  for (int n = 0; n < 7; ++n) best = std::min(best, milliseconds(work));
  return best;
}

/// A large terrain, some steps on.
std::unique_ptr<Simulation> large(Exec& exec) {
  auto s = test::simulate(exec, test::grid_yaml(2048, 2048, "periodic") + dunes);
  test::run(*s, 40);
  exec.synchronise();
  return s;
}

TEST_F(OverlapTiming, StepsGoOnWhileASnapshotTravels) {
  const auto s = large(cuda());
  const std::vector<Layer> layers{Layer::elevation, Layer::sand, Layer::wind_x, Layer::wind_y};
  const auto run = [&](int steps) {
    test::run(*s, steps);
    cuda().synchronise();
  };
  for (int n = 0; n < 4; ++n) s->views().snapshot(layers);
  const double snapshot = best_milliseconds([&] { s->views().snapshot(layers); });
  PendingSnapshot begun;
  const double begin = best_milliseconds([&] { begun = s->views().begin_snapshot(layers); });
  begun.get();
  const double step = best_milliseconds([&] { run(20); }) / 20;
  const int count = std::max(1, static_cast<int>(std::lround(snapshot / step)));  // take as long
  const double steps = best_milliseconds([&] { run(count); });
  const double together = best_milliseconds([&] {
    const PendingSnapshot pending = s->views().begin_snapshot(layers);
    std::thread reader([&] { pending.get(); });
    run(count);
    reader.join();
  });
  std::printf(
      "2048 x 2048, %zu layers: snapshot %.2f ms (%.3f ms until the next step may start), %d steps %.2f ms, "
      "both at once %.2f ms: %.0f %% of their sum\n",
      layers.size(), snapshot, begin, count, steps, together, 100 * together / (snapshot + steps));
  EXPECT_LT(together, 0.8 * (snapshot + steps));
  EXPECT_LT(begin, 0.5 * snapshot);
}

TEST_F(OverlapTiming, AnUpdateOfAFewTilesTakesLessThanTheWholeSurface) {
  const auto s = large(cuda());
  for (int n = 0; n < 4; ++n) s->views().snapshot({Layer::elevation});
  const double whole = best_milliseconds([&] { s->views().snapshot({Layer::elevation}); });
  test::hold(*s);
  std::size_t tiles = 0;
  int n = 0;
  const auto update = [&] {
    command::EditTerrain edit;
    edit.layer = "sand";
    edit.x = 100 + 50 * ++n;
    edit.y = 700;
    edit.radius = 20;
    edit.value = 1;
    s->apply(edit);
    tiles = test::begin_changes(*s, 0.01f, 32).get()->tiles.size();
  };
  update();
  const double changed = best_milliseconds(update);
  std::printf("2048 x 2048: elevation %.2f ms; an edit and the update of its %zu tiles %.2f ms\n", whole,
              tiles, changed);
  EXPECT_GE(tiles, 2u);
  EXPECT_LE(tiles, 9u);
  EXPECT_LT(changed, 0.5 * whole);
}

}  // namespace
}  // namespace desert_sim
