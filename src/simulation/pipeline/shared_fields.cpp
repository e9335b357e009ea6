#include "src/simulation/pipeline/shared_fields.hpp"

#include "kernels/sand/reptation.hpp"

namespace desert_sim {

SharedFields::SharedFields(Exec& exec, const Grid& grid)
    : heights(surface::make_heights(exec, grid)),
      repose(exec, static_cast<std::size_t>(grid.cells())),
      landed(exec, static_cast<std::size_t>(grid.cells())),
      dice_keys(exec, static_cast<std::size_t>(Roll::count)) {
  repose.set_zero();
}

void SharedFields::prepare(Exec& exec, const Grid& grid, const Scenario& scenario) {
  const auto cells = static_cast<std::size_t>(grid.cells());
  const bool loosens = scenario.looseness.enabled;
  impact_strength = {};
  sand_before = {};
  if (loosens) sand_before = Buffer<Quanta>(exec, cells);
  if (!loosens && !reptation::moves_sand(scenario.reptation)) return;
  impact_strength = Buffer<float>(exec, cells);
  impact_strength.set_zero();  // without saltation there are no impacts
}

void SharedFields::roll_dice(Exec& exec, std::uint64_t seed, std::uint64_t step) {
  with_backend(exec, [&](auto& e) { dice = dice::roll(e, seed, step, dice_keys.data()); });
}

}  // namespace desert_sim
