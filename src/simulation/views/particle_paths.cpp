/// Views::begin_particle_paths().
#include "src/scenario/particle_inputs.hpp"
#include "src/simulation/views/views.hpp"

namespace desert_sim {

namespace {

constexpr int most_points = 400;  // of a path: some hops on cells of a centimetre

}  // namespace

PendingParticlePaths Views::begin_particle_paths(int number) {
  auto paths = std::make_shared<ParticlePaths>();
  const GridParameters& g = state_.scenario.grid;
  paths->origin_x = g.origin_x;
  paths->origin_y = g.origin_y;
  auto readback = std::make_shared<Readback>();
  if (!has_flying_grains(state_.scenario) || number < 1) return {paths, readback};
  const std::size_t count = static_cast<std::size_t>(number), points = count * most_points,
                    bytes = points * sizeof(particles::PathPoint) + count * sizeof(int);
  Staging::Slot& slot = staging_.acquire(bytes);
  auto* const to = reinterpret_cast<particles::PathPoint*>(slot.device());
  Buffer<std::uint32_t> keys(state_.exec(), static_cast<std::size_t>(Roll::count));
  particles::Workspace work = particles::make_workspace(state_.exec(), state_.terrain.grid());
  const Pipeline::PartClock clock = pipeline_.next_part();
  with_backend(state_.exec(), [&](auto& e) {
    const Dice dice = dice::roll(e, state_.scenario.seed, clock.tick, keys.data());
    particles::trace(e, state_.terrain.view(),
                     particle_inputs(state_.scenario, clock.time_step, clock.wind_above), dice, work,
                     {number, most_points, to, reinterpret_cast<int*>(to + points)});
  });
  state_.exec().synchronise();  // before the memory of this function goes
  staging_.send(slot, bytes, readback,
                [waited = std::weak_ptr<ParticlePaths>(paths), bytes, points, count](auto& arrived) {
                  const std::shared_ptr<ParticlePaths> all = waited.lock();
                  if (!all) return;
                  const auto* const from = reinterpret_cast<const particles::PathPoint*>(arrived.host(bytes));
                  const auto* const lengths = reinterpret_cast<const int*>(from + points);
                  for (std::size_t n = 0; n < count; ++n)
                    if (lengths[n] > 1)
                      all->paths.emplace_back(from + n * most_points, from + n * most_points + lengths[n]);
                });
  return {paths, readback};
}

}  // namespace desert_sim
