#include "src/ros/rover/map_plants.hpp"

#include <limits>

#include "kernels/backend/exec.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

namespace {

bool same_axis(const micro_relief::Axis& a, const micro_relief::Axis& b) {
  return a.count == b.count && a.parts_per_metre == b.parts_per_metre && a.periodic == b.periodic;
}

}  // namespace

MapPlants::MapPlants(const Plants::ConstPtr& message) : message_(message) {
  const std::size_t count = message->x.size();
  if (message->y.size() != count || message->radius.size() != count ||
      count > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw ConfigError("x, y and radius: " + std::to_string(count) + ", " + std::to_string(message->y.size()) +
                      " and " + std::to_string(message->radius.size()) +
                      " values (allowed: the same number, at most 2^31 - 1)");
}

std::string MapPlants::shortage() const {
  const std::uint64_t here = message_->x.size();
  if (message_->total <= here) return "";
  return "only the widest " + std::to_string(here) + " of " + std::to_string(message_->total) +
         " plants are sent: the others have no heaps of sand here, though they have in the simulation. Set "
         "plants_count of the terrain's node to at least " +
         std::to_string(message_->total);
}

std::shared_ptr<const PlantFeet> MapPlants::feet(const micro_relief::Lattice& squares) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (feet_ && same_axis(squares.x, squares_.x) && same_axis(squares.y, squares_.y)) return feet_;
  const auto found = std::make_shared<PlantFeet>();
  found->rows = squares.y.count;
  found->widest.resize(static_cast<std::size_t>(squares.x.count) * static_cast<std::size_t>(squares.y.count));
  CpuExec exec(1);  // beside the rover's threads
  micro_relief::find_feet(
      exec, squares,
      {message_->x.data(), message_->y.data(), message_->radius.data(), static_cast<int>(message_->x.size())},
      0, found->rows, found->widest.data());
  squares_ = squares;
  feet_ = found;
  return feet_;
}

}  // namespace desert_sim
