/// Population: vegetation.
#include <algorithm>
#include <cmath>

#include "kernels/field/surface.hpp"
#include "kernels/plants/cover.hpp"
#include "src/simulation/undo/cell_list.hpp"
#include "src/simulation/undo/population.hpp"

namespace desert_sim {

namespace {

using plants::Column;

constexpr int block_side = 8;

float value(const ChangedPlant& plant, Column c) {
  return float_from_bits(plant.words[static_cast<std::size_t>(c)]);
}

/// The cells along an axis from low to high [cells], in parts that lie within one block; wrapped or cut off.
template <class Visit>
void visit_blocks(double low, double high, int cells, bool periodic, const Visit& visit) {
  auto first = static_cast<long long>(std::floor(low)) - 1,
       last = static_cast<long long>(std::floor(high)) + 1;
  if (!periodic) first = std::max(first, 0LL), last = std::min(last, cells - 1LL);
  if (last - first >= cells) first = 0, last = cells - 1;
  while (first <= last) {
    const auto at = static_cast<int>((first % cells + cells) % cells), block = at / block_side;
    visit(block);
    first += std::min((block + 1) * block_side, cells) - at;
  }
}

}  // namespace

int Population::block_columns() const { return (state_.terrain.grid().width + block_side - 1) / block_side; }

std::vector<int> Population::cells_of(int block) const {
  const Grid& grid = state_.terrain.grid();
  const int x0 = block % block_columns() * block_side, y0 = block / block_columns() * block_side;
  std::vector<int> cells;
  for (int y = y0; y < std::min(y0 + block_side, grid.height); ++y)
    for (int x = x0; x < std::min(x0 + block_side, grid.width); ++x) cells.push_back(grid.index(x, y));
  return cells;
}

/// The sums of the marks of all plants that reach each block; `blocks` gets the blocks that any reaches.
std::vector<std::uint64_t> Population::marks_of_blocks(const std::vector<ChangedPlant>& changed,
                                                       std::vector<int>& blocks) const {
  const Grid& grid = state_.terrain.grid();
  const int columns = block_columns(), rows = (grid.height + block_side - 1) / block_side;
  std::vector<std::uint64_t> marks(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
  std::vector<bool> reached(marks.size(), false);
  for (const ChangedPlant& plant : changed) {
    const double x = value(plant, Column::x), y = value(plant, Column::y),
                 radius = value(plant, Column::radius), l = grid.cell_size;
    visit_blocks((y - radius) / l, (y + radius) / l, grid.height, grid.periodic_y, [&](int row) {
      visit_blocks((x - radius) / l, (x + radius) / l, grid.width, grid.periodic_x, [&](int column) {
        const auto block = static_cast<std::size_t>(row * columns + column);
        marks[block] += plant.mark;
        reached[block] = true;
      });
    });
  }
  for (std::size_t block = 0; block < reached.size(); ++block)
    if (reached[block]) blocks.push_back(static_cast<int>(block));
  return marks;
}

Population::CoverUpdate Population::begin_cover(const std::vector<ChangedPlant>& changed) const {
  std::vector<int> blocks, cells;
  std::vector<std::uint64_t> marks = marks_of_blocks(changed, blocks);
  for (const int block : blocks) {
    const std::vector<int> of_block = cells_of(block);
    cells.insert(cells.end(), of_block.begin(), of_block.end());
  }
  Exec& exec = state_.exec();
  CoverUpdate update{std::move(blocks), std::move(marks), CellList(exec, cells), {}, {}};
  if (cells.empty()) return update;
  update.vegetation = Buffer<std::uint32_t>(exec, static_cast<std::size_t>(state_.terrain.grid().cells()));
  update.humus = Buffer<std::uint32_t>(exec, update.vegetation.size());
  return update;
}

/// What vegetation comes to with the present plants.
Population::Cover Population::compute_cover(CoverUpdate& update) {
  const Terrain& terrain = state_.terrain;
  state_.exec().copy(update.humus.data(), terrain.data(Layer::humus), update.humus.bytes());
  with_backend(state_.exec(), [&](auto& e) {
    surface::Heights& heights = pipeline_.fields().heights;
    surface::compute_heights(e, terrain.view(), heights);
    TerrainView view = terrain.view();
    view.layers[static_cast<int>(Layer::vegetation)] = update.vegetation.data();
    view.layers[static_cast<int>(Layer::humus)] = update.humus.data();
    plants::cover(e, view, state_.scenario.get<VegetationParameters>(), {0.0f, heights, true}, {},
                  state_.plants);
  });
  pipeline_.derived_changed();
  return {0, update.cells.read(update.vegetation.data())};
}

/// Brings vegetation up to date in the blocks that the changed plants reach, so that who looks
/// before the next step sees them. `recall`: where a block has had this set of plants before, it gets what it
/// had then.
void Population::update_cover(CoverUpdate& update, bool recall, bool remembers) {
  if (update.blocks.empty()) return;
  const Terrain& terrain = state_.terrain;
  const CellList& cells = update.cells;
  Cover cover = compute_cover(update);
  if (remembers) {
    const Cover before{0, cells.read(terrain.data(Layer::vegetation))};
    std::size_t first = 0;
    for (const int block : update.blocks) {
      const std::size_t size = cells_of(block).size();
      keep_cover(blocks_[block], update.marks[static_cast<std::size_t>(block)], {first, first + size}, before,
                 cover, recall);
      first += size;
    }
  }
  cells.write(terrain.data(Layer::vegetation), cover.vegetation);
}

/// Keeps the part `cells` of `now` for the block, whose plants have changed by `marks`, or, with `recall`,
/// replaces it by what is kept for this set of plants.
void Population::keep_cover(Block& block, std::uint64_t marks, std::pair<std::size_t, std::size_t> cells,
                            const Cover& before, Cover& now, bool recall) {
  const auto begin = static_cast<std::ptrdiff_t>(cells.first),
             end = static_cast<std::ptrdiff_t>(cells.second);
  const auto part = [&](const Cover& from, std::uint64_t of) {
    return Cover{of, {from.vegetation.begin() + begin, from.vegetation.begin() + end}};
  };
  const auto keep = [&](Cover cover) {
    kept_covers_ += cover.vegetation.size();
    block.covers.push_back(std::move(cover));
  };
  if (block.covers.empty()) keep(part(before, 0));
  block.marks += marks;
  const auto known = std::find_if(block.covers.begin(), block.covers.end(),
                                  [&](const Cover& cover) { return cover.marks == block.marks; });
  if (known == block.covers.end()) {
    keep(part(now, block.marks));
  } else if (recall) {
    std::copy(known->vegetation.begin(), known->vegetation.end(), now.vegetation.begin() + begin);
  } else {
    *known = part(now, block.marks);
  }
}

}  // namespace desert_sim
