// Same scenario, same bits: whatever the threads, in one run or two, through a checkpoint.

#include <filesystem>

#include "src/simulation/checkpoint.hpp"
#include "test/support/cases.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

std::uint64_t hash_after(Exec& exec, const std::string& yaml, int steps) {
  auto s = test::simulate(exec, yaml);
  test::run(*s, steps);
  return s->state_hash();
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
  watched->set_timing(true);
  for (int n = 0; n < 8; ++n) {
    watched->snapshot(watched->layers_in_use());
    watched->residual();
    watched->max_sand_slope_deg();
    watched->balance();
    const std::uint64_t before = watched->state_hash();
    EXPECT_EQ(before, watched->state_hash());
    watched->step();
    alone->step();
  }
  EXPECT_EQ(watched->state_hash(), alone->state_hash());
}

TEST_P(Repeated, RunsAreTheSameThroughACheckpoint) {
  const test::TemporaryFolder folder;
  for (const test::Case& c : test::process_cases(true)) {
    SCOPED_TRACE(c.name);
    auto whole = simulation(test::grid_yaml(33, 50, "open") + c.yaml);
    test::run(*whole, 20);
    auto half = simulation(test::grid_yaml(33, 50, "open") + c.yaml);
    test::run(*half, 10);
    save_checkpoint(folder.path("half.ck"), *half);
    auto resumed = load_checkpoint(folder.path("half.ck"), exec());
    EXPECT_EQ(resumed->state_hash(), half->state_hash());
    EXPECT_EQ(resumed->steps(), 10u);
    test::run(*resumed, 10);
    EXPECT_EQ(resumed->state_hash(), whole->state_hash());
    test::expect_sound(*resumed, "resumed");
    EXPECT_EQ(resumed->mean_avalanche_iterations(), whole->mean_avalanche_iterations());
  }
}

DESERT_ON_EACH_BACKEND(Repeated);

}  // namespace
}  // namespace desert_sim
