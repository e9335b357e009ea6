#pragma once
/// The blocks that wait to be built anew, because their cells changed or another level of detail fits
/// better, in batches: all that are in the picture when a batch begins belong to it, and are to be shown
/// together when the last of them is built, so that a dune is never cut where blocks meet. What has no mesh
/// yet comes first, then the near. Blocks out of sight are built in the time that is left.

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
  /// The level at which each block was built last; -1: never.
  const std::vector<int>& levels() const { return built_levels_; }
  const std::vector<int>& wanted_levels() const { return wanted_levels_; }

  /// Begins a batch, of the blocks that wait and can be seen, if the last one is complete.
  void begin_batch(const View& view, const std::vector<Box>& boxes);
  /// Calls build(block, level) for the batch, and then for what waits out of sight, until `seconds` are
  /// spent. It stops before a block that would go beyond the time, if it takes as long as the slowest one
  /// of late. At least one block is built in each call. Returns the number of blocks that were built.
  int run(double seconds, const std::function<void(int block, int level)>& build,
          const Clock& clock = steady_seconds);
  /// Whether all blocks of the batch are built.
  bool batch_complete() const { return seen_.empty(); }

  /// Blocks that are to be built, in the batch or after it.
  int waiting() const { return waiting_; }

 private:
  void let_wait(int block);
  /// Takes the last block of a list, which has the next one at its end, and builds it.
  void build_next(std::vector<int>& blocks, const std::function<void(int block, int level)>& build);

  BlockLayout layout_;
  std::vector<int> built_levels_, wanted_levels_;
  std::vector<char> waits_;         ///< for a batch, or out of sight
  std::vector<int> seen_, unseen_;  ///< of this batch, the next one last
  int waiting_ = 0;
  double expected_ = 0;  ///< what a block takes at most, from those that were built of late [s]
};

}  // namespace desert_sim::render
