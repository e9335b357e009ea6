#include "src/rviz/names.hpp"

#include <ros/names.h>

#include "src/core/error.hpp"

namespace desert_sim {

std::string full_name(const std::string& name, const std::string& kind) {
  std::string problem;
  if (name.empty() || !ros::names::validate(name, problem))
    throw ConfigError("'" + name + "' is not the name of a " + kind +
                      (problem.empty() ? "" : ": " + problem));
  return ros::names::resolve(name);
}

}  // namespace desert_sim
