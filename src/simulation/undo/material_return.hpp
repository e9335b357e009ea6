#pragma once
/// Takes back what a stroke changed in the layers of material, as far as it is there.

#include <array>

#include "src/simulation/state.hpp"
#include "src/simulation/undo/stroke.hpp"

namespace desert_sim {

/// What an undo or redo moved of a material [quanta], none of them negative.
struct MaterialReturn {
  long long added = 0, removed = 0;  ///< sums over the cells that got some, and over those that lost some
  long long missing = 0;             ///< what cells did not have, or had no room for
};
using MaterialReturns = std::array<MaterialReturn, material_count>;

/// Each cell loses what the stroke gave it, and gets what the stroke took. No depth falls below 0, no rock
/// below the lowest height, and no column rises above the highest; what a cell lacks, or has no room for, is
/// missing. Where all edits of a layer conserved its material, so does this: cells get only as much as others
/// could give, in proportion. The accounts of material are turned back as well, so that they close. `changes`
/// becomes what was changed now, which undoes this in its turn. Throws ConfigError, and has changed nothing,
/// if there is no memory.
MaterialReturns return_materials(std::vector<MaterialChange>& changes, SimulationState& state);

}  // namespace desert_sim
