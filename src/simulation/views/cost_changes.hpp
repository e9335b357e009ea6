#pragma once
/// What others lack of the costs of the terrain: kernels/view/held_costs.hpp.

#include <cstdint>
#include <vector>

#include "kernels/backend/buffer.hpp"
#include "kernels/field/cell_box.hpp"
#include "kernels/view/held_costs.hpp"
#include "src/simulation/views/staging.hpp"

namespace desert_sim {

struct CostQuery {
  bool update = false;  ///< each tile with a cell that is off by more than `threshold`, as a whole
  int threshold = 0;    ///< 0 … 99; lethal and unknown cells are never off
  bool whole = false;   ///< all cells, after the update
};

/// Costs of tiles, row-major, which are held now; those of all others were held before.
struct CostChanges {
  struct Tile {
    CellBox cells;
    std::vector<std::int8_t> costs;
  };
  std::vector<Tile> tiles;

  /// Writes them over what is held, row-major, of the size of the terrain. For each tile that differs from
  /// it, the smallest box that has all cells which do.
  std::vector<CellBox> write_to(std::vector<std::int8_t>& held, int width) const;
};

/// Null what was not asked for. An update where nothing is held is a whole map.
struct PendingCosts {
  Pending<CostChanges> update, whole;
};

/// On the device.
class HeldCosts {
 public:
  HeldCosts() = default;  ///< nobody holds any
  HeldCosts(Exec& exec, const Grid& grid);
  explicit operator bool() const { return static_cast<bool>(now_); }
  /// What laws write the costs of now to, row-major.
  std::int8_t* now() const { return now_.data(); }
  std::size_t bytes() const { return now_.bytes() + held_.bytes(); }
  /// Of the costs of now; see Simulation::begin_costs().
  PendingCosts begin_copy(Exec& exec, Staging& staging, const CostQuery& query);

 private:
  Pending<CostChanges> copy_tiles(Exec& exec, Staging& staging, int threshold);

  Grid grid_;
  bool complete_ = false;  ///< whether others hold all cells
  Buffer<std::int8_t> now_, held_;
};

}  // namespace desert_sim
