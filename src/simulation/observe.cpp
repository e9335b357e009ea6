/// Looking at a simulation: hash, balance, figures. (Snapshots: snapshot.cpp.)
#include <xxhash.h>

#include <algorithm>
#include <cmath>

#include "kernels/plants/density.hpp"
#include "src/core/error.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

std::vector<Layer> Simulation::layers_in_use() const {
  std::vector<Layer> layers;
  for (const LayerInfo& row : layer_table)
    if (terrain_.has(row.layer)) layers.push_back(row.layer);
  return layers;
}

std::uint64_t Simulation::state_hash() const {
  XXH3_state_t* state = XXH3_createState();
  if (!state) throw Error("no memory for a hash");
  XXH3_64bits_reset(state);
  for (const LayerInfo& row : layer_table) {
    if (row.lifetime != Lifetime::persistent || !terrain_.has(row.layer)) continue;
    const std::vector<std::uint32_t> words = terrain_.words(row.layer);
    XXH3_64bits_update(state, row.name, std::char_traits<char>::length(row.name));
    XXH3_64bits_update(state, words.data(), words.size() * sizeof(std::uint32_t));
  }
  if (plants_) {
    const std::vector<std::uint32_t> words = plants::words(plants_);
    XXH3_64bits_update(state, "plants", 6);
    XXH3_64bits_update(state, words.data(), words.size() * sizeof(std::uint32_t));
  }
  const std::vector<long long> books = read_ledger();
  XXH3_64bits_update(state, books.data(), books.size() * sizeof(long long));
  XXH3_64bits_update(state, &steps_, sizeof steps_);
  const std::uint64_t hash = XXH3_64bits_digest(state);
  XXH3_freeState(state);
  return hash;
}

std::vector<long long> Simulation::read_ledger() const {
  const std::vector<long long> words = ledger_.download();
  std::vector<long long> accounts(material_count * 2, 0);
  for (std::size_t n = 0; n < words.size(); ++n) accounts[n / LedgerView::stripes] += words[n];
  return accounts;
}

long long Simulation::material_now(Material material) {
  const auto total = [this](Layer layer) {
    return with_backend(exec(), [&](auto& e) {
      return statistics::sum(e, terrain_.grid(),
                             terrain_.has(layer) ? terrain_.view().quanta(layer) : nullptr);
    });
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
  throw Error("unknown material");
}

std::vector<PlantCount> Simulation::plant_counts() const {
  std::vector<PlantCount> counts;
  if (!plants_) return counts;
  for (const Species& species : scenario_.species) counts.push_back({species.name});
  const auto count = static_cast<std::size_t>(plants_.count),
             room = static_cast<std::size_t>(plants_.capacity);
  const auto column = [&](plants::Column c) {
    std::vector<std::uint32_t> words(count);
    if (count > 0) plants_.now.download(static_cast<std::size_t>(c) * room, count, words.data());
    return words;
  };
  const std::vector<std::uint32_t> kinds = column(plants::Column::species),
                                   radii = column(plants::Column::radius);
  for (std::size_t n = 0; n < count; ++n) {
    PlantCount& of_kind = counts[kinds[n]];
    ++of_kind.plants;
    of_kind.mature += plants::is_mature(scenario_.species[kinds[n]].traits, float_of(radii[n])) ? 1 : 0;
  }
  return counts;
}

double MaterialBalance::relative_residual() const {
  if (residual() == 0) return 0;
  const double size =
      std::max({std::abs(static_cast<double>(initial)), std::abs(static_cast<double>(final)), 1.0});
  return static_cast<double>(residual()) / size;
}

std::array<MaterialBalance, material_count> Simulation::balance() {
  const std::vector<long long> books = read_ledger();
  const double cell = scenario_.grid.cell_size * scenario_.grid.cell_size;
  std::array<MaterialBalance, material_count> all;
  for (std::size_t m = 0; m < all.size(); ++m)
    all[m] = {initial_[m],      material_now(static_cast<Material>(m)), books[2 * m],
              books[2 * m + 1], terrain_.scale().quantum() * cell,      0.0};
  all[static_cast<std::size_t>(Material::bedrock)].base_volume =
      terrain_.scale().datum * cell * terrain_.grid().cells();
  return all;
}

Residual Simulation::residual() {
  refresh_derived();
  return with_backend(exec(),
                      [this](auto& e) { return statistics::residual(e, terrain_.view(), repose_.data()); });
}

double Simulation::max_sand_slope_deg() {
  const float tangent =
      with_backend(exec(), [this](auto& e) { return statistics::sand_slope(e, terrain_.view()); });
  return std::atan(tangent) * 180 / 3.14159265358979;
}

std::uint64_t Simulation::avalanche_iterations() const {
  return avalanche_iterations_ + static_cast<std::uint64_t>(avalanche_work_.counted_iterations());
}

double Simulation::mean_avalanche_iterations() const {
  return steps_ ? static_cast<double>(avalanche_iterations()) / static_cast<double>(steps_) : 0.0;
}

void Simulation::clear_process_times() { process_times_.clear(); }

}  // namespace desert_sim
