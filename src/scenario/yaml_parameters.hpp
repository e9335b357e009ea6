#pragma once
/// Reads and writes the parameters of a table as YAML.

#include <yaml-cpp/yaml.h>

#include <set>
#include <string>

#include "src/core/parameter_values.hpp"
#include "src/core/validation_errors.hpp"

namespace desert_sim {

namespace yaml {

std::string node_text(const YAML::Node& node);

/// Adds the values of a preset that the scenario does not set. Maps are merged recursively; any other value
/// of the scenario stays.
void merge_missing(YAML::Node scenario, const YAML::Node& preset);

/// `T`: the type of the row's parameter.
template <class T>
std::string allowed_range(const ParameterRow& row) {
  const std::string range = "[" + limit_text<T>(row.lowest) + ", " + limit_text<T>(row.highest) + "]";
  return std::string(row.unit) != "1" && row.unit[0] ? range + " " + row.unit : range;
}

/// Whether a number is in the row's range. Numbers and limits of float parameters are compared as floats, so
/// that a limit is in range although its conversion to float rounds it. NaN is never in range.
template <class T>
bool in_range(double number, const ParameterRow& row) {
  if constexpr (std::is_same_v<T, float> || std::is_same_v<T, ShortList>)
    return static_cast<float>(number) >= static_cast<float>(row.lowest) &&
           static_cast<float>(number) <= static_cast<float>(row.highest);
  else
    return number >= row.lowest && number <= row.highest;
}

/// Whether `node` is a number of a parameter with this unit. Times may be written with a unit of their own.
bool decode_number(const YAML::Node& node, const std::string& unit, double& number);

/// Reads a float and adds an error if it is not in the row's range.
bool read_float(const YAML::Node& node, const ParameterRow& row, const std::string& key,
                ValidationErrors& errors, float& number);

/// Sets a value, or adds an error and leaves it.
void read_value(const YAML::Node& node, const ParameterRow& row, const std::string& key,
                ValidationErrors& errors, ParameterValue value);

/// Reads the key of `section` that belongs to the row, if it is there.
void read_entry(const YAML::Node& section, const ParameterRow& row, const std::string& path,
                ValidationErrors& errors, ParameterValue value);

/// Reads the keys of `section` that belong to P and adds their names to `known`.
template <class P>
void read_parameters(const YAML::Node& section, const std::string& path, ValidationErrors& errors,
                     P& parameters, std::set<std::string>& known) {
  visit_parameters(parameters, [&](const ParameterRow& row, ParameterValue value) {
    known.insert(row.name);
    read_entry(section, row, path, errors, value);
  });
}

/// Adds an error for each key that is not in `known`, and for each key that is given twice. `help`, if given,
/// says what may be meant by a key that stands in the wrong place, or nothing.
void reject_unknown_keys(const YAML::Node& section, const std::string& path,
                         const std::set<std::string>& known, ValidationErrors& errors,
                         std::string (*help)(const std::string& key) = nullptr);

/// Reads a section that consists of one parameter table.
template <class P>
void read_section(const YAML::Node& section, const std::string& path, ValidationErrors& errors,
                  P& parameters) {
  std::set<std::string> known;
  read_parameters(section, path + ".", errors, parameters, known);
  reject_unknown_keys(section, path + ".", known, errors);
}

/// Writes a parameter as an entry of an open map; a number that was left out not at all. After
/// set_full_precision(), floats are read back exactly.
void emit_entry(YAML::Emitter& out, const ParameterRow& row, ConstParameterValue value);

/// Writes all parameters as entries of an open map.
template <class P>
void emit_parameters(YAML::Emitter& out, const P& parameters) {
  visit_parameters(parameters,
                   [&](const ParameterRow& row, ConstParameterValue value) { emit_entry(out, row, value); });
}

/// Sets a precision at which every float and double is read back exactly.
void set_full_precision(YAML::Emitter& out);

}  // namespace yaml
}  // namespace desert_sim
