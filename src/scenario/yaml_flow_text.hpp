#pragma once
/// A node of YAML as one line of text. Header only: rviz's plugins use it without the simulation.

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <string>

namespace desert_sim::yaml {

/// In flow style, in one line.
inline std::string flow_text(const YAML::Node& node) {
  YAML::Emitter out;
  out.SetMapFormat(YAML::Flow);
  out.SetSeqFormat(YAML::Flow);
  out << node;
  std::string text = out.c_str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace desert_sim::yaml
