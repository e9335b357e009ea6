// Same scenario, same bits: whatever the threads, in one run or two, through a checkpoint.

#include <algorithm>
#include <filesystem>
#include <random>

#include "src/simulation/checkpoint.hpp"
#include "src/simulation/processes/sand_slopes.hpp"
#include "test/support/cases.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

std::uint64_t hash_after(Exec& exec, const std::string& yaml, int steps) {
  auto s = test::simulate(exec, yaml);
  test::run(*s, steps);
  return s->state().hash();
}

TEST(Determinism, TheHashDoesNotDependOnTheNumberOfThreads) {
  CpuExec one(1), two(2), three(3);
  for (const test::Case& c : test::process_cases(true)) {
    SCOPED_TRACE(c.name);
    // Few steps: threads that wait for each other are slow on a machine that is busy.
    const std::string yaml = test::grid_yaml(45, 71, "open") + c.yaml;
    const std::uint64_t hash = hash_after(one, yaml, 3);
    EXPECT_EQ(hash, hash_after(two, yaml, 3));
    EXPECT_EQ(hash, hash_after(three, yaml, 3));
  }
}

/// Its memory holds numbers where nobody has written yet.
class UsedMemoryExec : public CpuExec {
 public:
  explicit UsedMemoryExec(unsigned seed) : CpuExec(1), numbers_(seed) {}

 protected:
  void* allocate_memory(std::size_t bytes) override {
    auto* words = static_cast<std::uint32_t*>(CpuExec::allocate_memory(bytes));
    std::generate_n(words, bytes / sizeof *words, [this] { return static_cast<std::uint32_t>(numbers_()); });
    return words;
  }

 private:
  std::mt19937 numbers_;
};

using Words = std::vector<std::uint32_t>;
std::vector<Words> layers_after(Exec& exec, const std::string& yaml, int steps) {
  auto s = test::simulate(exec, yaml);
  test::run(*s, steps);
  std::vector<Words> words;
  for (Layer layer : s->state().layers_in_use()) words.push_back(s->terrain().raw_words(layer));
  return words;
}

/// A field that all processes share is filled by one of them, which another model of sand may replace.
TEST(Determinism, WhatMemoryHeldBeforeDoesNotMatter) {
  const std::string everything =
      "grid: {width: 40, height: 36, cell_size: 1, boundary: open}\n"
      "terrain: [noise: {layer: bedrock, low: 0, high: 8, scale: 9}, uniform: {layer: soil, value: 0.4},\n"
      "  noise: {layer: sand, low: 0.1, high: 2, scale: 5}, uniform: {layer: water, value: 0.05},\n"
      "  uniform: {layer: erosion_resistance, value: 0.2}, uniform: {layer: moisture, value: 0.02},\n"
      "  obstacle: {shape: box, x: 20, y: 18, size_x: 4, size_y: 4, height: 9}]\n"
      "wind: {speed: 9, direction_deg: 20, features: [{kind: vortex, x: 10, y: 10, radius: 5}]}\n"
      "echo_dunes: {enabled: true}\nabrasion: {rate: 0.01}\nrain: {rate: 1.0e-4}\nsoil: {enabled: true}\n"
      "water: {evaporation: 0.05, sea: border, sea_level: 1}\nhydraulic_erosion: {enabled: true}\n"
      "moisture: {enabled: true}\nvegetation: {enabled: true, draw: 1}\nrun: {time_step: 1}\n"
      "species: [{preset: bush, spawn: 50000, moisture_lowest: 0, moisture_highest: 1, slope: 100}]\n";
  for (const char* sand :
       {"saltation: {influx: 0.3, flux: true}\nreptation: {method: smoothing}\nlooseness: {enabled: true}\n",
        "saltation: {enabled: false}\nreptation: {method: off}\navalanching: {enabled: false}\n",
        "sand: {model: continuum}\nsaltation: {flux: true}\nlooseness: {enabled: true}\n",
        "sand: {model: desertscape_2019}\nsaltation: {flux: true}\n", "sand: {model: werner}\n",
        "sand: {model: momiji}\n", "sand: {model: bishop}\n", "sand: {model: nield_baas}\n",
        "sand: {model: snow}\n", "sand: {model: wang}\nlooseness: {enabled: true}\n"}) {
    SCOPED_TRACE(sand);
    const std::string yaml = everything + sand;
    UsedMemoryExec one(1), another(2);
    EXPECT_TRUE(layers_after(one, yaml, 4) == layers_after(another, yaml, 4));
  }
}

class Repeated : public test::OnBackend {};

TEST_P(Repeated, RunsGiveTheSameHash) {
  for (const test::Case& c : test::process_cases(true)) {
    SCOPED_TRACE(c.name);
    const std::string yaml = test::grid_yaml(70, 50, "periodic") + c.yaml;
    EXPECT_EQ(hash_after(exec(), yaml, 6), hash_after(exec(), yaml, 6));
  }
}

/// Of a coarse grid with transforms and steps that converge, long enough for recordings to be replayed.
TEST_P(Repeated, TenRunsGiveTheSameHash) {
  const std::string yaml = test::grid_yaml(96, 64, "periodic") +
                           "terrain: [noise: {layer: sand, low: 0, high: 4}]\nwind: {speed: 6}\navalanching: "
                           "{quality: converged}\n";
  const std::uint64_t first = hash_after(exec(), yaml, 25);
  for (int run = 2; run <= 10; ++run) EXPECT_EQ(hash_after(exec(), yaml, 25), first) << "run " << run;
}

TEST_P(Repeated, RunsWithOtherSeedsDiffer) {
  const std::string yaml =
      test::grid_yaml(32, 32, "periodic") + "terrain: [noise: {layer: sand, low: 0, high: 4}]\n";
  EXPECT_NE(hash_after(exec(), yaml, 2), hash_after(exec(), yaml + "seed: 2\n", 2));
}

TEST_P(Repeated, LookingDoesNotChangeTheState) {
  const std::string yaml = test::grid_yaml(40, 40, "open") + test::process_cases(true).back().yaml;
  auto watched = simulation(yaml), alone = simulation(yaml);
  watched->pipeline().set_timing(true);
  for (int n = 0; n < 8; ++n) {
    watched->views().snapshot(watched->state().layers_in_use());
    sand_residual(watched->state(), watched->pipeline());
    max_sand_slope_deg(watched->state());
    watched->state().balance();
    const std::uint64_t before = watched->state().hash();
    EXPECT_EQ(before, watched->state().hash());
    watched->step();
    alone->step();
  }
  EXPECT_EQ(watched->state().hash(), alone->state().hash());
}

TEST_P(Repeated, RunsAreTheSameThroughACheckpoint) {
  const test::TemporaryFolder folder;
  for (const test::Case& c : test::process_cases(true)) {
    SCOPED_TRACE(c.name);
    auto whole = simulation(test::grid_yaml(33, 50, "open") + c.yaml);
    test::run(*whole, 10);
    auto half = simulation(test::grid_yaml(33, 50, "open") + c.yaml);
    test::run(*half, 5);
    save_checkpoint(folder.path("half.ck"), *half);
    auto resumed = load_checkpoint(folder.path("half.ck"), exec());
    EXPECT_EQ(resumed->state().hash(), half->state().hash());
    EXPECT_EQ(resumed->steps(), 5u);
    test::run(*resumed, 5);
    EXPECT_EQ(resumed->state().hash(), whole->state().hash());
    test::expect_sound(*resumed, "resumed");
    EXPECT_EQ(resumed->pipeline().mean_count(avalanche_iterations),
              whole->pipeline().mean_count(avalanche_iterations));
  }
}

DESERT_ON_EACH_BACKEND(Repeated);

}  // namespace
}  // namespace desert_sim
