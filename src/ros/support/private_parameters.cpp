#include "src/ros/support/private_parameters.hpp"

#include <ros/master.h>
#include <ros/param.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <cmath>
#include <cstdio>

#include "src/core/error.hpp"

namespace desert_sim {

namespace {

/// A number with all its bits. One that is not finite gets YAML's name for it, which the loader shows when
/// it refuses the number.
std::string yaml_number(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// A ROS parameter as YAML, so that one loader reads both: structs become maps, arrays lists, all else
/// scalars. Throws ConfigError, naming `key`, for a type that YAML does not have (dates, binary data).
YAML::Node yaml_from_xmlrpc(XmlRpc::XmlRpcValue value, const std::string& key) {
  using Value = XmlRpc::XmlRpcValue;
  switch (value.getType()) {
    case Value::TypeBoolean:
      return YAML::Node(static_cast<bool>(value));
    case Value::TypeInt:
      return YAML::Node(static_cast<int>(value));
    case Value::TypeDouble:
      return YAML::Node(yaml_number(static_cast<double>(value)));
    case Value::TypeString:
      return YAML::Node(static_cast<std::string>(value));
    case Value::TypeArray: {
      YAML::Node list(YAML::NodeType::Sequence);
      for (int n = 0; n < value.size(); ++n)
        list.push_back(yaml_from_xmlrpc(value[n], key + "." + std::to_string(n)));
      return list;
    }
    case Value::TypeStruct: {
      YAML::Node map(YAML::NodeType::Map);
      for (auto& entry : value) map[entry.first] = yaml_from_xmlrpc(entry.second, key + "." + entry.first);
      return map;
    }
    default:
      throw ConfigError(key + ": has a type that parameters cannot have (a date or binary data)");
  }
}

}  // namespace

YAML::Node private_parameters(const std::string& name) {
  XmlRpc::XmlRpcValue value;
  if (!ros::param::get(name, value)) {
    if (!ros::master::check())
      throw Error("the ROS master does not answer, so the parameters of " + name + " cannot be read");
    return YAML::Node(YAML::NodeType::Map);
  }
  return yaml_from_xmlrpc(value, name);
}

}  // namespace desert_sim
