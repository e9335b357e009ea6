#pragma once
/// What edits of bedrock and soil make processes keep in mind (Process::edited): that they are loose, so that
/// they avalanche until they have come to rest. An undo that brings the ground back to what it was since the
/// last step brings these back, too: otherwise rock that was at rest would begin to slide.
///
/// Each edit adds a number of its own (a mark) to a sum, and its undo takes it away again. As long as no step
/// is made, a sum of 0 says that the ground is what it was after the last step.

#include "src/simulation/pipeline/pipeline.hpp"
#include "src/simulation/undo/stroke.hpp"

namespace desert_sim {

/// A number that stands for `count`, such that sums of a few of them are 0 only where they cancel.
std::uint64_t mark_of(std::uint64_t count);

class LooseGround {
 public:
  LooseGround(SimulationState& state, Pipeline& pipeline) : state_(state), pipeline_(pipeline) {}

  /// Before a command changes the ground: what was loose after the last step.
  void begin();
  /// A stroke has painted bedrock or soil.
  void painted(Layer layer, LooseMark& mark);
  /// A stroke was undone or redone; `complete`: nothing was missing.
  void returned(const Stroke& stroke, bool complete, LooseMark& mark);

 private:
  void add(std::size_t which, std::uint64_t by, LooseMark& mark);
  void set_flags();

  SimulationState& state_;
  Pipeline& pipeline_;
  std::uint64_t epoch_ = 0, marks_ = 0;
  std::uint64_t steps_ = 0;              ///< of the epoch
  ProcessFlags at_rest_flags_;           ///< where the sums are 0
  std::array<std::uint64_t, 2> sums_{};  ///< of `sliding_layers`
};

}  // namespace desert_sim
