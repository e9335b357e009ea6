// The layer looseness in a simulation: its beginning, brushes, checkpoints, and what it costs when it is off.

#include <algorithm>
#include <cmath>

#include "src/simulation/checkpoint.hpp"
#include "src/simulation/session.hpp"
#include "test/support/refusal.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const char* const still =
    "grid: {width: 24, height: 20}\nterrain: [uniform: {layer: sand, value: 1}]\nwind: {speed: 0}\n";
const char* const dunes =
    "grid: {width: 48, height: 40}\nterrain: [noise: {layer: sand, low: 0, high: 6, scale: 9}]\nwind: "
    "{speed: 5}\n";
const std::string on = "looseness: {enabled: true}\n";

class LooseGround : public test::OnBackend {
 protected:
  static command::EditTerrain brush(const std::string& layer, BrushMerge merge, double value) {
    command::EditTerrain edit;
    edit.layer = layer;
    edit.shape = BrushShape::circle;
    edit.merge = merge;
    edit.x = 10, edit.y = 10, edit.radius = 3;
    edit.inner = 1;
    edit.value = value;
    return edit;
  }
  static float at(const Simulation& s, int x, int y) {
    return test::real(s, Layer::looseness)[static_cast<std::size_t>(s.terrain().grid().index(x, y))];
  }
};

TEST_P(LooseGround, BeginsWithItsParameterWhereNoStepFillsIt) {
  const auto begun = simulation(std::string(still) + "looseness: {enabled: true, initial: 0.4}\n");
  for (float v : test::real(*begun, Layer::looseness)) EXPECT_EQ(v, 0.4f);
  const auto filled =
      simulation("grid: {width: 8, height: 8}\nterrain: [uniform: {layer: looseness, value: 0.9}]\n" + on);
  for (float v : test::real(*filled, Layer::looseness)) EXPECT_EQ(v, 0.9f);
  auto later = simulation(still);
  test::run(*later, 3);
  later->apply(command::SetParameters{{"looseness.enabled=true", "looseness.initial=0.7"}, 0});
  for (float v : test::real(*later, Layer::looseness)) EXPECT_EQ(v, 0.7f) << "switched on while it runs";
}

TEST_P(LooseGround, CostsNothingWhenItIsOff) {
  const auto off = simulation(still);
  EXPECT_FALSE(off->terrain().has(Layer::looseness));
  EXPECT_FALSE(static_cast<bool>(off->pipeline().fields().sand_before));
  for (const std::string& name : off->pipeline().launch_names()) {
    EXPECT_EQ(name.find("looseness"), std::string::npos);
    EXPECT_NE(name, "sand_record");
  }
}

/// Nothing reads it: the desert is the same with it.
TEST_P(LooseGround, LeavesTheDesertAsItIs) {
  auto with = simulation(dunes + on), without = simulation(dunes);
  test::run(*with, 12);
  test::run(*without, 12);
  for (Layer layer : test::persistent_layers(*without))
    EXPECT_EQ(with->terrain().raw_words(layer), without->terrain().raw_words(layer)) << info(layer).name;
  EXPECT_NE(with->state().hash(), without->state().hash()) << "it is part of the state";
}

TEST_P(LooseGround, StaysInItsRangeAndGoesThroughCheckpointsToTheBit) {
  const test::TemporaryFolder folder;
  for (const char* steps : {"", "run: {time_step: 0.25}\n", "run: {time_step: 3}\n"}) {
    auto s = simulation(dunes + on + steps);
    test::run(*s, 6);
    save_checkpoint(folder.path("a.ck"), *s);
    const auto loaded = load_checkpoint(folder.path("a.ck"), exec());
    EXPECT_EQ(s->state().hash(), loaded->state().hash());
    test::run(*s, 6);
    test::run(*loaded, 6);
    EXPECT_EQ(s->state().hash(), loaded->state().hash());
    const auto values = test::real(*s, Layer::looseness);
    EXPECT_GE(*std::min_element(values.begin(), values.end()), 0);
    EXPECT_LE(*std::max_element(values.begin(), values.end()), 1);
  }
}

/// As wheels do: what they pass over is at most so loose.
TEST_P(LooseGround, BrushesPackAndLoosenIt) {
  auto s = simulation(std::string(still) + "looseness: {enabled: true, initial: 0.6}\n");
  s->commands().history().set_memory(1 << 20);
  s->apply(brush("looseness", BrushMerge::min, 0.25), false);
  EXPECT_EQ(at(*s, 10, 10), 0.25f);
  EXPECT_EQ(at(*s, 15, 10), 0.6f) << "cells beside the brush keep their bits";
  s->apply(brush("looseness", BrushMerge::min, 0.5), false);
  EXPECT_EQ(at(*s, 10, 10), 0.25f);
  s->apply(brush("looseness", BrushMerge::replace, 0.75), false);
  EXPECT_EQ(at(*s, 10, 10), 0.75f);
  s->apply(brush("looseness", BrushMerge::add, 0.75), false);
  EXPECT_EQ(at(*s, 10, 10), 1.0f);
  const auto balance = s->state().balance();
  for (const MaterialBalance& material : balance)
    EXPECT_EQ(material.in + material.out, 0) << "it is no material";
  EXPECT_EQ(s->commands().history().undoable(), 0) << "the sand that moves changes it besides";
}

TEST_P(LooseGround, PouredSandIsLoose) {
  auto s = simulation(std::string(still) + "looseness: {enabled: true, initial: 0.2}\n");
  s->apply(brush("sand", BrushMerge::add, 0.1), false);  // twice the depth that loosens
  EXPECT_NEAR(at(*s, 10, 10), 1 - 0.8 * std::exp(-2.0), 1e-4);
  EXPECT_EQ(at(*s, 15, 10), 0.2f);
  const float poured = at(*s, 10, 10);
  s->apply(brush("sand", BrushMerge::sub, 0.05), false);
  EXPECT_EQ(at(*s, 10, 10), poured) << "taking sand away lays bare what is as loose";
}

TEST_P(LooseGround, RefusedEditsChangeNothing) {
  auto s = simulation(still + on);
  const std::uint64_t before = s->state().hash();
  const auto refusal = [&](Simulation& of, const command::EditTerrain& edit) {
    return test::refusal([&] { of.apply(edit, false); });
  };
  EXPECT_NE(refusal(*s, brush("looseness", BrushMerge::replace, 1.5)).find("is not a value of looseness"),
            std::string::npos);
  command::EditTerrain conserving = brush("looseness", BrushMerge::sub, 0.1);
  conserving.conserve = true;
  EXPECT_NE(refusal(*s, conserving).find("looseness is no material"), std::string::npos);
  EXPECT_EQ(s->state().hash(), before);
  const auto off = simulation(still);
  EXPECT_NE(refusal(*off, brush("looseness", BrushMerge::min, 0)).find("this terrain has no layer looseness"),
            std::string::npos);
}

DESERT_ON_EACH_BACKEND(LooseGround);

}  // namespace
}  // namespace desert_sim
