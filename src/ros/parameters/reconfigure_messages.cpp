#include "src/ros/parameters/reconfigure_messages.hpp"

#include <map>
#include <sstream>

#include "src/core/shortest_decimal.hpp"
#include "src/ros/parameters/node_parameters.hpp"
#include "src/scenario/live_parameters.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

using dynamic_reconfigure::Config;

namespace {

constexpr const char *separator = "__", *step_rate_name = "step_rate";

/// The type that dynamic_reconfigure has for parameters of type T.
template <class T>
constexpr const char* type_name() {
  if (std::is_same_v<T, bool>) return "bool";
  if (std::is_same_v<T, int>) return "int";
  return std::is_floating_point_v<T> ? "double" : "str";
}

double as_written(double value) { return value; }
double as_written(float value) { return shortest_decimal(value); }

template <class T>
std::string as_text(const ParameterRow& row, const T& value) {
  std::ostringstream text;
  if constexpr (std::is_same_v<T, Choice>) {
    text << value.name(row);
  } else if constexpr (is_optional_number<T>) {
    if (value) text << *value;
  } else if constexpr (std::is_same_v<T, ShortList>) {
    text << "[";
    for (int n = 0; n < value.count; ++n) text << (n ? ", " : "") << as_written(value.values[n]);
    text << "]";
  } else {
    text << value;
  }
  return text.str();
}

template <class Entries, class Value>
void add_entry(Entries& entries, const std::string& name, const Value& value) {
  entries.emplace_back();
  entries.back().name = name;
  entries.back().value = value;
}

/// Adds one value to the list of the message that is for its type.
template <class T>
void add_value(Config& config, const std::string& name, const ParameterRow& row, const T& value) {
  if constexpr (std::is_same_v<T, bool>)
    add_entry(config.bools, name, value);
  else if constexpr (std::is_same_v<T, int>)
    add_entry(config.ints, name, value);
  else if constexpr (std::is_floating_point_v<T>)
    add_entry(config.doubles, name, as_written(value));
  else
    add_entry(config.strs, name, as_text(row, value));
}

template <class T>
void add_limit(Config& config, const std::string& name, double limit) {
  if constexpr (std::is_same_v<T, bool>)
    add_entry(config.bools, name, limit > 0);
  else if constexpr (std::is_same_v<T, int>)
    add_entry(config.ints, name, static_cast<int>(limit));
  else if constexpr (std::is_floating_point_v<T>)
    add_entry(config.doubles, name, limit);
  else
    add_entry(config.strs, name, std::string());
}

/// The choices that rqt_reconfigure shows as a drop-down list: a Python dictionary as text.
std::string edit_method(const ParameterRow& row) {
  if (!row.choices) return "";
  std::string entries;
  for (int n = 0; n < row.choice_count; ++n)
    entries +=
        (n ? ", " : "") + std::string("{'name': '") + row.choices[n] + "', 'value': '" + row.choices[n] +
        "', 'type': 'str', 'description': '', 'ctype': 'std::string', 'cconsttype': 'const char * const'"
        ", 'srcline': 0, 'srcfile': ''}";
  return "{'enum': [" + entries + "], 'enum_description': ''}";
}

std::string description_of(const ParameterRow& row) {
  const std::string unit = row.unit, doc = row.doc;
  return unit.empty() || unit == "1" ? doc : doc + " [" + unit + "]";
}

template <class T>
void describe(dynamic_reconfigure::ConfigDescription& description, dynamic_reconfigure::Group& group,
              const std::string& name, const ParameterRow& row, const T&) {
  dynamic_reconfigure::ParamDescription parameter;
  parameter.name = name;
  parameter.type = type_name<T>();
  parameter.description = description_of(row);
  parameter.edit_method = edit_method(row);
  group.parameters.push_back(parameter);
  add_limit<T>(description.min, name, row.lowest);
  add_limit<T>(description.max, name, row.highest);
}

/// Calls visit(group, name, row, value) for all parameters that can change, group by group. The first group
/// is "".
template <class Visit>
void for_each_live(const LiveParameters& live, Visit&& visit) {
  const auto typed = [&](const std::string& group, const std::string& name, const ParameterRow& row,
                         ConstParameterValue value) {
    std::visit([&](const auto* at) { visit(group, name, row, *at); }, value);
  };
  visit_parameters(NodeParameters(), [&](const ParameterRow& row, ConstParameterValue) {
    if (row.name == std::string(step_rate_name)) typed("", step_rate_name, row, &live.step_rate);
  });
  visit_publisher_parameters(live.publishers, [&](const ParameterRow& row, ConstParameterValue value) {
    typed("publishers", row.name, row, value);
  });
  visit_live_parameters(live.scenario,
                        [&](const std::string& section, const ParameterRow& row, ConstParameterValue value) {
                          typed(section, section + separator + row.name, row, value);
                        });
}

/// The groups in their order; the id of a group is its index. dynamic_reconfigure calls the first one
/// Default.
std::vector<dynamic_reconfigure::GroupState> group_states() {
  std::vector<dynamic_reconfigure::GroupState> groups;
  const LiveParameters live;
  for_each_live(live, [&](const std::string& name, const std::string&, const auto&, const auto&) {
    const std::string shown = name.empty() ? "Default" : name;
    if (!groups.empty() && groups.back().name == shown) return;
    groups.emplace_back();
    groups.back().name = shown;
    groups.back().state = true;
    groups.back().id = static_cast<int>(groups.size()) - 1;
  });
  return groups;
}

/// The texts of all values, by name.
std::map<std::string, std::string> texts(const Config& config) {
  std::map<std::string, std::string> all;
  for (const auto& entry : config.bools) all[entry.name] = entry.value ? "true" : "false";
  for (const auto& entry : config.ints) all[entry.name] = std::to_string(entry.value);
  for (const auto& entry : config.strs) all[entry.name] = entry.value;
  for (const auto& entry : config.doubles) {
    YAML::Emitter text;  // it has names for numbers that are not finite
    yaml::set_full_precision(text);
    text << entry.value;
    all[entry.name] = text.c_str();
  }
  return all;
}

}  // namespace

Config reconfigure_values(const LiveParameters& present) {
  Config config;
  for_each_live(present, [&](const std::string&, const std::string& name, const auto& row,
                             const auto& value) { add_value(config, name, row, value); });
  config.groups = group_states();
  return config;
}

dynamic_reconfigure::ConfigDescription reconfigure_description(const LiveParameters& defaults) {
  dynamic_reconfigure::ConfigDescription description;
  description.dflt = reconfigure_values(defaults);
  for (const auto& state : description.dflt.groups) {
    dynamic_reconfigure::Group group;
    group.name = state.name;
    group.id = state.id;
    description.groups.push_back(group);
  }
  for_each_live(defaults, [&](const std::string& group_name, const std::string& name, const auto& row,
                              const auto& value) {
    for (auto& group : description.groups)
      if (group.name == (group_name.empty() ? "Default" : group_name))
        describe(description, group, name, row, value);
  });
  description.min.groups = description.max.groups = description.dflt.groups;
  return description;
}

std::string ineffective_rate(double step_rate, const RunParameters& run) {
  if (!(run.acceleration > 0)) return "";
  std::ostringstream text;
  text << step_rate << " steps/s has no effect while run.acceleration = " << run.acceleration
       << " and run.time_step = " << run.time_step << " s make " << run.acceleration / run.time_step
       << " steps/s (allowed: any rate once run.acceleration is 0)";
  return text.str();
}

LiveChange reconfigure_change(const Config& request, const LiveParameters& present) {
  const std::map<std::string, std::string> now = texts(reconfigure_values(present));
  ValidationErrors errors("set_parameters");
  LiveChange change;
  YAML::Node others(YAML::NodeType::Map);  // parameters of the node and its topics
  for (const auto& [name, value] : texts(request)) {
    const std::size_t split = name.find(separator);
    const std::string path =
        split == std::string::npos ? name : name.substr(0, split) + "." + name.substr(split + 2);
    const auto found = now.find(name);
    if (found == now.end()) {
      const char* reason = fixed_reason(path);
      errors.add(path, reason ? std::string("cannot change while the simulation runs: ") + reason
                              : std::string("unknown parameter"));
    } else if (found->second != value) {
      if (split == std::string::npos)
        others[name] = value;
      else
        change.settings.push_back(path + "=" + value);
    }
  }
  std::set<std::string> known;
  NodeParameters node;
  node.step_rate = present.step_rate;
  yaml::read_parameters(others, "", errors, node, known);
  change.step_rate = node.step_rate;
  change.publishers = present.publishers;
  read_publisher_setup(others, errors, change.publishers, known);
  errors.throw_if_any();
  if (change.step_rate != present.step_rate) {
    const Scenario wanted = with_live_settings(present.scenario, change.settings);
    if (const std::string reason = ineffective_rate(change.step_rate, wanted.run); !reason.empty())
      errors.add(step_rate_name, reason);
    errors.throw_if_any();
  }
  check_map_sizes(change.publishers.maps, present.scenario.grid);
  return change;
}

}  // namespace desert_sim
