#pragma once
/// Between layers and the stacks of slab_model.hpp.

#include "kernels/field/layers.hpp"
#include "kernels/slabs/rolling.hpp"
#include "kernels/wind/undisturbed_wind.hpp"

namespace desert_sim::slabs {

/// Stacks of the terrain, and whether there are cliffs of rock.
struct TakeStacks {
  Lattice lattice;
  const Quanta *bedrock, *soil, *sand;
  const float* obstacle;
  Quanta *base, *cliffs;

  /// Of what slabs cannot be taken from: rock, soil, and obstacles with what lies on them.
  DESERT_HD Quanta ground(int i) const {
    const bool solid = value_or_zero(obstacle, i) > 0.0f;
    return bedrock[i] + value_or_zero(soil, i) + (solid ? sand[i] : 0);
  }
  DESERT_HD void operator()(int x, int y) const {
    const Grid& grid = lattice.order.grid;
    const int i = grid.index(x, y), n = lattice.slot_of(x, y);
    const Quanta here = ground(i);
    lattice.height[n] = bedrock[i] + value_or_zero(soil, i) + sand[i];
    base[n] = here;
    lattice.pending[n] = 0;
    Quanta most = 0;
    unrolled<4>([&](auto k) DESERT_INLINE {  // east, north, and the diagonals to the north
      const int x_there = k == 0 || k == 2 ? x + 1 : k == 3 ? x - 1 : x, y_there = k == 0 ? y : y + 1;
      const bool there_is = (grid.periodic_x || (x_there >= 0 && x_there < grid.width)) &&
                            (grid.periodic_y || y_there < grid.height);
      const int there = grid.index(wrap_once(x_there, grid.width), wrap_once(y_there, grid.height));
      const Quanta rise = there_is ? ground(there) - here : 0, step = rise < 0 ? -rise : rise;
      most = step > most ? step : most;
    });
    if (most > lattice.repose - lattice.slab && is_flag_clear(cliffs)) set_flag(cliffs);
  }
};

/// The sand of the stacks, with slabs that still roll.
struct PutSand {
  Lattice lattice;
  const float* obstacle;
  Quanta* sand;
  Quanta* burial;  ///< null where no plants grow

  DESERT_HD void operator()(int x, int y) const {
    const int i = lattice.order.grid.index(x, y), n = lattice.slot_of(x, y);
    const Quanta left = value_or_zero(obstacle, i) > 0.0f ? sand[i] : 0;
    const std::uint32_t pending = lattice.pending[n];
    const auto rolling = static_cast<Quanta>(pending & (Lattice::one_hole - 1u)) -
                         static_cast<Quanta>(pending / Lattice::one_hole);
    const Quanta now = left + lattice.height[n] - lattice.base[n] + rolling * lattice.slab;
    if (burial != nullptr) burial[i] += now - sand[i];
    sand[i] = now;
  }
};

}  // namespace desert_sim::slabs
