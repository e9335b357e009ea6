#include "desert_sim/ros/reconfigure_messages.hpp"

#include <cstdio>
#include <cstdlib>
#include <map>
#include <sstream>

#include "desert_sim/ros/node_parameters.hpp"
#include "desert_sim/scenario/live_parameters.hpp"
#include "desert_sim/scenario/yaml_parameters.hpp"

namespace desert_sim {

using dynamic_reconfigure::Config;

namespace {

constexpr const char *separator = "__", *step_rate_name = "step_rate";

/// How a parameter travels.
template <class T>
constexpr const char* type_name() {
  if (std::is_same_v<T, bool>) return "bool";
  if (std::is_same_v<T, int>) return "int";
  return std::is_floating_point_v<T> ? "double" : "str";
}

/// The shortest decimal number that is this float: 0.3, not 0.300000012.
double shortest(double value) { return value; }
double shortest(float value) {
  char text[32];
  for (int digits = 6; digits <= 9; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, static_cast<double>(value));
    if (std::strtof(text, nullptr) == value) break;
  }
  return std::strtod(text, nullptr);
}

template <class Row, class T>
std::string as_text(const Row& row, const T& value) {
  std::ostringstream text;
  if constexpr (std::is_enum_v<T>) {
    text << row.choices[static_cast<int>(value)];
  } else if constexpr (std::is_same_v<T, ShortList>) {
    text << "[";
    for (int n = 0; n < value.count; ++n) text << (n ? ", " : "") << shortest(value.values[n]);
    text << "]";
  } else {
    text << value;
  }
  return text.str();
}

template <class Entries, class Value>
void put(Entries& entries, const std::string& name, const Value& value) {
  entries.emplace_back();
  entries.back().name = name;
  entries.back().value = value;
}

/// One value; which list of the message it goes to follows from its type.
template <class Row, class T>
void add_value(Config& config, const std::string& name, const Row& row, const T& value) {
  if constexpr (std::is_same_v<T, bool>)
    put(config.bools, name, value);
  else if constexpr (std::is_same_v<T, int>)
    put(config.ints, name, value);
  else if constexpr (std::is_floating_point_v<T>)
    put(config.doubles, name, shortest(value));
  else
    put(config.strs, name, as_text(row, value));
}

template <class T, class Row>
void add_limit(Config& config, const std::string& name, const Row& row, double limit) {
  if constexpr (std::is_same_v<T, bool>)
    put(config.bools, name, limit > 0);
  else if constexpr (std::is_same_v<T, int>)
    put(config.ints, name, static_cast<int>(limit));
  else if constexpr (std::is_floating_point_v<T>)
    put(config.doubles, name, limit);
  else
    put(config.strs, name, std::string());
  (void)row;
}

/// What rqt_reconfigure shows as a drop-down list: a Python dictionary as text.
template <class Row>
std::string edit_method(const Row& row) {
  if (!row.choices) return "";
  std::string entries;
  for (int n = 0; n < row.choice_count; ++n)
    entries +=
        (n ? ", " : "") + std::string("{'name': '") + row.choices[n] + "', 'value': '" + row.choices[n] +
        "', 'type': 'str', 'description': '', 'ctype': 'std::string', 'cconsttype': 'const char * const'"
        ", 'srcline': 0, 'srcfile': ''}";
  return "{'enum': [" + entries + "], 'enum_description': ''}";
}

template <class Row>
std::string description_of(const Row& row) {
  const std::string unit = row.unit, doc = row.doc;
  return unit.empty() || unit == "1" ? doc : doc + " [" + unit + "]";
}

template <class Row, class T>
void describe(dynamic_reconfigure::ConfigDescription& description, dynamic_reconfigure::Group& group,
              const std::string& name, const Row& row, const T&) {
  dynamic_reconfigure::ParamDescription parameter;
  parameter.name = name;
  parameter.type = type_name<T>();
  parameter.description = description_of(row);
  parameter.edit_method = edit_method(row);
  group.parameters.push_back(parameter);
  add_limit<T>(description.min, name, row, row.lowest);
  add_limit<T>(description.max, name, row, row.highest);
}

/// Calls visit(row, default) for the node's step_rate.
template <class Visit>
void with_step_rate_row(Visit&& visit) {
  const NodeParameters node;
  for_each_parameter(node, [&](const auto& row, const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
      if (row.name == std::string(step_rate_name)) visit(row, value);
  });
}

/// Sections in their order; the group's id is 1 + the index.
std::vector<std::string> section_names() {
  std::vector<std::string> names;
  const Scenario scenario;
  for_each_live_parameter(scenario, [&](const std::string& section, const auto&, const auto&) {
    if (names.empty() || names.back() != section) names.push_back(section);
  });
  return names;
}

std::vector<dynamic_reconfigure::GroupState> group_states() {
  std::vector<dynamic_reconfigure::GroupState> groups(1);
  groups[0].name = "Default";
  groups[0].state = true;
  for (const std::string& section : section_names()) {
    dynamic_reconfigure::GroupState group;
    group.name = section;
    group.state = true;
    group.id = static_cast<int>(groups.size());
    groups.push_back(group);
  }
  return groups;
}

/// Texts of all values, by name.
std::map<std::string, std::string> texts(const Config& config) {
  std::map<std::string, std::string> all;
  for (const auto& entry : config.bools) all[entry.name] = entry.value ? "true" : "false";
  for (const auto& entry : config.ints) all[entry.name] = std::to_string(entry.value);
  for (const auto& entry : config.strs) all[entry.name] = entry.value;
  for (const auto& entry : config.doubles) {
    YAML::Emitter text;  // which has words for what is not finite
    yaml::keep_all_bits(text);
    text << entry.value;
    all[entry.name] = text.c_str();
  }
  return all;
}

}  // namespace

Config reconfigure_values(const Scenario& scenario, double step_rate) {
  Config config;
  put(config.doubles, step_rate_name, step_rate);
  for_each_live_parameter(scenario, [&](const std::string& section, const auto& row, const auto& value) {
    add_value(config, section + separator + row.name, row, value);
  });
  config.groups = group_states();
  return config;
}

dynamic_reconfigure::ConfigDescription reconfigure_description(const Scenario& defaults, double step_rate) {
  dynamic_reconfigure::ConfigDescription description;
  description.dflt = reconfigure_values(defaults, step_rate);
  for (const auto& state : group_states()) {
    dynamic_reconfigure::Group group;
    group.name = state.name;
    group.id = state.id;
    description.groups.push_back(group);
  }
  for_each_live_parameter(defaults, [&](const std::string& section, const auto& row, const auto& value) {
    for (auto& group : description.groups)
      if (group.name == section) describe(description, group, section + separator + row.name, row, value);
  });
  with_step_rate_row([&](const auto& row, const auto& value) {
    describe(description, description.groups.front(), row.name, row, value);
  });
  description.min.groups = description.max.groups = description.dflt.groups;
  return description;
}

double reconfigure_step_rate(const Config& request, double present) {
  Faults faults("set_parameters");
  double rate = present;
  for (const auto& entry : request.doubles)
    if (entry.name == step_rate_name) rate = entry.value;
  with_step_rate_row([&](const auto& row, const auto&) {
    if (!yaml::in_range<double>(rate, row))
      faults.add(step_rate_name, "= " + std::to_string(rate) + " is not in " + yaml::allowed_range(row));
  });
  faults.throw_if_any();
  return rate;
}

Settings reconfigure_settings(const Config& request, const Scenario& present) {
  const std::map<std::string, std::string> now = texts(reconfigure_values(present, 0));
  Faults faults("set_parameters");
  Settings settings;
  for (const auto& [name, value] : texts(request)) {
    if (name == step_rate_name) continue;
    const std::size_t split = name.find(separator);
    const std::string path =
        split == std::string::npos ? name : name.substr(0, split) + "." + name.substr(split + 2);
    const auto found = now.find(name);
    if (found == now.end()) {
      const char* why = why_fixed(path);
      faults.add(path, why ? std::string("cannot change while the simulation runs: ") + why
                           : std::string("unknown parameter"));
    } else if (found->second != value) {
      settings.push_back(path + "=" + value);
    }
  }
  faults.throw_if_any();
  return settings;
}

}  // namespace desert_sim
