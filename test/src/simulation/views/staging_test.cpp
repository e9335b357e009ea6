// Snapshots that are under way while the simulation goes on.

#include <thread>

#include "src/core/error.hpp"
#include "src/simulation/memory/memory.hpp"
#include "test/support/held_terrain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const char* const staged_world =
    "grid: {width: 40, height: 30, cell_size: 1}\n"
    "terrain: [noise: {layer: bedrock, low: 100, high: 110, scale: 9},\n"
    "          noise: {layer: sand, low: 0.5, high: 3, scale: 5, seed: 2}]\n";
const std::vector<Layer> layers{Layer::elevation, Layer::sand, Layer::airborne_sand, Layer::wind_x};

class Staged : public test::OnBackend {};

/// What begin_snapshot() has to give: the layers as they are, converted one by one on the host.
std::map<Layer, std::vector<float>> present(const Simulation& s) {
  std::map<Layer, std::vector<float>> values;
  for (Layer layer : layers)
    if (layer != Layer::elevation) values[layer] = s.terrain().values(layer);
  // A step leaves the elevation as it was at its beginning: from its parts, in quanta.
  const auto bedrock = test::quanta(s, Layer::bedrock), sand = test::quanta(s, Layer::sand);
  const HeightScale& scale = s.terrain().scale();
  for (std::size_t i = 0; i < sand.size(); ++i)
    values[Layer::elevation].push_back(
        static_cast<float>(scale.datum + (bedrock[i] + sand[i]) * scale.quantum()));
  return values;
}

TEST_P(Staged, ASnapshotShowsTheStateBeforeTheStepsThatRunMeanwhile) {
  auto s = simulation(staged_world);
  test::run(*s, 3);
  for (int round = 0; round < 5; ++round) {
    const auto before = present(*s);
    const PendingSnapshot pending = s->views().begin_snapshot(layers);
    test::run(*s, 4);
    EXPECT_EQ(pending.get()->layers, before);
    EXPECT_EQ(pending.get()->step, 3u + 4u * round);
    EXPECT_NE(present(*s), before) << "the steps did something";
  }
}

TEST_P(Staged, MoreSnapshotsMayBeUnderWayThanThereAreSlots) {
  auto s = simulation(staged_world);
  std::vector<PendingSnapshot> pending;
  std::vector<std::map<Layer, std::vector<float>>> expected;
  for (int n = 0; n < 7; ++n) {
    test::run(*s, 1);
    expected.push_back(present(*s));
    pending.push_back(s->views().begin_snapshot(layers));
    if (n == 4) pending[2] = {};  // nobody wants it any more
  }
  test::run(*s, 2);
  for (std::size_t n = pending.size(); n-- > 0;) {
    if (n == 2) continue;
    EXPECT_EQ(pending[n].get()->layers, expected[n]) << n;
  }
}

TEST_P(Staged, ASnapshotMayBeLargerThanASlot) {
  auto s = simulation(staged_world);
  test::run(*s, 2);
  const auto expected = present(*s);
  for (std::size_t bytes : {std::size_t{1}, std::size_t{40 * 4 * 4 * 7}, std::size_t{40 * 4 * 4 * 16}}) {
    s->views().staging().release();
    EXPECT_EQ(s->views().staging().bytes(), 0u);
    s->views().staging().set_slot_bytes(bytes);
    const PendingSnapshot pending = s->views().begin_snapshot(layers);
    EXPECT_LE(s->views().staging().bytes(), 2 * std::max(bytes, std::size_t{40 * 4 * 4})) << "a row at least";
    EXPECT_EQ(pending.get()->layers, expected) << bytes;
  }
}

TEST_P(Staged, BandsGoOverTheEdgeAsTheyDidBefore) {
  auto s = simulation(staged_world);
  test::run(*s, 2);
  const auto all = present(*s);
  s->views().staging().set_slot_bytes(40 * 4 * 4 * 3);
  const auto band = s->views().begin_snapshot(layers, {26, 9}).get();
  ASSERT_EQ(band->height, 9);
  for (Layer layer : layers)
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 40; ++x)
        ASSERT_EQ(band->layers.at(layer)[static_cast<std::size_t>(y * 40 + x)],
                  all.at(layer)[static_cast<std::size_t>((26 + y) % 30 * 40 + x)]);
}

TEST_P(Staged, SnapshotsUnderWayOutliveTheirSimulationAndTheMemoryTheyWentThrough) {
  auto s = simulation(staged_world);
  test::run(*s, 2);
  const auto expected = present(*s);
  const PendingSnapshot released = s->views().begin_snapshot(layers);
  s->views().staging().release();
  EXPECT_EQ(s->views().staging().bytes(), 0u);
  const PendingSnapshot last = s->views().begin_snapshot(layers);
  s.reset();
  EXPECT_EQ(released.get()->layers, expected);
  EXPECT_EQ(last.get()->layers, expected);
}

TEST_P(Staged, ReadersOnOtherThreadsGetWhatTheyAskedFor) {
  auto s = simulation(staged_world);
  for (int round = 0; round < 20; ++round) {
    std::vector<std::thread> readers;
    std::vector<std::map<Layer, std::vector<float>>> expected(3), found(3);
    for (std::size_t n = 0; n < found.size(); ++n) {
      test::run(*s, 1);
      expected[n] = present(*s);
      readers.emplace_back(
          [pending = s->views().begin_snapshot(layers), &to = found[n]] { to = pending.get()->layers; });
    }
    test::run(*s, 1);
    for (std::thread& reader : readers) reader.join();
    ASSERT_EQ(found, expected) << round;
  }
}

TEST_P(Staged, MemoryIsCountedAndGivenBack) {
  auto s = simulation(staged_world);
  test::run(*s, 1);
  const std::size_t before = exec().bytes_held(), parts = total_bytes(s->memory());
  s->views().snapshot({Layer::sand});
  test::hold(*s);
  EXPECT_EQ(exec().bytes_held(), before + 2 * 4 * 40 * 30) << "a slot and what is held";
  EXPECT_EQ(total_bytes(s->memory()), parts + 2 * 4 * 40 * 30);
  s->views().staging().release();
  s->views().forget(Layer::elevation);
  EXPECT_EQ(exec().bytes_held(), before);
  EXPECT_EQ(total_bytes(s->memory()), parts);
}

TEST_P(Staged, WhatGoesWrongOnTheWayIsToldToTheReaderEachTime) {
  Staging staging(exec());
  auto readback = std::make_shared<Readback>();
  staging.send(staging.acquire(64), 64, readback, [](Staging::Slot&) { throw CudaError("lost"); });
  staging.send(staging.acquire(64), 64, readback, [](Staging::Slot&) { FAIL() << "after a loss"; });
  staging.release();
  const Pending<int> pending(std::make_shared<int>(1), readback);
  EXPECT_THROW(pending.get(), CudaError);
  EXPECT_THROW(pending.get(), CudaError);
}

TEST_P(Staged, OnlyWhatIsAskedForIsCopied) {
  Staging staging(exec());
  Staging::Slot& slot = staging.acquire(1000);
  const std::vector<char> sent(1000, 'a');
  exec().upload(slot.device(), sent.data(), 1000);
  auto readback = std::make_shared<Readback>();
  std::string begin, all;
  staging.send(slot, 10, readback, [&](Staging::Slot& arrived) {
    begin.assign(arrived.host(10), 10);
    all.assign(arrived.host(1000), 1000);
  });
  readback->wait();
  EXPECT_EQ(begin, std::string(10, 'a'));
  EXPECT_EQ(all, std::string(1000, 'a'));
}

DESERT_ON_EACH_BACKEND(Staged);

}  // namespace
}  // namespace desert_sim
