#pragma once
/// Steps that were recorded once and are replayed. On a GPU a step is two dozen short kernels or more, and
/// starting each by itself takes longer than running it on a small grid; a recording (a CUDA graph) starts
/// all at once. What kernels are given by value is part of the recording, so there is one for each value that
/// changes from step to step.

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "kernels/backend/exec.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/wind/vector.hpp"

namespace desert_sim {

/// All that a step's kernels are given and that can differ between two steps with the same parameters.
struct StepKey {
  wind::Vector wind_above;
  bool heights_stale = false;       ///< whether the step measures heights first
  bool renews_held_layers = true;   ///< whether it finds the layers that are held
  std::size_t stages = 0;           ///< how many, from the first on, are in the recording
  std::vector<std::uint64_t> keys;  ///< of processes: Process::recording_key
  TerrainView view;
  bool operator==(const StepKey& other) const;
};

class StepRecordings {
 public:
  /// Does `work`, or replays its recording. It is recorded when the same key comes a second time: winds that
  /// change with every step are not worth it.
  void run(Exec& exec, const StepKey& key, const std::function<void()>& work);
  /// Recordings hold the parameters and memory of the time they were made.
  void forget() { steps_.clear(); }

 private:
  struct Step {
    StepKey key;
    std::unique_ptr<Recording> recording;  ///< null until the key has come twice
  };
  std::vector<Step> steps_;  ///< the oldest first
};

}  // namespace desert_sim
