#pragma once
/// Reads and writes the parameters of a table as YAML.

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "src/core/did_you_mean.hpp"
#include "src/core/error.hpp"
#include "src/core/joined.hpp"
#include "src/core/parameters.hpp"
#include "src/core/quoted.hpp"
#include "src/core/time_units.hpp"
#include "src/core/validation_errors.hpp"

namespace desert_sim {

namespace yaml {

inline std::string node_text(const YAML::Node& node) {
  if (node.IsScalar()) {
    const std::string text = node.Scalar();
    return text.size() <= 60 ? text : text.substr(0, 57) + "...";
  }
  return node.IsNull() ? "nothing" : (node.IsMap() ? "a map" : "a list");
}

/// Adds the values of a preset that the scenario does not set. Maps are merged recursively; any other value
/// of the scenario stays.
inline void merge_missing(YAML::Node scenario, const YAML::Node& preset) {
  for (const auto& entry : preset) {
    const std::string key = entry.first.Scalar();
    if (!scenario[key])
      scenario[key] = entry.second;
    else if (scenario[key].IsMap() && entry.second.IsMap())
      merge_missing(scenario[key], entry.second);
  }
}

/// `T`: the type of the row's parameter.
template <class T, class Row>
std::string allowed_range(const Row& row) {
  const std::string range = "[" + limit_text<T>(row.lowest) + ", " + limit_text<T>(row.highest) + "]";
  return std::string(row.unit) != "1" && row.unit[0] ? range + " " + row.unit : range;
}

/// Whether a number is in the row's range. Numbers and limits of float parameters are compared as floats, so
/// that a limit is in range although its conversion to float rounds it. NaN is never in range.
template <class T, class Row>
bool in_range(double number, const Row& row) {
  if constexpr (std::is_same_v<T, float> || std::is_same_v<T, ShortList>)
    return static_cast<float>(number) >= static_cast<float>(row.lowest) &&
           static_cast<float>(number) <= static_cast<float>(row.highest);
  else
    return number >= row.lowest && number <= row.highest;
}

/// Whether `node` is a number of a parameter with this unit. Times may be written with a unit of their own.
inline bool decode_number(const YAML::Node& node, const std::string& unit, double& number) {
  if (!node.IsScalar()) return false;
  if (unit == "s" && read_time_with_unit(node.Scalar(), number)) return true;
  return node.Tag() != "!" && YAML::convert<double>::decode(node, number);
}

/// Reads a number and adds an error if it is not in the row's range. NaN and infinities (.nan, .inf) are
/// parsed too, so that the error names them.
template <class T, class Row>
bool read_number(const YAML::Node& node, const Row& row, const std::string& key, ValidationErrors& errors,
                 double& number) {
  if (!decode_number(node, row.unit, number)) {
    const bool time = std::string(row.unit) == "s";
    errors.add(key, node_text(node) + " is not a " + (time ? "time" : "number") +
                        " (allowed: " + allowed_range<T>(row) +
                        (time ? std::string(", or with a unit: ") + time_units : "") + ")");
    return false;
  }
  if (!in_range<T>(number, row)) {
    errors.add(key, "= " + node_text(node) + " is not in " + allowed_range<T>(row));
    return false;
  }
  return true;
}

template <class Row, class T>
void read_value(const YAML::Node& node, const Row& row, const std::string& key, ValidationErrors& errors,
                T& value) {
  double number = 0;
  if constexpr (std::is_same_v<T, bool>) {
    if (!node.IsScalar() || node.Tag() == "!" || !YAML::convert<bool>::decode(node, value))
      errors.add(key, node_text(node) + " is not true or false");
  } else if constexpr (std::is_same_v<T, std::string>) {
    if (node.IsScalar()) {
      value = node.Scalar();
    } else {
      errors.add(key, node_text(node) + " is not a string");
    }
  } else if constexpr (std::is_enum_v<T>) {
    const std::vector<std::string> choices(row.choices, row.choices + row.choice_count);
    const auto found = std::find(choices.begin(), choices.end(), node.IsScalar() ? node.Scalar() : "");
    if (found == choices.end()) return errors.add(key, not_one_of(node_text(node), joined(choices)));
    value = static_cast<T>(found - choices.begin());
  } else if constexpr (std::is_same_v<T, ShortList>) {
    if (!node.IsSequence() || node.size() < 1 || node.size() > ShortList::capacity) {
      errors.add(key, "must be a list of 1 to " + std::to_string(ShortList::capacity) + " numbers");
      return;
    }
    ShortList list;
    for (std::size_t n = 0; n < node.size(); ++n)
      if (read_number<T>(node[n], row, key + "[" + std::to_string(n) + "]", errors, number))
        list.values[list.count++] = static_cast<float>(number);
    if (list.count == static_cast<int>(node.size())) value = list;
  } else if constexpr (is_optional_number<T>) {
    typename T::value_type given{};
    read_value(node, row, key, errors, given);
    value = given;  // a value that is refused is never used
  } else if constexpr (std::is_floating_point_v<T>) {
    if (read_number<T>(node, row, key, errors, number)) value = static_cast<T>(number);
  } else {
    if (!read_number<T>(node, row, key, errors, number)) return;
    T whole{};
    if (YAML::convert<T>::decode(node, whole)) {
      if (in_range<T>(static_cast<double>(whole), row))  // what begins with 0 is an octal number
        value = whole;
      else
        errors.add(key, "= " + std::to_string(whole) + " is not in " + allowed_range<T>(row));
    } else if (number != std::floor(number)) {
      errors.add(key,
                 "= " + node_text(node) + " is not a whole number (allowed: " + allowed_range<T>(row) + ")");
    } else if (number >= highest_uint64) {  // which a larger integer is rounded to
      errors.add(key, "= " + node_text(node) + " is not in " + allowed_range<T>(row));
    } else {
      value = static_cast<T>(number);
    }
  }
}

/// Reads the keys of `section` that belong to P and adds their names to `known`.
template <class P>
void read_parameters(const YAML::Node& section, const std::string& path, ValidationErrors& errors,
                     P& parameters, std::set<std::string>& known) {
  for_each_parameter(parameters, [&](const auto& row, auto& value) {
    known.insert(row.name);
    if (!section.IsDefined() || !section.IsMap()) return;
    const YAML::Node node = section[row.name];
    if (node.IsDefined()) read_value(node, row, path + row.name, errors, value);
  });
}

/// Adds an error for each key that is not in `known`, and for each key that is given twice. `help`, if given,
/// says what may be meant by a key that stands in the wrong place, or nothing.
inline void reject_unknown_keys(const YAML::Node& section, const std::string& path,
                                const std::set<std::string>& known, ValidationErrors& errors,
                                std::string (*help)(const std::string& key) = nullptr) {
  if (!section.IsDefined() || section.IsNull()) return;
  if (!section.IsMap()) {
    errors.add(path.empty() ? "top level" : path.substr(0, path.size() - 1),
               node_text(section) + " is given where keys and values are expected");
    return;
  }
  const std::string all = joined(known);
  std::set<std::string> seen;
  for (const auto& entry : section) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    if (!known.count(key)) {
      std::string meant = help && !errors.is_full() ? help(key) : "";
      if (meant.empty() && !errors.is_full()) meant = did_you_mean(key, all);
      errors.add(path + key, "unknown key (known here: " + all + ")" + meant);
    }
    if (!seen.insert(key).second) errors.add(path + key, "is given twice");
  }
}

/// Reads a section that consists of one parameter table.
template <class P>
void read_section(const YAML::Node& section, const std::string& path, ValidationErrors& errors,
                  P& parameters) {
  std::set<std::string> known;
  read_parameters(section, path + ".", errors, parameters, known);
  reject_unknown_keys(section, path + ".", known, errors);
}

template <class Row, class T>
void emit_value(YAML::Emitter& out, const Row& row, const T& value) {
  if constexpr (std::is_enum_v<T>) {
    out << row.choices[static_cast<int>(value)];
  } else if constexpr (std::is_same_v<T, ShortList>) {
    out << YAML::Flow << YAML::BeginSeq;
    for (int n = 0; n < value.count; ++n) out << value.values[n];
    out << YAML::EndSeq;
  } else if constexpr (std::is_same_v<T, std::string>) {
    out << YAML::DoubleQuoted << value;
  } else {
    out << value;
  }
}

/// Writes all parameters as entries of an open map, except numbers that were left out. After
/// set_full_precision(), floats are read back exactly.
template <class P>
void emit_parameters(YAML::Emitter& out, const P& parameters) {
  for_each_parameter(parameters, [&](const auto& row, const auto& value) {
    if constexpr (is_optional_number<std::decay_t<decltype(value)>>) {
      if (value) out << YAML::Key << row.name << YAML::Value << *value;
    } else {
      out << YAML::Key << row.name << YAML::Value;
      emit_value(out, row, value);
    }
  });
}

/// Sets a precision at which every float and double is read back exactly.
inline void set_full_precision(YAML::Emitter& out) {
  out.SetFloatPrecision(std::numeric_limits<float>::max_digits10);
  out.SetDoublePrecision(std::numeric_limits<double>::max_digits10);
}

}  // namespace yaml
}  // namespace desert_sim
