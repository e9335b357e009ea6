#include "src/render/rebuild_queue.hpp"

#include <algorithm>
#include <cstdint>

namespace desert_sim::render {

namespace {

std::size_t index(int block) { return static_cast<std::size_t>(block); }

}  // namespace

void RebuildQueue::reset(const BlockLayout& layout) {
  layout_ = layout;
  const std::size_t count = index(layout.count());
  built_levels_.assign(count, -1);
  wanted_levels_.assign(count, BlockLayout::max_level);
  waits_.assign(count, 1);
  frames_.assign(count, 0);
  waiting_ = layout.count();
}

void RebuildQueue::let_wait(int block) {
  if (waits_[index(block)]) return;
  waits_[index(block)] = 1;
  frames_[index(block)] = 0;
  ++waiting_;
}

void RebuildQueue::touch(const CellRectangle& cells) {
  // A block without a mesh waits already, whatever its level.
  std::vector<int> levels = built_levels_;
  for (int& level : levels) level = std::max(level, 0);
  for (const int block : layout_.touched(cells, levels)) let_wait(block);
}

void RebuildQueue::touch_all() {
  for (int block = 0; block < layout_.count(); ++block) let_wait(block);
}

void RebuildQueue::set_levels(const std::vector<int>& wanted) {
  wanted_levels_ = wanted;
  for (int block = 0; block < layout_.count(); ++block)
    if (wanted[index(block)] != built_levels_[index(block)]) let_wait(block);
}

std::vector<int> RebuildQueue::order(const View& view, const std::vector<Box>& boxes) const {
  struct Entry {
    int block;
    bool unseen, has_mesh;
    double distance;
    bool operator<(const Entry& o) const {
      if (unseen != o.unseen) return o.unseen;
      if (has_mesh != o.has_mesh) return o.has_mesh;
      return distance < o.distance;
    }
  };
  std::vector<Entry> entries;
  for (int block = 0; block < layout_.count(); ++block)
    if (waits_[index(block)])
      entries.push_back({block, !view.sees(boxes[index(block)]), built_levels_[index(block)] >= 0,
                         view.distance(boxes[index(block)]) / (1 + frames_[index(block)])});
  std::stable_sort(entries.begin(), entries.end());
  std::vector<int> blocks;
  blocks.reserve(entries.size());
  for (const Entry& entry : entries) blocks.push_back(entry.block);
  return blocks;
}

int RebuildQueue::run(const View& view, const std::vector<Box>& boxes, double seconds,
                      const std::function<void(int block, int level)>& build, const Clock& clock) {
  if (waiting_ == 0) return 0;
  const double begin = clock();
  double now = begin, slowest = 0;
  int count = 0;
  for (const int block : order(view, boxes)) {
    if (count > 0 && now - begin + std::max(expected_, slowest) > seconds) {
      ++frames_[index(block)];
      continue;
    }
    const int level = wanted_levels_[index(block)];
    build(block, level);
    built_levels_[index(block)] = level;
    waits_[index(block)] = 0;
    --waiting_;
    ++count;
    const double after = clock();
    slowest = std::max(slowest, after - now);
    now = after;
  }
  expected_ = std::max(slowest, 0.9 * expected_);
  return count;
}

}  // namespace desert_sim::render
