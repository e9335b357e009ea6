#pragma once
/// The surface of wang.hpp, the shelter over it, and the ground upwind: one sweep downwind.

#include "kernels/backend/for_each.hpp"
#include "kernels/particles/wang.hpp"
#include "kernels/wind/downwind.hpp"

namespace desert_sim::particles {

using wind::Downwind;

struct MeasureSurface {
  Downwind order;
  const Quanta *bedrock, *soil, *sand;
  Column* columns;

  DESERT_HD void operator()(int x, int y) const {
    const int i = order.grid.index(x, y);
    columns[order.slot(x, y)].surface = bedrock[i] + value_or_zero(soil, i) + sand[i];
  }
};

/// The shelter over each cell: from a line to the next, along the wind's ways, it falls by `fall`, or begins
/// anew at a higher cell.
struct FindShelter {
  static constexpr int words = 2, reach = 0;
  using Word = Quanta;
  struct Loaded {
    Quanta surface;
    bool begins;  ///< the way comes in over an open edge
    int slot;
  };
  struct Result {
    Quanta shelter, upwind;
    int slot;
  };
  static constexpr Quanta none = -wall_height;
  Downwind order;
  int shift;      ///< of the wind [cells a line; 16.16 fixed point]
  Quanta fall;    ///< [quanta a line]
  float renewal;  ///< 1 − exp(−way of a line/ℓ) [1]
  Column* columns;

  DESERT_HD bool around() const { return false; }
  DESERT_HD Quanta beyond(int, Quanta nearest) const { return nearest; }
  DESERT_HD Quanta before_first(int, int) const { return none; }
  /// How far to the side the wind's way from line 0 has come at a line [cells].
  DESERT_HD int offset(int line) const {
    return static_cast<int>((static_cast<long long>(line) * shift + fixed_point_one / 2) >> 16);
  }
  DESERT_HD Loaded load(int line, int way) const {
    const int length = order.length(), unwrapped = way + wrap(offset(line), length);
    const int place = unwrapped - (unwrapped >= length ? length : 0);
    const int before = place - (offset(line) - offset(line - 1));
    const bool begins = !order.periodic_across() && (before < 0 || before >= length);
    const int slot = (line < 0 ? line + order.lines() : line) * length + place;
    return {columns[slot].surface, begins, slot};
  }
  template <class Before, class After>
  DESERT_HD Result pass(const Loaded& here, const Before& before, const After& after) const {
    const Quanta fallen = before(0) - fall, shelter = here.begins || fallen < none ? none : fallen;
    after(0) = here.surface > shelter ? here.surface : shelter;
    const Quanta mean = here.begins || before(1) == none ? here.surface : before(1);
    after(1) = mean + static_cast<Quanta>(rintf(renewal * static_cast<float>(here.surface - mean)));
    return {after(0), after(1), here.slot};
  }
  DESERT_HD void store(int line, int, const Result& result) const {
    if (line < 0) return;
    columns[result.slot].shelter = result.shelter;
    columns[result.slot].upwind = result.upwind;
  }
};

}  // namespace desert_sim::particles
