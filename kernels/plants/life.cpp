/// The laws and the step of life.hpp; compiled once for each backend.
#include "kernels/plants/life.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/plants/growth.hpp"
#include "kernels/plants/plant_order.hpp"
#include "kernels/plants/spawning.hpp"

namespace desert_sim::plants {

/// Appends new plants to the existing ones.
template <class E>
void spawn(E& exec, const Site& site, const StepInputs& in, Workspace& work) {
  const SpawningLaw spawning{site,
                             work.species.data(),
                             work.species_count,
                             work.density.data(),
                             work.downwind.data(),
                             in.time_step,
                             in.vegetation.seedling_share,
                             in.seed,
                             in.tick};
  for_each_cell(exec, site.grid, MarkSpawningCells{spawning, work.seeds.data()});
  prefix_sums(exec, work.sort_workspace, work.seeds.data(), work.seed_offsets.data(), site.grid.cells() + 1);
  const int room = work.capacity - work.count;
  for_each_item(exec, room,
                CreatePlants{spawning, work.seed_offsets.data(), work.next_state(), work.count, room});
  exec.copy(work.event_counts.data() + 1, work.seed_offsets.data() + site.grid.cells(), sizeof(int));
}

template <class E>
void grow_and_spawn(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, LedgerView ledger,
                    Workspace& work) {
  const WaterUptake water_uptake(t, in.repose, in.vegetation, in.heights.cell_heights.data(), in.time_step,
                                 dice);
  work.event_counts.set_zero();
  work.water_requests.set_zero();
  for_each_item(exec, work.count,
                SumRequests{water_uptake, work.plants(), work.species.data(), work.water_requests.data()});
  const Competition competition{work.neighbourhood(), work.plants(), work.competition.data(),
                                work.species_count, t.quantum};
  for_each_item(exec, work.count,
                Grow{water_uptake, competition, work.plants(), work.next_state(), work.species.data(),
                     work.water_requests.data(), t.real(Layer::canopy_height), t.real(Layer::illumination),
                     t.real(Layer::illumination_canopy), in.time_step, in.vegetation.litter,
                     in.vegetation.overgrown, dice[Roll::plant_height], work.granted_water.data(),
                     t.quanta(Layer::humus), work.event_counts.data()});
  if (work.count < work.capacity) spawn(exec, water_uptake.site, in, work);
  if (t.quanta(Layer::moisture))
    for_each_item(exec, work.count,
                  DebitMoisture{water_uptake.site, work.plants(), work.granted_water.data(),
                                t.quanta(Layer::moisture), ledger});
  int event_counts[2];
  work.event_counts.download(0, 2, event_counts);
  const int room = work.capacity - work.count;
  sort_plants(exec, work.count + (event_counts[1] < room ? event_counts[1] : room), event_counts[0], work);
}

template void grow_and_spawn(Backend&, const TerrainView&, const StepInputs&, const Dice&, LedgerView,
                             Workspace&);

}  // namespace desert_sim::plants
