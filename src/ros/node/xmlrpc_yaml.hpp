#pragma once
/// ROS parameters as YAML, so that one loader reads both.

#include <xmlrpcpp/XmlRpcValue.h>

#include <string>

namespace YAML {
class Node;
}

namespace desert_sim {

/// Structs become maps, arrays lists, all else scalars. Throws ConfigError, naming `key`, for a type that
/// YAML has not (dates, binaries).
YAML::Node yaml_from_xmlrpc(XmlRpc::XmlRpcValue value, const std::string& key);

}  // namespace desert_sim
