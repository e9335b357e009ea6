#include "src/simulation/pipeline/step_recordings.hpp"

#include <algorithm>

namespace desert_sim {

namespace {
/// Eight places of the avalanches' seams, with and without the wind's shadow, for each of two winds that take
/// turns.
constexpr std::size_t most_recordings = 32;
}  // namespace

bool StepKey::operator==(const StepKey& other) const {
  return wind_above.x == other.wind_above.x && wind_above.y == other.wind_above.y &&
         heights_stale == other.heights_stale && renews_held_layers == other.renews_held_layers &&
         stages == other.stages && keys == other.keys &&
         std::equal(std::begin(view.layers), std::end(view.layers), std::begin(other.view.layers));
}

void StepRecordings::run(Exec& exec, const StepKey& key, const std::function<void()>& work) {
  const auto known =
      std::find_if(steps_.begin(), steps_.end(), [&](const Step& step) { return step.key == key; });
  if (known == steps_.end()) {
    if (steps_.size() == most_recordings) steps_.erase(steps_.begin());
    steps_.push_back({key, nullptr});
    work();
    return;
  }
  if (!known->recording) known->recording = exec.record(work);
  known->recording->replay();
}

}  // namespace desert_sim
