#pragma once
/// The blocks that wait to be built anew, because their cells changed or another level of detail fits better,
/// and the order in which they are: what is in the picture first, what has no mesh yet before the rest, the
/// near before the far. A block that waits comes closer with each frame, so that near ones that change all
/// the time do not keep it waiting for ever.

#include <chrono>
#include <functional>
#include <vector>

#include "src/render/block_layout.hpp"
#include "src/render/view.hpp"

namespace desert_sim::render {

class RebuildQueue {
 public:
  using Clock = std::function<double()>;  ///< seconds of a steady clock
  static double steady_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

  /// Forgets everything: no block has a mesh, and all wait.
  void reset(const BlockLayout& layout);
  /// Lets all blocks whose mesh depends on these cells wait.
  void touch(const CellRectangle& cells);
  /// Lets all blocks wait.
  void touch_all();
  /// The levels that fit now; blocks of another level wait. One for each block.
  void set_levels(const std::vector<int>& wanted);
  /// The level of each block's mesh; -1: none yet.
  const std::vector<int>& levels() const { return built_levels_; }
  const std::vector<int>& wanted_levels() const { return wanted_levels_; }

  /// Calls build(block, level) for the waiting blocks in their order, until `seconds` are spent. It stops
  /// before a block that would go beyond the time, if it takes as long as the slowest one of late. At least
  /// one block is built in each call. Returns the number of blocks that were built.
  int run(const View& view, const std::vector<Box>& boxes, double seconds,
          const std::function<void(int block, int level)>& build, const Clock& clock = steady_seconds);

  int waiting() const { return waiting_; }

 private:
  void let_wait(int block);
  std::vector<int> order(const View& view, const std::vector<Box>& boxes) const;

  BlockLayout layout_;
  std::vector<int> built_levels_, wanted_levels_;
  std::vector<char> waits_;
  std::vector<int> frames_;  ///< for how many calls of run() a block has waited
  int waiting_ = 0;
  double expected_ = 0;  ///< what a block takes at most, from those that were built of late [s]
};

}  // namespace desert_sim::render
