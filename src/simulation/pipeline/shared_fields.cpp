#include "src/simulation/pipeline/shared_fields.hpp"

namespace desert_sim {

SharedFields::SharedFields(Exec& exec, const Grid& grid)
    : heights(surface::make_heights(exec, grid)),
      repose(exec, static_cast<std::size_t>(grid.cells())),
      dice_keys(exec, static_cast<std::size_t>(Roll::count)),
      second_scratch(exec, static_cast<std::size_t>(grid.cells())) {
  repose.set_zero();
}

void SharedFields::prepare(Exec& exec, const Grid& grid, const std::set<SharedField>& needed) {
  const auto cells = static_cast<std::size_t>(grid.cells());
  impact_strength = {};
  sand_before = {};
  if (needed.count(SharedField::sand_before)) sand_before = Buffer<Quanta>(exec, cells);
  if (!needed.count(SharedField::impact_strength)) return;
  impact_strength = Buffer<float>(exec, cells);
  impact_strength.set_zero();  // where nothing moves sand there are no impacts
}

void SharedFields::roll_dice(Exec& exec, std::uint64_t seed, std::uint64_t step) {
  with_backend(exec, [&](auto& e) { dice = dice::roll(e, seed, step, dice_keys.data()); });
}

}  // namespace desert_sim
