#include "src/simulation/former_scenes.hpp"

#include <numeric>
#include <utility>

namespace desert_sim {

void FormerScenes::end(Scene scene) {
  later_.clear();
  former_.push_back(std::move(scene));
  keep_to_memory();
}

void FormerScenes::turn(bool redo, Scene present) {
  if (redo) {
    later_.pop_back();
    former_.push_back(std::move(present));
  } else {
    former_.pop_back();
    later_.push_back(std::move(present));
  }
  keep_to_memory();
}

void FormerScenes::forget() {
  former_.clear();
  later_.clear();
}

void FormerScenes::keep_to_memory() {
  const auto add = [](std::size_t sum, const Scene& scene) { return sum + scene.checkpoint.size(); };
  const auto bytes = [&] {
    return std::accumulate(later_.begin(), later_.end(),
                           std::accumulate(former_.begin(), former_.end(), std::size_t{0}, add), add);
  };
  while (bytes() > memory_ && !former_.empty()) former_.pop_front();
  while (bytes() > memory_ && !later_.empty()) later_.erase(later_.begin());
}

}  // namespace desert_sim
