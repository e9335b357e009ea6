#pragma once
/// The micro-relief of a snapshot of all rows, as beams ask for it.

#include <memory>
#include <utility>
#include <vector>

#include "src/simulation/views/micro_relief_cells.hpp"

namespace desert_sim {

class SnapshotSource : public MicroReliefSource {
 public:
  explicit SnapshotSource(Snapshot snapshot) : snapshot_(std::move(snapshot)) {}
  const Snapshot& grid() const override { return snapshot_; }
  std::shared_ptr<const PlantFeet> feet() const override { return snapshot_.feet; }
  std::vector<float> values(Layer layer, const Rectangle& r) const override {
    std::vector<float> copy;
    if (const std::vector<float>* const all = snapshot_.find(layer))
      for (int y = r.y; y < r.y + r.height; ++y) {
        const auto begin = all->begin() + std::ptrdiff_t{y} * snapshot_.width + r.x;
        copy.insert(copy.end(), begin, begin + r.width);
      }
    return copy;
  }

 private:
  const Snapshot snapshot_;
};

inline std::shared_ptr<const MicroReliefSource> source_of(const Snapshot& s) {
  return std::make_shared<const SnapshotSource>(s);
}

}  // namespace desert_sim
