#pragma once
/// Where plants stand, as a message of ~plants says.

#include <desert_sim/Plants.h>

#include <memory>
#include <mutex>
#include <string>

#include "src/simulation/views/snapshot.hpp"

namespace desert_sim {

class MapPlants {
 public:
  /// Throws ConfigError if the message's columns are not equally long.
  explicit MapPlants(const Plants::ConstPtr& message);

  std::uint64_t step() const { return message_->step; }
  /// How many plants of the terrain are missing here, and what to set; empty if none is.
  std::string shortage() const;
  /// Whether they are on the terrain with this south-west corner.
  bool on_terrain_at(double origin_x, double origin_y) const {
    return message_->origin.position.x == origin_x && message_->origin.position.y == origin_y;
  }
  /// The widest plants of all squares; found at the first call, and anew for other squares. From any thread.
  std::shared_ptr<const PlantFeet> feet(const micro_relief::Lattice& squares) const;

 private:
  const Plants::ConstPtr message_;
  mutable std::mutex mutex_;
  mutable micro_relief::Lattice squares_;  ///< of feet_
  mutable std::shared_ptr<const PlantFeet> feet_;
};

}  // namespace desert_sim
