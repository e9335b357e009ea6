#pragma once
/// Takes back what a stroke changed in the layers of material, as far as it is there.

#include <array>
#include <memory>
#include <vector>

#include "src/simulation/state/state.hpp"
#include "src/simulation/undo/stroke.hpp"

namespace desert_sim {

/// What an undo or redo moved of a material [quanta], none of them negative.
struct MaterialReturn {
  long long added = 0, removed = 0;  ///< sums over the cells that got some, and over those that lost some
  long long missing = 0;             ///< what cells did not have, or had no room for

  MaterialReturn& operator+=(const MaterialReturn& other) {
    added += other.added, removed += other.removed, missing += other.missing;
    return *this;
  }
};
using MaterialReturns = std::array<MaterialReturn, material_count>;

/// Each cell loses what the stroke gave it, and gets what the stroke took. No depth falls below 0, no rock
/// below the lowest height, and no column rises above the highest; what a cell lacks, or has no room for, is
/// missing. Where all edits of a layer conserved its material, so does this: cells get only as much as others
/// could give, in proportion.
class MaterialTurn {
 public:
  /// Works out what `changes` (of a stroke) come to. Throws ConfigError, and has changed nothing, if there is
  /// no memory.
  MaterialTurn(std::vector<MaterialChange>& changes, SimulationState& state);
  ~MaterialTurn();
  MaterialTurn(const MaterialTurn&) = delete;
  MaterialTurn& operator=(const MaterialTurn&) = delete;

  /// Makes the change, and turns the accounts of material back, so that they close. `changes` become what was
  /// changed now, which undoes this in its turn.
  MaterialReturns commit();

 private:
  struct Work;
  std::unique_ptr<Work> work_;  ///< null if there are no changes
};

}  // namespace desert_sim
