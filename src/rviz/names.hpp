#pragma once
/// Names of nodes and topics that somebody types.

#include <string>

namespace desert_sim {

/// The full name: one without a leading slash is in rviz's namespace. Throws ConfigError if it is no name of
/// a `kind`, node or topic.
std::string full_name(const std::string& name, const std::string& kind);

}  // namespace desert_sim
