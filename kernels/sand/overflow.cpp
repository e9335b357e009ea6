/// The law and the step of overflow.hpp; compiled once for each backend.
#include "kernels/sand/overflow.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/field/layers.hpp"

namespace desert_sim::overflow {

struct TakeOverflow {
  Grid grid;
  FilledHeight filled;
  Quanta* sand;
  LedgerView ledger;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const Quanta over = filled(i) - fill_limit;
    if (over <= 0) return;
    const Quanta taken = over < sand[i] ? over : sand[i];
    sand[i] -= taken;
    ledger.book_out(Material::sand, i, taken);
  }
};

template <class E>
void take_overflow(E& exec, const TerrainView& t, LedgerView ledger) {
  for_each_cell(exec, t.grid, TakeOverflow{t.grid, FilledHeight(t), t.quanta(Layer::sand), ledger});
}

template void take_overflow(Backend&, const TerrainView&, LedgerView);

}  // namespace desert_sim::overflow
