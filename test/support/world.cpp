#include "test/support/world.hpp"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "kernels/field/statistics.hpp"
#include "src/scenario/wind_series_file.hpp"

namespace desert_sim::test {

Scenario parsed(const std::string& yaml) { return parse_scenario(YAML::Load(yaml), "test", "."); }

Scenario scenario_of(const std::string& yaml) {
  Scenario scenario = parsed(yaml);
  resolve_grid(scenario, no_raster_loader);
  read_wind_series(scenario);
  return scenario;
}

std::unique_ptr<Simulation> simulate(Exec& exec, const std::string& yaml) {
  return std::make_unique<Simulation>(exec, scenario_of(yaml), no_raster_loader);
}

void run(Simulation& simulation, int steps) {
  for (int n = 0; n < steps; ++n) simulation.step();
}

namespace {
template <class T>
std::vector<T> words_as(const Simulation& simulation, Layer layer) {
  std::vector<T> values(static_cast<std::size_t>(simulation.terrain().grid().cells()), T{});
  if (!simulation.terrain().has(layer)) return values;
  const std::vector<std::uint32_t> words = simulation.terrain().raw_words(layer);
  std::memcpy(values.data(), words.data(), words.size() * sizeof(T));
  return values;
}
}  // namespace

std::vector<Quanta> quanta(const Simulation& simulation, Layer layer) {
  return words_as<Quanta>(simulation, layer);
}
std::vector<float> real(const Simulation& simulation, Layer layer) {
  return words_as<float>(simulation, layer);
}

std::vector<Layer> persistent_layers(const Simulation& simulation) {
  std::vector<Layer> layers;
  for (const LayerInfo& row : layer_table)
    if (row.lifetime == Lifetime::persistent && simulation.terrain().has(row.layer))
      layers.push_back(row.layer);
  return layers;
}

void expect_sound(Simulation& simulation, const std::string& when) {
  const auto balance = simulation.state().balance();
  for (std::size_t m = 0; m < balance.size(); ++m)
    EXPECT_EQ(balance[m].residual(), 0) << when << ": " << material_names[m] << " made or lost, in quanta";
  for (const LayerInfo& row : layer_table) {
    if (!simulation.terrain().has(row.layer)) continue;
    const bool depth = row.lifetime == Lifetime::persistent && row.lowest == 0;
    long bad = 0;
    if (row.storage == Storage::quanta) {
      for (Quanta v : quanta(simulation, row.layer)) bad += statistics::breaks_contract(v, depth);
    } else {
      for (float v : real(simulation, row.layer)) bad += !std::isfinite(v) || (depth && v < 0);
    }
    EXPECT_EQ(bad, 0) << when << ": cells of " << row.name << " that are negative or not finite";
  }
}

bool gpu_required() {
  const char* value = std::getenv("DESERT_REQUIRE_GPU");
  return value && std::string(value) == "1";
}

void OnBackend::SetUp() {
  if (std::string(GetParam()) == "cuda") DESERT_NEED_GPU();
  exec_ = make_exec(GetParam(), 1);  // other numbers of threads: property/determinism_test.cpp
}

}  // namespace desert_sim::test
