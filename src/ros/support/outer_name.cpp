#include "src/ros/support/outer_name.hpp"

#include <ros/names.h>

#include "src/core/validation_errors.hpp"

namespace desert_sim {

void check_name(const std::string& name, const std::string& key, ValidationErrors& errors) {
  std::string why;
  if (name.empty())
    errors.add(key, "is empty (allowed: a name)");
  else if (!ros::names::validate(name, why))
    errors.add(key, "'" + name + "' is not a valid name: " + why);
  else if (name[0] == '~')
    errors.add(key, "'" + name + "' is private to this node (allowed: a name without ~)");
}

std::string outer_name(const ros::NodeHandle& private_node, const std::string& name) {
  const std::string own = ros::names::parentNamespace(private_node.getNamespace());
  return ros::names::resolve(ros::names::parentNamespace(own), name);
}

}  // namespace desert_sim
