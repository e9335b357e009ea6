#include "src/simulation/undo/changed_cells.hpp"

#include <algorithm>

#include "kernels/base/math.hpp"

namespace desert_sim {

void ChangedCells::extend(int cell) {
  const int width = state_.terrain.grid().width, x = cell % width, y = cell / width;
  CellRectangle& r = rectangle_;
  if (r.x1 <= r.x0) r = {x, y, x + 1, y + 1};
  r = {std::min(r.x0, x), std::min(r.y0, y), std::max(r.x1, x + 1), std::max(r.y1, y + 1)};
}

void ChangedCells::add(const MaterialChange& change) {
  OfLayer of{change.layer, {}};
  const double quantum = state_.terrain.scale().quantum();
  for (const CellAmount& c : change.cells) {
    extend(c.cell);
    of.cells.emplace_back(c.cell, static_cast<float>(c.amount * quantum));
  }
  layers_.push_back(std::move(of));
}

void ChangedCells::add(const PaintedLayer& layer, const std::vector<float>& by) {
  OfLayer of{layer.layer, {}};
  for (std::size_t n = 0; n < by.size(); ++n) {
    if (by[n] == 0) continue;
    extend(layer.cells[n].cell);
    of.cells.emplace_back(layer.cells[n].cell, by[n]);
  }
  layers_.push_back(std::move(of));
}

void ChangedCells::add(const PlantChange& plants) {
  const Grid& grid = state_.terrain.grid();
  const auto place = [&](const ChangedPlant& plant, plants::Column c, int cells) {
    const float metres = float_from_bits(plant.words[static_cast<std::size_t>(c)]);
    return clamp_index(static_cast<int>(metres / grid.cell_size), cells);
  };
  for (const auto* list : {&plants.added, &plants.removed})
    for (const ChangedPlant& plant : *list)
      extend(grid.index(place(plant, plants::Column::x, grid.width),
                        place(plant, plants::Column::y, grid.height)));
}

std::vector<LayerChange> ChangedCells::changes() const {
  const GridParameters& grid = state_.scenario.grid;
  const CellRectangle& r = rectangle_;
  const auto width = static_cast<std::size_t>(r.x1 - r.x0);
  std::vector<LayerChange> changes;
  for (const OfLayer& of : layers_) {
    LayerChange change{info(of.layer).name, grid.origin_x + r.x0 * grid.cell_size,
                       grid.origin_y + r.y0 * grid.cell_size, grid.cell_size,
                       std::vector<float>(width * static_cast<std::size_t>(r.y1 - r.y0), 0.0f)};
    for (const auto& [cell, by] : of.cells)
      change.values[static_cast<std::size_t>(cell / grid.width - r.y0) * width +
                    static_cast<std::size_t>(cell % grid.width - r.x0)] = by;
    changes.push_back(std::move(change));
  }
  return changes;
}

}  // namespace desert_sim
