#include "src/scenario/yaml_lists.hpp"

namespace desert_sim {

namespace yaml {

bool is_list(const YAML::Node& list, const std::string& key, std::size_t most, ValidationErrors& errors) {
  if (!list.IsDefined() || list.IsNull()) return false;
  if (!list.IsSequence()) {
    errors.add(key, node_text(list) + " is given where a list is expected");
    return false;
  }
  if (list.size() > most) {
    errors.add(key, std::to_string(list.size()) + " entries are given (allowed: at most " +
                        std::to_string(most) + ")");
    return false;
  }
  return true;
}

}  // namespace yaml
}  // namespace desert_sim
