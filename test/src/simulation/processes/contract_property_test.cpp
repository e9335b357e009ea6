// Every process changes only the layers that its row says it writes, and what it does depends only on those
// that its row says it reads. The processes come from the table: a new one is tested without a line here.

#include <algorithm>
#include <map>
#include <set>

#include "src/simulation/processes/processes.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

/// Between them, these worlds give every process something to do, by every scheme.
const std::map<std::string, std::string> worlds{
    {"everything",
     "grid: {width: 40, height: 36, boundary: open}\n"
     "terrain: [noise: {layer: bedrock, low: 0, high: 8, scale: 9}, uniform: {layer: soil, value: 0.4},\n"
     "  noise: {layer: sand, low: 0.1, high: 2, scale: 5}, uniform: {layer: water, value: 0.05},\n"
     "  uniform: {layer: erosion_resistance, value: 0.2}, uniform: {layer: moisture, value: 0.02},\n"
     "  obstacle: {shape: box, x: 20, y: 18, size_x: 4, size_y: 4, height: 9}]\n"
     "wind: {speed: 6, direction_deg: 20, features: [{kind: vortex, x: 10, y: 10, radius: 5}]}\n"
     "echo_dunes: {enabled: true}\nabrasion: {rate: 0.05, cover: 3}\nsaltation: {influx: 0.3, flux: true}\n"
     "reptation: {method: smoothing}\nrain: {rate: 1.0e-4}\n"
     "water: {evaporation: 0.05, wave_strength: 0.1, sea: border, sea_level: 1,\n"
     "  springs: [{x: 12, y: 20, radius: 3, discharge: 2}]}\n"
     "hydraulic_erosion: {enabled: true}\nmoisture: {enabled: true}\nsoil: {enabled: true, dry: 1}\n"
     "vegetation: {enabled: true, draw: 1}\n"
     "species: [{preset: bush, spawn: 50000, moisture_lowest: 0, moisture_highest: 1, slope: 100}]\n"
     "run: {check_every: 1}\n"},
    {"steep",
     "grid: {width: 40, height: 36}\n"
     "terrain: [noise: {layer: bedrock, low: 0, high: 90, scale: 5}, noise: {layer: soil, low: 0, high: 30, "
     "scale: 5},\n"
     "  noise: {layer: sand, low: 0, high: 20, scale: 3}]\n"
     "wind: {speed: 6}\nabrasion: {rate: 0.01}\nreptation: {method: steepest}\nsoil: {enabled: true}\n"
     "looseness: {enabled: true}\n"
     "avalanching: {bedrock_to_sand: false}\n"},
    {"continuum",
     "grid: {width: 40, height: 36, boundary: open}\n"
     "terrain: [noise: {layer: bedrock, low: 0, high: 3, scale: 9}, uniform: {layer: soil, value: 0.4},\n"
     "  noise: {layer: sand, low: 0, high: 2, scale: 5, threshold: 0.4}, uniform: {layer: moisture, value: "
     "0.002},\n"
     "  noise: {layer: vegetation, low: 0, high: 1, scale: 6, threshold: 0.5, seed: 4},\n"
     "  obstacle: {shape: box, x: 20, y: 18, size_x: 4, size_y: 4, height: 9}]\n"
     "wind: {speed: 12, direction_deg: 20, features: [{kind: vortex, x: 10, y: 10, radius: 5}]}\n"
     "sand: {model: continuum}\nsaltation: {influx: 1.0e-5, flux: true}\nabrasion: {rate: 0.05, cover: 3}\n"
     "echo_dunes: {enabled: true}\nlooseness: {enabled: true}\nrun: {time_step: 600}\n"},
    {"desertscape_2019",
     "grid: {width: 40, height: 36, boundary: open}\n"
     "terrain: [noise: {layer: bedrock, low: 0, high: 3, scale: 9}, uniform: {layer: soil, value: 0.4},\n"
     "  noise: {layer: sand, low: 0, high: 2, scale: 5, threshold: 0.4}, uniform: {layer: moisture, value: "
     "0.002},\n"
     "  uniform: {layer: airborne_sand, value: 0.2}, uniform: {layer: erosion_resistance, value: 0.2},\n"
     "  noise: {layer: vegetation, low: 0, high: 1, scale: 6, threshold: 0.5, seed: 4},\n"
     "  obstacle: {shape: box, x: 20, y: 18, size_x: 4, size_y: 4, height: 9}]\n"
     "wind: {speed: 6, direction_deg: 20}\nsand: {model: desertscape_2019}\nsaltation: {influx: 0.5, flux: "
     "true}\n"
     "abrasion: {rate: 0.05, cover: 3}\necho_dunes: {enabled: true}\n"},
    {"werner",
     "grid: {width: 40, height: 36, boundary: open}\n"
     "terrain: [noise: {layer: bedrock, low: 0, high: 3, scale: 9}, uniform: {layer: soil, value: 0.4},\n"
     "  noise: {layer: sand, low: 0, high: 4, scale: 5, threshold: 0.4},\n"
     "  obstacle: {shape: box, x: 20, y: 18, size_x: 4, size_y: 4, height: 9}]\n"
     "wind: {speed: 5, direction_deg: 20}\nsaltation: {influx: 0.5}\nsand: {model: werner}\n"},
    {"momiji",
     "grid: {width: 40, height: 36, boundary: open}\n"
     "terrain: [noise: {layer: bedrock, low: 0, high: 3, scale: 9}, uniform: {layer: soil, value: 0.4},\n"
     "  noise: {layer: sand, low: 0, high: 4, scale: 5, threshold: 0.4},\n"
     "  obstacle: {shape: box, x: 20, y: 18, size_x: 4, size_y: 4, height: 9}]\n"
     "wind: {speed: 5, direction_deg: 20}\nsaltation: {influx: 0.5}\nsand: {model: momiji}\n"},
    {"bishop",
     "grid: {width: 40, height: 36, boundary: open}\n"
     "terrain: [noise: {layer: bedrock, low: 0, high: 3, scale: 9}, uniform: {layer: soil, value: 0.4},\n"
     "  noise: {layer: sand, low: 0, high: 4, scale: 5, threshold: 0.4},\n"
     "  obstacle: {shape: box, x: 20, y: 18, size_x: 4, size_y: 4, height: 9}]\n"
     "wind: {speed: 5, direction_deg: 20}\nsaltation: {influx: 0.5}\nsand: {model: bishop}\n"},
    {"wang",
     "grid: {width: 40, height: 36, cell_size: 0.01, boundary: open}\n"
     "terrain: [noise: {layer: bedrock, low: 0, high: 0.01, scale: 0.1}, uniform: {layer: soil, value: "
     "0.01},\n"
     "  noise: {layer: sand, low: 0, high: 0.02, scale: 0.05, threshold: 0.4},\n"
     "  uniform: {layer: moisture, value: 0.0002},\n"
     "  noise: {layer: vegetation, low: 0, high: 1, scale: 0.06, threshold: 0.5, seed: 4},\n"
     "  obstacle: {shape: box, x: 0.2, y: 0.18, size_x: 0.04, size_y: 0.04, height: 0.09}]\n"
     "wind: {speed: 12, direction_deg: 20}\nsaltation: {influx: 2.0e-6}\nsand: {model: wang}\n"
     "looseness: {enabled: true}\n"},
    {"nield_baas",
     "grid: {width: 40, height: 36, boundary: open}\n"
     "terrain: [noise: {layer: bedrock, low: 0, high: 3, scale: 9}, uniform: {layer: soil, value: 0.4},\n"
     "  noise: {layer: sand, low: 0, high: 4, scale: 5, threshold: 0.4},\n"
     "  noise: {layer: grass, low: 0, high: 1, scale: 5}, uniform: {layer: mesquite, value: -0.2},\n"
     "  noise: {layer: shrub, low: -0.5, high: 0.5, scale: 9},\n"
     "  obstacle: {shape: box, x: 20, y: 18, size_x: 4, size_y: 4, height: 9}]\n"
     "wind: {speed: 5, direction_deg: 20}\nsaltation: {influx: 0.5}\nslab_plants: {growth_time: 5}\n"
     "sand: {model: nield_baas}\nslab_model: {slab_height: 0.1, forced_erosion: true}\n"},
    {"snow",
     "grid: {width: 40, height: 36, cell_size: 0.25}\n"
     "terrain: [noise: {layer: bedrock, low: 0, high: 0.5, scale: 3},\n"
     "  noise: {layer: sand, low: 0, high: 0.4, scale: 2, threshold: 0.4}]\n"
     "wind: {speed: 5, direction_deg: 20}\nrun: {time_step: 3600}\n"
     "sand: {model: snow}\nslab_model: {slab_height: 0.02, poll_time: 3600}\nslab_snow: {settling_time: "
     "3600}\n"},
    {"overfull",
     "grid: {width: 40, height: 36, boundary: open}\n"
     "terrain: [uniform: {layer: sand, value: 2}]\nwind: {speed: 5, direction_deg: 20}\n"
     "saltation: {influx: 100}\n"},
    {"flood",
     "grid: {width: 40, height: 36, boundary: open}\n"
     "terrain: [noise: {layer: bedrock, low: 0, high: 8, scale: 9}, uniform: {layer: soil, value: 0.4},\n"
     "  uniform: {layer: sand, value: 0.3}, noise: {layer: water, low: 0, high: 3, scale: 8}]\n"
     "wind: {speed: 5, direction_deg: 20}\nhydraulic_erosion: {enabled: true}\n"
     "water: {model: shallow_water, manning: 0.03, wave_strength: 0.1, sea: border, sea_level: 1}\n"},
    {"still",
     "grid: {width: 40, height: 36}\nterrain: [noise: {layer: sand, low: 0, high: 9, scale: 3}]\n"
     "saltation: {enabled: false}\navalanching: {scheme: sweeps, sweeps: 3}\nwind_shadow: {curved: true}\n"},
};

using Words = std::vector<std::uint32_t>;

std::vector<Words> all_words(const Simulation& s) {
  std::vector<Words> words;
  for (const LayerInfo& row : layer_table) words.push_back(s.terrain().raw_words(row.layer));
  return words;
}

/// Every layer is in use, so that a process could write what it should not.
void bring_all_into_use(Simulation& s) {
  for (const LayerInfo& row : layer_table) s.state().terrain.allocate(row.layer);
}

/// Changes every cell, to values that the layer may have.
void disturb(Simulation& s, Layer layer) {
  Words words = s.terrain().raw_words(layer);
  const bool quanta = info(layer).storage == Storage::quanta;
  for (std::size_t i = 0; i < words.size(); ++i)
    words[i] = quanta ? static_cast<std::uint32_t>(static_cast<Quanta>(words[i]) + 300000 +
                                                   1000 * static_cast<Quanta>(i % 7))
                      : bits_of(0.5f * float_from_bits(words[i]) + 0.0625f * static_cast<float>(1 + i % 5));
  s.state().terrain.set_raw_words(layer, words);
}

class Contract : public test::OnBackend {
 protected:
  /// After a few steps, with every layer in use.
  std::unique_ptr<Simulation> world(const std::string& name) {
    auto s = simulation(worlds.at(name));
    test::run(*s, 4);
    s->exec().synchronise();
    bring_all_into_use(*s);
    if (name == "overfull")  // no scenario begins so full
      s->state().terrain.set_raw_words(
          Layer::sand,
          Words(static_cast<std::size_t>(s->terrain().grid().cells()), fill_limit + (Quanta{1} << 24)));
    return s;
  }
};

TEST_P(Contract, ProcessesWriteOnlyTheLayersOfTheirRows) {
  std::set<std::string> idle;
  for (const Process& p : process_table().processes)
    if (!p.writes.empty()) idle.insert(p.name);
  for (const auto& [name, text] : worlds) {
    std::vector<std::string> active;
    const auto reference = world(name);
    for (const Pipeline::Stage& stage : reference->pipeline().stages()) active.push_back(stage.process->name);
    for (const std::string& process : active) {
      SCOPED_TRACE(process + " in " + name);
      const auto row = std::find_if(process_table().processes.begin(), process_table().processes.end(),
                                    [&](const Process& p) { return p.name == process; });
      auto s = world(name);
      // What a process computes anew each time would be the same again.
      for (Layer layer : row->writes)
        if (info(layer).storage == Storage::real) disturb(*s, layer);
      const std::vector<Words> before = all_words(*s);
      s->pipeline().step_alone(process);
      const std::vector<Words> after = all_words(*s);
      for (const LayerInfo& layer : layer_table) {
        const auto n = static_cast<std::size_t>(layer.layer);
        if (before[n] == after[n]) continue;
        EXPECT_TRUE(row->may_write(layer.layer)) << "writes " << layer.name << ", which its row does not say";
        idle.erase(process);
      }
    }
  }
  for (const std::string& process : idle) ADD_FAILURE() << process << " had nothing to do in any world";
}

TEST_P(Contract, ProcessesDependOnlyOnTheLayersOfTheirRows) {
  for (const auto& [name, text] : worlds) {
    const auto reference = world(name);
    for (const Pipeline::Stage& stage : reference->pipeline().stages()) {
      const Process& p = *stage.process;
      SCOPED_TRACE(p.name + " in " + name);
      auto plain = world(name), disturbed = world(name);
      for (const LayerInfo& layer : layer_table)
        if (std::count(p.reads.begin(), p.reads.end(), layer.layer) == 0 && !p.may_write(layer.layer))
          disturb(*disturbed, layer.layer);
      plain->pipeline().step_alone(p.name);
      disturbed->pipeline().step_alone(p.name);
      for (const std::vector<Layer>* layers : {&p.writes, &p.writes_if_in_use})
        for (Layer layer : *layers)
          EXPECT_EQ(plain->terrain().raw_words(layer), disturbed->terrain().raw_words(layer))
              << "what it writes to " << info(layer).name
              << " depends on a layer that its row does not say it reads";
      EXPECT_EQ(plain->pipeline().fields().repose.download(),
                disturbed->pipeline().fields().repose.download());
      EXPECT_EQ(plants::words(plain->state().plants), plants::words(disturbed->state().plants));
    }
  }
}

/// What refreshes derived layers before somebody looks must leave the state alone.
TEST_P(Contract, RefreshingDerivedLayersChangesNoState) {
  for (const auto& [name, text] : worlds) {
    SCOPED_TRACE(name);
    auto s = world(name);
    const std::uint64_t before = s->state().hash();
    s->pipeline().derived_changed();
    s->pipeline().refresh_derived();
    EXPECT_EQ(s->state().hash(), before);
  }
}

TEST(ProcessTable, RowsAreComplete) {
  std::set<std::string> names;
  const Scenario scenario;
  for (const Process& p : process_table().processes) {
    SCOPED_TRACE(p.name);
    EXPECT_TRUE(names.insert(p.name).second) << "two rows have this name";
    EXPECT_FALSE(p.source.empty());
    EXPECT_FALSE(p.parameters.empty());
    EXPECT_TRUE(p.active && p.step && p.can_be_recorded);
    if (p.adapt || p.counted || p.after_step) {
      EXPECT_TRUE(p.make_workspace) << "it keeps nothing that could be stale or count";
    }
    for (Layer layer : p.writes)
      EXPECT_EQ(std::count(p.writes_if_in_use.begin(), p.writes_if_in_use.end(), layer), 0)
          << info(layer).name;
  }
  for (const FusedProcesses& f : process_table().fused)
    EXPECT_TRUE(names.count(f.first) && names.count(f.second)) << f.name;
}

/// If this fails: desert_run --describe-processes > config/processes.md
TEST(ProcessTable, PageIsUpToDate) {
  const std::string page = test::file_bytes(std::string(DESERT_SOURCE_DIR) + "/config/processes.md");
  EXPECT_EQ(page, describe_processes(process_table()))
      << "config/processes.md is stale: desert_run --describe-processes > config/processes.md";
}

TEST(ProcessTable, EveryProcessHasItsHeader) {
  for (const Process& p : process_table().processes)
    EXPECT_FALSE(test::file_bytes(std::string(DESERT_SOURCE_DIR) + "/" + p.header).empty()) << p.header;
}

DESERT_ON_EACH_BACKEND(Contract);

}  // namespace
}  // namespace desert_sim
