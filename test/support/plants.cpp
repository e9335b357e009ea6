#include "test/support/plants.hpp"

#include <cmath>

#include "kernels/plants/plant_order.hpp"

namespace desert_sim::test {

namespace {
constexpr float quanta_per_metre = 1048576;

std::vector<float> all_ones(std::size_t species) { return std::vector<float>(species * species, 1.0f); }

/// Calls visit(column, member) for the columns of real numbers but z.
template <class Visit>
void for_each_real(Visit&& visit) {
  using plants::Column;
  visit(Column::x, &Plant::x), visit(Column::y, &Plant::y), visit(Column::radius, &Plant::radius);
  visit(Column::health, &Plant::health), visit(Column::water, &Plant::water), visit(Column::age, &Plant::age);
}
}  // namespace

SpeciesTraits undemanding() {
  SpeciesTraits s;
  s.water_use = 0;
  s.moisture_lowest = 0;
  s.moisture_highest = 1;
  s.light_lowest = 0;
  s.light_highest = 2;
  s.sand = 1;
  s.maturity_time = 1e9f;
  s.spawn = 0;
  s.humus = 0;
  return s;
}

PlantBench::PlantBench(Exec& exec, int width, int height, std::vector<SpeciesTraits> species,
                       double cell_size, bool periodic, int capacity, std::vector<float> competition)
    : terrain(exec, width, height, cell_size, periodic),
      work(plants::make_workspace(exec, terrain.grid(), capacity > 0 ? capacity : terrain.grid().cells(),
                                  VegetationParameters().largest_plant, species,
                                  competition.empty() ? all_ones(species.size()) : competition)) {
  for (Layer layer : {Layer::vegetation, Layer::humus, Layer::canopy_height, Layer::illumination,
                      Layer::illumination_canopy})
    terrain.terrain.allocate(layer);
  terrain.set(Layer::bedrock, -100).set(Layer::soil, 100);
  terrain.surface();
}

void PlantBench::put(const std::vector<Plant>& plants) {
  const auto room = static_cast<std::size_t>(work.capacity);
  std::vector<std::uint32_t> words(plants::column_count * room, 0);
  const auto at = [&](plants::Column c, std::size_t n) -> std::uint32_t& {
    return words[static_cast<std::size_t>(c) * room + n];
  };
  for (std::size_t n = 0; n < plants.size(); ++n) {
    for_each_real([&](plants::Column c, float Plant::*member) { at(c, n) = bits_of(plants[n].*member); });
    at(plants::Column::z, n) =
        static_cast<std::uint32_t>(static_cast<Quanta>(std::lround(plants[n].z * quanta_per_metre)));
    at(plants::Column::species, n) = static_cast<std::uint32_t>(plants[n].species);
  }
  work.next.upload(words);
  with_backend(terrain.exec(),
               [&](auto& e) { plants::sort_plants(e, static_cast<int>(plants.size()), 0, work); });
}

std::vector<Plant> PlantBench::plants() const {
  const std::vector<std::uint32_t> words = plants::words(work);
  const auto count = static_cast<std::size_t>(work.count);
  std::vector<Plant> found(count);
  const auto at = [&](plants::Column c, std::size_t n) {
    return words[static_cast<std::size_t>(c) * count + n];
  };
  for (std::size_t n = 0; n < count; ++n) {
    for_each_real(
        [&](plants::Column c, float Plant::*member) { found[n].*member = float_from_bits(at(c, n)); });
    found[n].z = static_cast<float>(static_cast<Quanta>(at(plants::Column::z, n))) / quanta_per_metre;
    found[n].species = static_cast<int>(at(plants::Column::species, n));
  }
  return found;
}

void PlantBench::cover(float time_step, bool makes_state) {
  terrain.surface();
  with_backend(terrain.exec(), [&](auto& e) {
    plants::cover(e, terrain.terrain.view(), parameters, {time_step, terrain.heights, makes_state},
                  terrain.roll_dice(), work);
  });
  terrain.exec().synchronise();
}

void PlantBench::illuminate() {
  with_backend(terrain.exec(), [&](auto& e) {
    plants::illuminate(e, terrain.terrain.view(), parameters, terrain.heights, work);
  });
  terrain.exec().synchronise();
}

void PlantBench::live(float time_step, std::uint64_t step, std::uint64_t seed, bool lit) {
  terrain.surface();
  if (lit) terrain.set(Layer::illumination, 1).set(Layer::illumination_canopy, 1);
  with_backend(terrain.exec(), [&](auto& e) {
    plants::grow_and_spawn(e, terrain.terrain.view(),
                           {parameters, repose, terrain.heights, time_step, seed, step}, terrain.roll_dice(),
                           terrain.ledger(), work);
  });
  terrain.exec().synchronise();
}

void PlantBench::step(float time_step, std::uint64_t number) {
  cover(time_step);
  illuminate();
  live(time_step, number, 1, false);
}

}  // namespace desert_sim::test
