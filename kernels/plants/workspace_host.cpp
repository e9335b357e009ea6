#include <utility>

#include "kernels/plants/workspace.hpp"

namespace desert_sim::plants {

Workspace make_workspace(Exec& exec, const Grid& grid, int capacity, float largest_plant,
                         const std::vector<SpeciesTraits>& species, const std::vector<float>& competition) {
  const auto cells = static_cast<std::size_t>(grid.cells()), room = static_cast<std::size_t>(capacity);
  Workspace work;
  work.capacity = capacity;
  work.lookup = Lookup(grid, largest_plant);
  for (Buffer<std::uint32_t>* columns : {&work.now, &work.next})
    *columns = Buffer<std::uint32_t>(exec, column_count * room);
  work.neighbours = Buffer<Neighbour>(exec, room);
  work.begins = Buffer<std::int32_t>(exec, static_cast<std::size_t>(work.lookup.cells) + 1);
  work.begins.set_zero();
  work.sort_workspace = SortWorkspace(exec, capacity, grid.cells() + 1);
  work.granted_water = Buffer<Quanta>(exec, room);
  work.water_requests = Buffer<long long>(exec, cells);
  work.seeds = Buffer<int>(exec, cells + 1);
  work.seeds.set_zero();
  work.seed_offsets = Buffer<int>(exec, cells + 1);
  work.event_counts = Buffer<int>(exec, 2);
  work.tops = surface::make_heights(exec, grid);
  set_species(exec, work, species, competition);
  return work;
}

void set_species(Exec& exec, Workspace& work, const std::vector<SpeciesTraits>& species,
                 const std::vector<float>& competition) {
  Buffer<SpeciesTraits> traits(exec, species.size());
  traits.upload(species);
  Buffer<float> matrix(exec, competition.size());
  matrix.upload(competition);
  if (work.species_count != static_cast<int>(species.size())) {
    const std::size_t cells = work.water_requests.size();
    Buffer<float> density(exec, cells * species.size()), downwind(exec, cells * species.size());
    density.set_zero();
    downwind.set_zero();
    work.density = std::move(density);
    work.downwind = std::move(downwind);
  }
  work.species = std::move(traits);
  work.competition = std::move(matrix);
  work.species_count = static_cast<int>(species.size());
}

std::size_t Workspace::bytes() const {
  return now.bytes() + next.bytes() + neighbours.bytes() + begins.bytes() + sort_workspace.bytes() +
         species.bytes() + competition.bytes() + granted_water.bytes() + water_requests.bytes() +
         density.bytes() + downwind.bytes() + seeds.bytes() + seed_offsets.bytes() + event_counts.bytes() +
         tops.cell_heights.bytes() + tops.highest.bytes();
}

std::vector<std::uint32_t> words(const Workspace& work) {
  const auto count = static_cast<std::size_t>(work.count), room = static_cast<std::size_t>(work.capacity);
  std::vector<std::uint32_t> all(column_count * count);
  for (std::size_t c = 0; c < column_count && count > 0; ++c)
    work.now.download(c * room, count, all.data() + c * count);
  return all;
}

}  // namespace desert_sim::plants
