#include "src/ros/node/xmlrpc_yaml.hpp"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstdio>

#include "src/core/error.hpp"

namespace desert_sim {

namespace {

/// With every bit; YAML's own names for what is not finite, so that the loader can name it when it refuses
/// it.
std::string number_text(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

}  // namespace

YAML::Node yaml_from_xmlrpc(XmlRpc::XmlRpcValue value, const std::string& key) {
  using Value = XmlRpc::XmlRpcValue;
  switch (value.getType()) {
    case Value::TypeBoolean:
      return YAML::Node(static_cast<bool>(value));
    case Value::TypeInt:
      return YAML::Node(static_cast<int>(value));
    case Value::TypeDouble:
      return YAML::Node(number_text(static_cast<double>(value)));
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
      throw ConfigError(key + ": is of a type that no parameter has (a date, or binary data)");
  }
}

}  // namespace desert_sim
