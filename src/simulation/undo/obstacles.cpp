#include "src/simulation/undo/obstacles.hpp"

#include <algorithm>

#include "kernels/base/math.hpp"

namespace desert_sim {

namespace {

ObstacleCell* find(std::vector<ObstacleCell>& cells, int cell) {
  const auto at = std::lower_bound(cells.begin(), cells.end(), cell,
                                   [](const ObstacleCell& c, int wanted) { return c.cell < wanted; });
  return at != cells.end() && at->cell == cell ? &*at : nullptr;
}

/// For each of these cells of a stroke, what the next newer stroke has painted there; null if none has.
std::vector<ObstacleCell*> newer(std::deque<Stroke>& strokes, const Stroke& stroke,
                                 const std::vector<ObstacleCell>& cells) {
  std::vector<ObstacleCell*> above(cells.size(), nullptr);
  for (Stroke& other : strokes) {
    if (&other == &stroke || other.undone || other.obstacles.empty()) continue;
    for (std::size_t n = 0; n < cells.size(); ++n) {
      ObstacleCell* const there = find(other.obstacles, cells[n].cell);
      if (there && there->order > cells[n].order && (!above[n] || there->order < above[n]->order))
        above[n] = there;
    }
  }
  return above;
}

}  // namespace

void paint_obstacles(std::deque<Stroke>& strokes, Stroke& stroke, const std::vector<ObstacleCell>& cells) {
  std::vector<ObstacleCell> again, fresh, all;
  for (const ObstacleCell& painted : cells)
    if (const ObstacleCell* const there = find(stroke.obstacles, painted.cell)) again.push_back(*there);
  const std::vector<ObstacleCell*> above = newer(strokes, stroke, again);
  std::size_t n = 0;
  for (const ObstacleCell& painted : cells) {
    ObstacleCell* const there = find(stroke.obstacles, painted.cell);
    if (!there) {
      fresh.push_back(painted);
      continue;
    }
    if (ObstacleCell* const covering = above[n++]) {
      covering->before = there->before;
      *there = painted;
    } else {
      there->after = painted.after;
    }
  }
  std::merge(stroke.obstacles.begin(), stroke.obstacles.end(), fresh.begin(), fresh.end(),
             std::back_inserter(all),
             [](const ObstacleCell& a, const ObstacleCell& b) { return a.cell < b.cell; });
  stroke.obstacles = std::move(all);
}

std::vector<float> turn_obstacles(std::deque<Stroke>& strokes, const Stroke& stroke,
                                  std::vector<ObstacleCell>& cells, const CellList& list, Terrain& terrain) {
  const std::vector<ObstacleCell*> above = newer(strokes, stroke, cells);
  std::vector<std::uint32_t> words = list.read(terrain.data(Layer::obstacle));
  std::vector<float> changes(cells.size(), 0.0f);
  for (std::size_t n = 0; n < cells.size(); ++n) {
    ObstacleCell& own = cells[n];
    const float present = float_from_bits(words[n]);
    if (stroke.undone) own.before = above[n] ? above[n]->before : present;
    const float value = stroke.undone ? own.after : own.before;
    if (above[n]) {
      above[n]->before = value;
    } else {
      changes[n] = value - present;
      words[n] = bits_of(value);
    }
  }
  list.write(terrain.data(Layer::obstacle), words);
  return changes;
}

}  // namespace desert_sim
