#include "src/simulation/state/state.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/field/statistics.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/plants/density.hpp"
#include "kernels/plants/plant_order.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

SimulationState::SimulationState(const Scenario& scenario_at_start, Terrain empty_terrain)
    : start(scenario_at_start), scenario(scenario_at_start), terrain(std::move(empty_terrain)) {
  ledger_words = Buffer<long long>(exec(), LedgerView::words);
  ledger_words.set_zero();
  take_species();
}

void SimulationState::take_species() {
  const VegetationParameters& vegetation = scenario.get<VegetationParameters>();
  if (!vegetation.enabled) return;
  std::vector<SpeciesTraits> traits;
  for (const Species& species : scenario.species) traits.push_back(species.traits);
  if (plants) return plants::set_species(exec(), plants, traits, scenario.competition);
  const int most = vegetation.max_plants;
  plants = plants::make_workspace(exec(), terrain.grid(), most > 0 ? most : terrain.grid().cells(),
                                  vegetation.largest_plant, traits, scenario.competition);
}

Scenario SimulationState::present_scenario() const {
  Scenario present = scenario;
  present.wind_regime = wind_regime;
  present.wind_segments = wind_regime.segments;
  return present;
}

void SimulationState::keep_time(const RunParameters& run, int parts) {
  const double now = time(), paced = paced_time();
  if (run.acceleration != scenario.run.acceleration) {
    clock_origin.accelerated_at = now;
    clock_origin.paced_time = paced;
  }
  if (run.hold_time != scenario.run.hold_time) held_layers_known = false;
  if (run.time_step == scenario.run.time_step) return;
  const std::uint64_t done = steps - clock_origin.step;
  if (done > 0) {  // a hold_time that has begun since the last step needs layers of its own
    const double last = clock_origin.time + static_cast<double>(done - 1) * scenario.run.time_step;
    const double hold = run.hold_time;
    held_layers_known = held_layers_known && hold > 0 && std::floor(now / hold) == std::floor(last / hold);
  }
  clock_origin.tick += done * static_cast<std::uint64_t>(parts);
  clock_origin.step = steps;
  clock_origin.time = now;
}

std::vector<Layer> SimulationState::layers_in_use() const {
  std::vector<Layer> layers;
  for (const LayerInfo& row : layer_table)
    if (terrain.has(row.layer)) layers.push_back(row.layer);
  return layers;
}

bool SimulationState::has_held_layers() const {
  return std::any_of(layer_table.begin(), layer_table.end(), [this](const LayerInfo& row) {
    return row.lifetime == Lifetime::held && terrain.has(row.layer);
  });
}

void SimulationState::set_wind_regime(WindRegime regime) {
  regime.initial_wind = wind_regime.at(time());
  regime.series = scenario.wind_series;
  regime.start_time = time();
  wind_regime = std::move(regime);
}

void SimulationState::set_plants(const std::vector<std::uint32_t>& words) {
  const std::size_t count = words.size() / plants::column_count,
                    capacity = static_cast<std::size_t>(plants.capacity);
  if (count > capacity)
    throw ConfigError(std::to_string(count) + " plants exceed the capacity of " + std::to_string(capacity));
  for (std::size_t c = 0; c < plants::column_count && count > 0; ++c)
    exec().upload(plants.next.data() + c * capacity, words.data() + c * count, count * sizeof(std::uint32_t));
  with_backend(exec(), [&](auto& e) { plants::sort_plants(e, static_cast<int>(count), 0, plants); });
}

void SimulationState::begin_balance() {
  with_backend(exec(), [this](auto& e) { surface::fill_elevation(e, terrain.view()); });
  std::vector<Quanta> surface;
  for (std::uint32_t word : terrain.raw_words(Layer::elevation)) surface.push_back(static_cast<Quanta>(word));
  // The 1st percentile. No parameter: it is found once, and checkpoints hold it.
  const auto percentile = surface.begin() + static_cast<std::ptrdiff_t>((surface.size() - 1) / 100);
  std::nth_element(surface.begin(), percentile, surface.end());
  wind_reference = *percentile;
  for (int m = 0; m < material_count; ++m)
    initial[static_cast<std::size_t>(m)] = material_now(static_cast<Material>(m));
}

std::vector<long long> SimulationState::read_ledger() const {
  const std::vector<long long> words = ledger_words.download();
  std::vector<long long> accounts(material_count * 2, 0);
  for (std::size_t n = 0; n < words.size(); ++n) accounts[n / LedgerView::stripes] += words[n];
  return accounts;
}

void SimulationState::write_ledger(const std::vector<long long>& accounts) {
  std::vector<long long> words(LedgerView::words, 0);
  for (std::size_t account = 0; account < accounts.size(); ++account)
    words[account * LedgerView::stripes] = accounts[account];
  ledger_words.upload(words);
}

long long SimulationState::material_now(Material material) const {
  const auto total = [this](Layer layer) {
    const Quanta* values = terrain.has(layer) ? terrain.view().quanta(layer) : nullptr;
    return with_backend(exec(), [&](auto& e) { return statistics::sum(e, terrain.grid(), values); });
  };
  switch (material) {
    case Material::bedrock:
      return total(Layer::bedrock);
    case Material::soil:
      return total(Layer::soil);
    case Material::sand:
      return total(Layer::sand) + total(Layer::airborne_sand);
    case Material::water:
      return total(Layer::water);
    case Material::sediment:
      return total(Layer::suspended_sediment);
    case Material::moisture:
      return total(Layer::moisture);
  }
  throw Error("the material is unknown");
}

std::array<MaterialBalance, material_count> SimulationState::balance() const {
  const std::vector<long long> accounts = read_ledger();
  const double cell = scenario.grid.cell_size * scenario.grid.cell_size;
  std::array<MaterialBalance, material_count> all;
  for (std::size_t m = 0; m < all.size(); ++m) {
    all[m].initial = initial[m];
    all[m].final = material_now(static_cast<Material>(m));
    all[m].in = accounts[2 * m];
    all[m].out = accounts[2 * m + 1];
    all[m].quantum_volume = terrain.scale().quantum() * cell;
  }
  all[static_cast<std::size_t>(Material::bedrock)].base_volume =
      terrain.scale().datum * cell * terrain.grid().cells();
  return all;
}

double MaterialBalance::relative_residual() const {
  if (residual() == 0) return 0;
  const double size =
      std::max({std::abs(static_cast<double>(initial)), std::abs(static_cast<double>(final)), 1.0});
  return static_cast<double>(residual()) / size;
}

std::vector<PlantCount> SimulationState::plant_counts() const {
  std::vector<PlantCount> all;
  if (!plants) return all;
  for (const Species& species : scenario.species) all.push_back({species.name});
  const auto count = static_cast<std::size_t>(plants.count),
             capacity = static_cast<std::size_t>(plants.capacity);
  const auto column = [&](plants::Column c) {
    std::vector<std::uint32_t> words(count);
    if (count > 0) plants.now.download(static_cast<std::size_t>(c) * capacity, count, words.data());
    return words;
  };
  const std::vector<std::uint32_t> kinds = column(plants::Column::species),
                                   radii = column(plants::Column::radius);
  for (std::size_t n = 0; n < count; ++n) {
    PlantCount& of_kind = all[kinds[n]];
    ++of_kind.plants;
    of_kind.mature += plants::is_mature(scenario.species[kinds[n]].traits, float_from_bits(radii[n])) ? 1 : 0;
  }
  return all;
}

}  // namespace desert_sim
