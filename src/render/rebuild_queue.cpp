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
  seen_.clear();
  unseen_.clear();
  waiting_ = layout.count();
}

void RebuildQueue::let_wait(int block) {
  if (waits_[index(block)]) return;
  waits_[index(block)] = 1;
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
  std::vector<char> in_batch(waits_.size(), 0);  // will have the level that is wanted when it is built
  for (const int block : seen_) in_batch[index(block)] = 1;
  for (int block = 0; block < layout_.count(); ++block)
    if (!in_batch[index(block)] && wanted[index(block)] != built_levels_[index(block)]) let_wait(block);
}

void RebuildQueue::begin_batch(const View& view, const std::vector<Box>& boxes) {
  if (!seen_.empty()) return;
  struct Entry {
    int block;
    bool has_mesh;
    double distance;
    bool operator<(const Entry& o) const {
      return has_mesh != o.has_mesh ? has_mesh : distance > o.distance;  // the next one last
    }
  };
  std::vector<Entry> seen, unseen;
  for (int block = 0; block < layout_.count(); ++block)
    if (waits_[index(block)])
      (view.sees(boxes[index(block)]) ? seen : unseen)
          .push_back({block, built_levels_[index(block)] >= 0, view.distance(boxes[index(block)])});
  const auto sorted = [](std::vector<Entry>& entries) {
    std::stable_sort(entries.begin(), entries.end());
    std::vector<int> blocks;
    blocks.reserve(entries.size());
    for (const Entry& entry : entries) blocks.push_back(entry.block);
    return blocks;
  };
  seen_ = sorted(seen);
  unseen_ = sorted(unseen);
  for (const int block : seen_) waits_[index(block)] = 0;
}

void RebuildQueue::build_next(std::vector<int>& blocks,
                              const std::function<void(int block, int level)>& build) {
  const int block = blocks.back(), level = wanted_levels_[index(block)];
  blocks.pop_back();
  if (&blocks == &unseen_) waits_[index(block)] = 0;
  build(block, level);
  built_levels_[index(block)] = level;
  --waiting_;
}

int RebuildQueue::run(double seconds, const std::function<void(int block, int level)>& build,
                      const Clock& clock) {
  const double begin = clock();
  double now = begin, slowest = 0;
  int count = 0;
  while (!seen_.empty() || !unseen_.empty()) {
    if (count > 0 && now - begin + std::max(expected_, slowest) > seconds) break;
    build_next(seen_.empty() ? unseen_ : seen_, build);
    ++count;
    const double after = clock();
    slowest = std::max(slowest, after - now);
    now = after;
  }
  if (count > 0) expected_ = std::max(slowest, 0.9 * expected_);
  return count;
}

}  // namespace desert_sim::render
