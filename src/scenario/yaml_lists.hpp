#pragma once
/// Reads and writes lists of items that each have a parameter table.

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace yaml {

/// Whether `list` is a list of at most `most` entries; adds an error if it is something else that is given.
bool is_list(const YAML::Node& list, const std::string& key, std::size_t most, ValidationErrors& errors);

template <class Item>
void read_items(const YAML::Node& list, const std::string& key, std::size_t most, ValidationErrors& errors,
                std::vector<Item>& items) {
  if (!is_list(list, key, most, errors)) return;
  for (std::size_t n = 0; n < list.size(); ++n) {
    items.emplace_back();
    read_section(list[n], key + "." + std::to_string(n), errors, items.back());
  }
}

/// Writes a list as an entry of an open map.
template <class Item>
void emit_items(YAML::Emitter& out, const char* key, const std::vector<Item>& items) {
  out << YAML::Key << key << YAML::Value << YAML::BeginSeq;
  for (const Item& item : items) {
    out << YAML::Flow << YAML::BeginMap;
    emit_parameters(out, item);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

}  // namespace yaml
}  // namespace desert_sim
