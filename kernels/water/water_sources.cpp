/// The laws and the step of water_sources.hpp; compiled once for each backend.
#include "kernels/water/water_sources.hpp"

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/water/rain.hpp"
#include "src/core/elementary.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim::water_sources {

/// Adds `amount` to each cell of a box whose centre lies in a disc.
struct AddInDisc {
  Grid grid;
  int first_x, first_y;              ///< of the box
  float centre_x, centre_y, radius;  ///< [cells] from the south-west corner of the box
  Quanta amount;
  FilledHeight filled;
  Quanta* water;
  LedgerView ledger;

  DESERT_HD bool in_disc(int x, int y) const {
    const float dx = static_cast<float>(x) + 0.5f - centre_x, dy = static_cast<float>(y) + 0.5f - centre_y;
    return dx * dx + dy * dy <= radius * radius;
  }
  DESERT_HD void operator()(int x, int y) const {
    if (!in_disc(x, y)) return;
    const int i = neighbour_index(grid, first_x + x, first_y + y);
    if (i < 0) return;
    const Quanta stays = with_room(amount, filled(i));
    water[i] += stays;
    ledger.book_in(Material::water, i, amount);
    ledger.book_out(Material::water, i, amount - stays);
  }
};

template <class E>
void add_spring(E& exec, const TerrainView& t, const Spring& spring, double x, double y, float time_step,
                std::uint64_t tick, LedgerView ledger) {
  const Grid& g = t.grid;
  const double l = g.cell_size;
  const double column = x / l, row = y / l, reach = spring.radius / l;
  // A disc so small that it may contain no cell's centre is replaced by the cell that it lies in. On a
  // periodic axis each cell is visited at most once.
  const bool point = reach < 0.7072;
  struct Cells {
    int first, count;
  };
  const auto cells_of = [&](double at, int n, bool periodic) -> Cells {
    int first = static_cast<int>(std::floor(point ? at : at - reach)),
        last = static_cast<int>(std::floor(point ? at : at + reach));
    if (periodic && last - first >= n) return {static_cast<int>(std::floor(at)) - n / 2, n};
    if (!periodic) first = first > 0 ? first : 0, last = last < n ? last : n - 1;
    return {first, last - first + 1};
  };
  const Cells columns = cells_of(column, g.width, g.periodic_x), rows = cells_of(row, g.height, g.periodic_y);
  if (columns.count <= 0 || rows.count <= 0) return;  // the disc lies off the terrain
  const Grid box{columns.count, rows.count, g.cell_size};
  AddInDisc law{g,
                columns.first,
                rows.first,
                static_cast<float>(column - columns.first),
                static_cast<float>(row - rows.first),
                static_cast<float>(point ? 2.0 : reach),
                0,
                FilledHeight(t),
                t.quanta(Layer::water),
                ledger};
  long long cells = 0;
  for (int cell_y = 0; cell_y < box.height; ++cell_y)
    for (int cell_x = 0; cell_x < box.width; ++cell_x) cells += law.in_disc(cell_x, cell_y);
  if (cells == 0) return;
  const double depth =
      static_cast<double>(spring.discharge) * time_step / (l * l * static_cast<double>(cells));
  law.amount = rain::quanta_of_step(depth * t.quanta_per_metre, tick);
  if (law.amount > 0) for_each_cell(exec, box, law);
}

struct FillSea {
  Grid grid;
  bool everywhere;
  Quanta level;
  const Quanta *bedrock, *soil, *sand;
  Quanta* water;
  LedgerView ledger;
  DESERT_HD void operator()(int x, int y) const {
    if (!everywhere && x > 0 && y > 0 && x < grid.width - 1 && y < grid.height - 1) return;
    const int i = grid.index(x, y);
    const Quanta missing = level - (bedrock[i] + value_or_zero(soil, i) + sand[i] + water[i]);
    if (missing <= 0) return;
    water[i] += missing;
    ledger.book_in(Material::water, i, missing);
  }
};

template <class E>
void fill_sea(E& exec, const TerrainView& t, Sea sea, Quanta level, LedgerView ledger) {
  if (sea == Sea::none) return;
  for_each_cell(exec, t.grid,
                FillSea{t.grid, sea == Sea::everywhere, level, t.quanta(Layer::bedrock),
                        t.quanta(Layer::soil), t.quanta(Layer::sand), t.quanta(Layer::water), ledger});
}

struct Evaporate {
  Grid grid;
  float lost;  ///< 1 − e^(−φ Δt)
  Die die;
  Quanta* water;
  LedgerView ledger;
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const Quanta w = water[i];
    const Quanta part = die.whole_at_most(lost * static_cast<float>(w), w, i);
    water[i] = w - part;
    ledger.book_out(Material::water, i, part);
  }
};

template <class E>
void evaporate(E& exec, const TerrainView& t, float rate, float time_step, const Dice& dice,
               LedgerView ledger) {
  if (!(rate > 0.0f)) return;
  const double lost = -elementary::expm1(-static_cast<double>(rate) * time_step);
  for_each_cell(
      exec, t.grid,
      Evaporate{t.grid, static_cast<float>(lost), dice[Roll::evaporation], t.quanta(Layer::water), ledger});
}

template void add_spring(Backend&, const TerrainView&, const Spring&, double, double, float, std::uint64_t,
                         LedgerView);
template void fill_sea(Backend&, const TerrainView&, Sea, Quanta, LedgerView);
template void evaporate(Backend&, const TerrainView&, float, float, const Dice&, LedgerView);

}  // namespace desert_sim::water_sources
