#pragma once
/// The simulations that resets and loads have put an end to, as checkpoints: what undo and redo bring back
/// where there is no stroke. The strokes of a simulation are not among what comes back.

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

namespace desert_sim {

class FormerScenes {
 public:
  struct Scene {
    std::string checkpoint;    ///< its bytes
    std::string start_folder;  ///< that a reset reads the checkpoint of the start below
  };

  /// What all scenes together may take [bytes]. The oldest are forgotten first.
  explicit FormerScenes(std::size_t memory) : memory_(memory) {}

  int undoable() const { return static_cast<int>(former_.size()); }
  int redoable() const { return static_cast<int>(later_.size()); }
  /// The one that an undo (redo) brings back; there must be one.
  const Scene& next(bool redo) const { return redo ? later_.back() : former_.back(); }

  /// A reset or load ends this scene. What could be redone cannot any more.
  void end(Scene scene);
  /// next() has been brought back, in the place of this one.
  void turn(bool redo, Scene present);
  /// A scene ends that is too large: nothing before it, or after it, can be reached.
  void forget();

 private:
  void keep_to_memory();

  std::size_t memory_;
  std::deque<Scene> former_;  ///< the oldest first
  std::vector<Scene> later_;  ///< the last to be redone first
};

}  // namespace desert_sim
