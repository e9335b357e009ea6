#include "src/simulation/undo/painted_layers.hpp"

#include <algorithm>

#include "kernels/base/math.hpp"

namespace desert_sim {

namespace {

PaintedCell* find(std::vector<PaintedCell>& cells, int cell) {
  const auto at = std::lower_bound(cells.begin(), cells.end(), cell,
                                   [](const PaintedCell& c, int wanted) { return c.cell < wanted; });
  return at != cells.end() && at->cell == cell ? &*at : nullptr;
}

/// For each of these cells of a stroke, what the next newer stroke has painted there; null if none has.
std::vector<PaintedCell*> newer(std::deque<Stroke>& strokes, const Stroke& stroke, Layer layer,
                                const std::vector<PaintedCell>& cells) {
  std::vector<PaintedCell*> above(cells.size(), nullptr);
  for (Stroke& other : strokes) {
    if (&other == &stroke || other.undone || !other.changed(layer)) continue;
    for (std::size_t n = 0; n < cells.size(); ++n) {
      PaintedCell* const there = find(other.painted_in(layer), cells[n].cell);
      if (there && there->order > cells[n].order && (!above[n] || there->order < above[n]->order))
        above[n] = there;
    }
  }
  return above;
}

float value_of(std::uint32_t word, Layer layer, const Terrain& terrain) {
  return info(layer).storage == Storage::quanta
             ? static_cast<float>(static_cast<Quanta>(word) * terrain.scale().quantum())
             : float_from_bits(word);
}

}  // namespace

void paint(std::deque<Stroke>& strokes, Stroke& stroke, Layer layer, const std::vector<PaintedCell>& cells) {
  if (cells.empty()) return;
  std::vector<PaintedCell>& own = stroke.painted_in(layer);
  std::vector<PaintedCell> again, fresh, all;
  for (const PaintedCell& painted : cells)
    if (const PaintedCell* const there = find(own, painted.cell)) again.push_back(*there);
  const std::vector<PaintedCell*> above = newer(strokes, stroke, layer, again);
  std::size_t n = 0;
  for (const PaintedCell& painted : cells) {
    PaintedCell* const there = find(own, painted.cell);
    if (!there) {
      fresh.push_back(painted);
      continue;
    }
    if (PaintedCell* const covering = above[n++]) {
      covering->before = there->before;
      *there = painted;
    } else {
      there->after = painted.after;
    }
  }
  std::merge(own.begin(), own.end(), fresh.begin(), fresh.end(), std::back_inserter(all),
             [](const PaintedCell& a, const PaintedCell& b) { return a.cell < b.cell; });
  own = std::move(all);
}

std::vector<float> turn(std::deque<Stroke>& strokes, const Stroke& stroke, PaintedLayer& layer,
                        const CellList& list, Terrain& terrain) {
  std::vector<PaintedCell>& cells = layer.cells;
  const std::vector<PaintedCell*> above = newer(strokes, stroke, layer.layer, cells);
  std::vector<std::uint32_t> words = list.read(terrain.data(layer.layer));
  std::vector<float> changes(cells.size(), 0.0f);
  for (std::size_t n = 0; n < cells.size(); ++n) {
    PaintedCell& own = cells[n];
    const std::uint32_t present = words[n];
    if (stroke.undone)
      own.before = above[n] ? above[n]->before : present;
    else if (!above[n])
      own.after = present;
    const std::uint32_t word = stroke.undone ? own.after : own.before;
    if (above[n]) {
      above[n]->before = word;
    } else {
      changes[n] = value_of(word, layer.layer, terrain) - value_of(present, layer.layer, terrain);
      words[n] = word;
    }
  }
  list.write(terrain.data(layer.layer), words);
  return changes;
}

}  // namespace desert_sim
