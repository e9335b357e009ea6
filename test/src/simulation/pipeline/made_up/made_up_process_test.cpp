// A process that the test tree alone adds, frost.hpp, has everything that the others have: its section of
// parameters, its place in the step, layers, times, memory, the check for broken values, checkpoints, live
// parameters, pages.

#include <algorithm>

#include "src/simulation/checkpoint.hpp"
#include "src/simulation/processes/processes.hpp"
#include "test/src/simulation/pipeline/made_up/frost.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using test::FrostParameters;

const std::string section = register_section<FrostParameters>("frost");

const FrostParameters& parameters_of(const Scenario& s) { return s.get<FrostParameters>(); }

/// What the process keeps between steps.
struct FrostWork {
  int steps = 0;
  Buffer<float> memory;
  std::size_t bytes() const { return memory.bytes(); }
};

Process frost_process() {
  Process p;
  p.name = "frost";
  p.parameters = {section};
  p.source = "made up";
  p.header = "test/src/simulation/pipeline/made_up/frost.hpp";
  p.active = [](const Scenario& s) { return parameters_of(s).enabled; };
  p.reads = {Layer::soil};
  p.writes = {Layer::bedrock, Layer::sand};
  set_workspace<FrostWork>(p, [](const SimulationState& state) {
    return FrostWork{0, Buffer<float>(state.exec(), static_cast<std::size_t>(state.terrain.grid().cells()))};
  });
  p.step = [](StepContext& c, ProcessWorkspace* workspace) {
    ++workspace_as<FrostWork>(workspace).steps;
    test::frost_step(static_cast<CpuExec&>(c.exec()), c.terrain, parameters_of(c.scenario()), c.time_step(),
                     c.state.ledger());
  };
  return p;
}

/// All processes, and frost before avalanching.
ProcessTable table_with(Process process) {
  ProcessTable table = process_table();
  const auto at = std::find_if(table.processes.begin(), table.processes.end(),
                               [](const Process& p) { return p.name == "avalanching"; });
  table.processes.insert(at, std::move(process));
  return table;
}

const char* const world =
    "grid: {width: 24, height: 20}\nterrain: [uniform: {layer: bedrock, value: 5}]\nwind: {speed: 0}\n"
    "frost: {enabled: true, rate: 0.01}\nrun: {check_every: 2}\n";

struct MadeUpProcess : ::testing::Test {
  std::unique_ptr<Exec> exec = make_exec("cpu", 1);
  std::unique_ptr<Simulation> made(const std::string& yaml, Process process = frost_process()) {
    return std::make_unique<Simulation>(*exec, test::scenario_of(yaml), no_raster_loader,
                                        table_with(std::move(process)));
  }
};

TEST_F(MadeUpProcess, StepsInItsPlaceAndConservesMaterial) {
  auto s = made(world);
  s->pipeline().set_timing(true);
  test::run(*s, 1);
  EXPECT_NEAR(s->terrain().values(Layer::sand)[0], 0.01, 1e-6);
  EXPECT_NEAR(s->terrain().values(Layer::bedrock)[0], 4.99, 1e-6);
  test::expect_sound(*s, "after frost");
  std::vector<std::string> order;
  for (const ProcessTime& time : s->pipeline().times()) order.push_back(time.process);
  const auto frost = std::find(order.begin(), order.end(), "frost");
  ASSERT_NE(frost, order.end());
  EXPECT_EQ(*(frost + 1), "avalanching");
  const auto memory = s->memory();
  const auto part = std::find_if(memory.begin(), memory.end(),
                                 [](const MemoryPart& p) { return p.name == "process frost"; });
  ASSERT_NE(part, memory.end());
  EXPECT_EQ(part->bytes, 24 * 20 * sizeof(float));
}

TEST_F(MadeUpProcess, ParametersAreReadCheckedWrittenAndChangedLive) {
  EXPECT_THROW(test::scenario_of("frost: {rate: 7}\n"), ConfigError);
  EXPECT_THROW(test::scenario_of("frost: {rat: 0.1}\n"), ConfigError);
  const Scenario again = parse_scenario_text(dump_scenario(test::scenario_of(world)), "again");
  EXPECT_EQ(parameters_of(again).rate, 0.01f);
  EXPECT_NE(describe_parameters().find("Depth of bare rock that breaks a second."), std::string::npos);

  auto s = made(world);
  s->apply(command::SetParameters{{"frost.rate=0.02"}, 0});
  s->step();
  EXPECT_NEAR(s->terrain().values(Layer::sand)[0], 0.02, 1e-6);
  s->apply(command::SetParameters{{"frost.enabled=false"}, 0});
  const std::vector<std::string> names = s->pipeline().launch_names();
  EXPECT_EQ(std::count(names.begin(), names.end(), "frost"), 0);
}

TEST_F(MadeUpProcess, IsInCheckpointsAndPages) {
  const test::TemporaryFolder folder;
  auto s = made(world);
  test::run(*s, 3);
  save_checkpoint(folder.path("frost"), *s);
  EXPECT_EQ(parameters_of(load_checkpoint(folder.path("frost"), *exec)->scenario()).rate, 0.01f);
  EXPECT_NE(describe_pipeline(s->pipeline()).find("frost"), std::string::npos);
  EXPECT_NE(describe_processes(table_with(frost_process())).find("| `frost` | made up |"), std::string::npos);
}

TEST_F(MadeUpProcess, ThatBreaksALayerIsNamed) {
  Process broken = frost_process();
  broken.step = [](StepContext& c, ProcessWorkspace*) {
    if (c.tick() != 1) return;  // the step that is checked
    std::vector<std::uint32_t> words = c.state.terrain.raw_words(Layer::sand);
    words[7] = static_cast<std::uint32_t>(-1);
    c.state.terrain.set_raw_words(Layer::sand, words);
  };
  auto s = made(world, broken);
  s->step();  // not a step that is checked
  try {
    s->step();
    FAIL() << "nobody has looked";
  } catch (const StateError& e) {
    EXPECT_NE(
        std::string(e.what()).find("frost: layer sand has an invalid value in 1 cells, the first at (7, 0)"),
        std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace desert_sim
