// Memory: what a simulation holds is what its parts say and what was planned, is little a cell, and is
// refused before anything is allocated where it does not fit.

#include "src/simulation/memory/memory.hpp"

#include <cstdio>

#include "src/simulation/checkpoint.hpp"
#include "src/simulation/forecast/forecast.hpp"
#include "test/support/refusal.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

/// Every process that moves sand.
const Settings all_aeolian = {"wind_shadow.enabled=true", "echo_dunes.enabled=true", "saltation.enabled=true",
                              "avalanching.enabled=true", "abrasion.rate=0.001"};
/// Scene A of desert_bench.
Scenario scene_a(int size, const Settings& settings = {}) {
  const std::string cells = std::to_string(size);
  return parse_scenario_text("grid: {width: " + cells + ", height: " + cells +
                                 ", cell_size: " + std::to_string(1024.0 / size) +
                                 "}\nterrain: [noise: {layer: sand, low: 0.5, high: 2}]\nwind: {speed: 5}\n",
                             "A", settings);
}
/// With cells of a metre: in larger ones the wind's transforms would be as fine as the grid.
Scenario scene(int size, Settings settings) {
  settings.push_back("grid.cell_size=1");
  return scene_a(size, settings);
}
double bytes_a_cell(const std::vector<MemoryPart>& parts, int size) {
  return static_cast<double>(total_bytes(parts)) / (static_cast<double>(size) * size);
}

/// A device with as much memory as a test says, where nothing may be allocated.
class TightExec final : public Exec {
 public:
  TightExec(Device kind, std::size_t available) : kind_(kind), available_(available) {}
  Device device() const override { return kind_; }
  std::string device_name() const override { return "a test's"; }
  std::size_t memory_available() const override { return available_; }
  void* allocate_host(std::size_t) override { throw Error("allocated on the host"); }
  void release_host(void*) noexcept override {}
  void set_zero(void*, std::size_t) override {}
  void copy(void*, const void*, std::size_t) override {}
  void upload(void*, const void*, std::size_t) override {}
  void download(void*, const void*, std::size_t) override {}
  void synchronise() override {}
  std::unique_ptr<Fft> make_fft(int, int, int, FftMethod) override { throw Error("made a transform"); }

 protected:
  void* allocate_memory(std::size_t) override { throw Error("allocated before it was refused"); }
  void free_memory(void*) noexcept override {}

 private:
  Device kind_;
  std::size_t available_;
};

std::string refusal(Exec& exec, const Scenario& scenario) {
  try {
    Simulation(exec, scenario, no_raster_loader);
  } catch (const ConfigError& e) {
    return e.what();
  }
  ADD_FAILURE() << "was not refused";
  return "";
}

std::size_t part(const std::vector<MemoryPart>& parts, const std::string& name) {
  for (const MemoryPart& p : parts)
    if (p.name == name) return p.bytes;
  return 0;
}

const char* const all_kinds[] = {
    "grid: {width: 96, height: 64}\n",
    "grid: {width: 96, height: 64, boundary: open}\nterrain: [obstacle: {height: 3}, uniform: {layer: soil, "
    "value: "
    "1}]\necho_dunes: {enabled: true}\nabrasion: {rate: 0.001}\n",
    "grid: {width: 64, height: 96}\nwind_shadow: {enabled: false}\navalanching: {scheme: sweeps}\nwind: "
    "{features: [{kind: vortex, x: 5, y: 5}]}\n",
};

class Memory : public test::OnBackend {};

TEST_P(Memory, PartsAreAllThatIsHeldAndWhatWasPlanned) {
  for (const char* text : all_kinds) {
    const std::size_t before = exec().bytes_held();
    const Scenario scenario = test::scenario_of(text);
    Simulation s(exec(), scenario, no_raster_loader);
    std::vector<MemoryPart> held = s.memory(), planned = planned_memory(s.scenario());
    ASSERT_EQ(held.size(), planned.size()) << text;
    for (std::size_t n = 0; n < held.size(); ++n) {
      EXPECT_EQ(held[n].name, planned[n].name) << text;
      if (held[n].name == "process wind")  // of which an estimate is theirs alone
        EXPECT_LE(held[n].bytes, planned[n].bytes * 2) << text;
      else
        EXPECT_EQ(held[n].bytes, planned[n].bytes) << held[n].name << " of\n" << text;
    }
    const std::size_t counted = exec().bytes_held() - before;
    EXPECT_LE(counted, total_bytes(held)) << text;
    if (exec().device() == Device::cpu) {
      EXPECT_EQ(counted, total_bytes(held)) << text;
    }
  }
}

TEST_P(Memory, IsGivenBack) {
  const std::size_t before = exec().bytes_held();
  simulation(all_kinds[1])->step();
  EXPECT_EQ(exec().bytes_held(), before);
}

TEST_P(Memory, OfAllAeolianProcessesIsAtMostSixtyBytesACell) {
  constexpr int size = 1024;  // smaller ones are mostly the wind's transforms and the ledger
  Simulation s(exec(), scene(size, all_aeolian), no_raster_loader);
  s.step();
  for (const MemoryPart& p : s.memory())
    std::printf("  %-28s %6.2f bytes a cell\n", p.name.c_str(), bytes_a_cell({p}, size));
  EXPECT_LE(bytes_a_cell(s.memory(), size), 60);
}

TEST(MemoryPlan, OfTheLargestBenchmarkIsAtMostSixtyBytesACell) {
  const auto plan = planned_memory(scene_a(16384, all_aeolian));
  EXPECT_LE(bytes_a_cell(plan, 16384), 60);
  EXPECT_EQ(part(plan, "sand"), std::size_t{4} * 16384 * 16384);
}

TEST(MemoryRefusal, TellsWhatIsNeededAndWhatThereIs) {
  const Scenario scenario = scene_a(1024);
  const std::size_t needed = total_bytes(planned_memory(scenario));
  for (const Device kind : {Device::cpu, Device::cuda}) {
    TightExec exec(kind, needed - 1);
    const std::string why = refusal(exec, scenario);
    for (const std::string& text :
         {std::string("1024 x 1024"), std::to_string(needed), std::to_string(needed - 1),
          std::string(" per cell"), std::string(exec.backend())})
      EXPECT_NE(why.find(text), std::string::npos) << "no '" << text << "' in: " << why;
  }
}

TEST(MemoryRefusal, CountsTheHostsMemoryWhileTheTerrainIsMade) {
  TightExec exec(Device::cuda, std::size_t{1} << 62);
  const Scenario scenario = scene_a(1024);
  EXPECT_NO_THROW(require_memory(exec, scenario, bytes_to_build(scenario)));
  try {
    require_memory(exec, scenario, 1e9);
    ADD_FAILURE() << "a million gigabytes were there";
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("on the host"), std::string::npos) << e.what();
  }
  EXPECT_EQ(bytes_to_build(scenario), 2 * 8 + 4) << "bedrock and sand as doubles, and one of them as quanta";
}

TEST(MemoryRefusal, OfGridsThatIndicesDoNotReach) {
  TightExec exec(Device::cuda, std::size_t{1} << 62);
  const auto scenario = [](int width, int height, const std::string& more) {
    return test::scenario_of("grid: {width: " + std::to_string(width) +
                             ", height: " + std::to_string(height) + more + "}\n");
  };
  EXPECT_NE(refusal(exec, scenario(65536, 32768, "")).find("2147483648"), std::string::npos);
  // An open grid's transform has twice the cells along either axis.
  const std::string why = refusal(exec, scenario(32768, 32768, ", cell_size: 10, boundary: open"));
  EXPECT_NE(why.find("wind.coarsening"), std::string::npos) << why;
  EXPECT_NE(why.find("4294967296"), std::string::npos) << why;
  EXPECT_THROW(Terrain(exec, Grid{65536, 65536, 1, true, true}, HeightScale{}), ConfigError);
}

TEST(MemoryRefusal, OfACheckpointThatDoesNotFit) {
  const test::TemporaryFolder folder;
  CpuExec enough(1);
  save_checkpoint(folder.path("small"), Simulation(enough, scene_a(32), no_raster_loader));
  TightExec tight(Device::cuda, 1000);
  EXPECT_THROW(load_checkpoint(folder.path("small"), tight), ConfigError);
}

TEST_P(Memory, OfAForecastIsASecondTerrainItsCheckpointAndItsMaps) {
  const auto s = simulation(all_kinds[0]);
  const double cells = 96 * 64;
  const ForecastMemory one = memory_for_forecast(*s, {60, 1, 1}), ten = memory_for_forecast(*s, {60, 10, 1}),
                       ensemble = memory_for_forecast(*s, {60, 10, 2});
  EXPECT_GT(one.on_device, static_cast<double>(total_bytes(s->memory())));
  EXPECT_EQ(ten.on_device, one.on_device);
  EXPECT_GE(one.on_host, static_cast<double>(s->terrain().bytes()) + 3 * (4 + 1 + 4 + 4) * cells);
  EXPECT_EQ(ten.on_host - one.on_host, 3 * 9 * (4 + 1) * cells) << "elevation and costs";
  EXPECT_EQ(ensemble.on_host - ten.on_host, 3 * 10 * 4 * cells) << "shares";
  EXPECT_NO_THROW(require_memory_for_forecast(*s, {60, 100, 64}));
}

TEST(MemoryRefusal, OfAForecastTellsWhatIsNeededAndWhatThereIs) {
  const Scenario scenario = scene_a(64, {});
  TightExec exec(Device::cuda, 999);
  const std::string device = test::refusal([&] { require_bytes(exec, scenario, 1000, 1, "for a forecast"); });
  for (const char* text :
       {"64 x 64", "1000 bytes", "available: 999 bytes", "on the cuda backend for a forecast"})
    EXPECT_NE(device.find(text), std::string::npos) << "no '" << text << "' in: " << device;
  const std::string host = test::refusal([&] { require_bytes(exec, scenario, 1, 1e18, "for a forecast"); });
  for (const char* text : {"1000000000000000000 bytes", "on the host for a forecast; available: "})
    EXPECT_NE(host.find(text), std::string::npos) << "no '" << text << "' in: " << host;
  EXPECT_NO_THROW(require_bytes(exec, scenario, 999, 1, "for a forecast"));
}

DESERT_ON_EACH_BACKEND(Memory);

}  // namespace
}  // namespace desert_sim
