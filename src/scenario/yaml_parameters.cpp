#include "src/scenario/yaml_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "src/core/did_you_mean.hpp"
#include "src/core/joined.hpp"
#include "src/core/time_units.hpp"

namespace desert_sim {

namespace yaml {

namespace {

/// Reads a number and adds an error if it is not in the row's range. NaN and infinities (.nan, .inf) are
/// parsed too, so that the error names them.
template <class T>
bool read_number(const YAML::Node& node, const ParameterRow& row, const std::string& key,
                 ValidationErrors& errors, double& number) {
  if (!decode_number(node, row.unit, number)) {
    const bool time = std::string(row.unit) == "s";
    errors.add(key, node_text(node) + " is not a " + (time ? "time" : "number") +
                        " (allowed: " + allowed_range<T>(row) +
                        (time ? std::string(", or with a unit: ") + time_units : "") + ")");
    return false;
  }
  if (!in_range<T>(number, row)) {
    errors.add(key, node_text(node) + " is not in " + allowed_range<T>(row));
    return false;
  }
  return true;
}

struct ReadValue {
  const YAML::Node& node;
  const ParameterRow& row;
  const std::string& key;
  ValidationErrors& errors;

  void operator()(bool* value) const {
    if (!node.IsScalar() || node.Tag() == "!" || !YAML::convert<bool>::decode(node, *value))
      errors.add(key, node_text(node) + " is not true or false");
  }
  void operator()(std::string* value) const {
    if (node.IsScalar())
      *value = node.Scalar();
    else
      errors.add(key, node_text(node) + " is not a string");
  }
  void operator()(Choice* value) const {
    const std::vector<std::string> choices(row.choices, row.choices + row.choice_count);
    const auto found = std::find(choices.begin(), choices.end(), node.IsScalar() ? node.Scalar() : "");
    if (found == choices.end()) return errors.add(key, not_one_of(node_text(node), joined(choices)));
    value->number = static_cast<int>(found - choices.begin());
  }
  void operator()(ShortList* value) const {
    if (!node.IsSequence() || node.size() < 1 || node.size() > ShortList::capacity) {
      errors.add(key, "must be a list of 1 to " + std::to_string(ShortList::capacity) + " numbers");
      return;
    }
    ShortList list;
    double number = 0;
    for (std::size_t n = 0; n < node.size(); ++n)
      if (read_number<ShortList>(node[n], row, key + "[" + std::to_string(n) + "]", errors, number))
        list.values[list.count++] = static_cast<float>(number);
    if (list.count == static_cast<int>(node.size())) *value = list;
  }
  template <class T>
  void operator()(std::optional<T>* value) const {
    T given{};
    (*this)(&given);
    *value = given;  // a value that is refused is never used
  }
  template <class T>
  void operator()(T* value) const {
    double number = 0;
    if (!read_number<T>(node, row, key, errors, number)) return;
    if constexpr (std::is_floating_point_v<T>)
      *value = static_cast<T>(number);
    else
      read_whole_number(number, *value);
  }

 private:
  template <class T>
  void read_whole_number(double number, T& value) const {
    T whole{};
    if (YAML::convert<T>::decode(node, whole)) {
      if (in_range<T>(static_cast<double>(whole), row))  // what begins with 0 is an octal number
        value = whole;
      else
        errors.add(key, std::to_string(whole) + " is not in " + allowed_range<T>(row));
    } else if (number != std::floor(number)) {
      errors.add(key, node_text(node) + " is not a whole number (allowed: " + allowed_range<T>(row) + ")");
    } else if (number >= highest_uint64) {  // which a larger integer is rounded to
      errors.add(key, node_text(node) + " is not in " + allowed_range<T>(row));
    } else {
      value = static_cast<T>(number);
    }
  }
};

struct EmitEntry {
  YAML::Emitter& out;
  const ParameterRow& row;

  YAML::Emitter& begin() const { return out << YAML::Key << row.name << YAML::Value; }
  void operator()(const Choice* value) const { begin() << value->name(row); }
  void operator()(const ShortList* value) const {
    begin() << YAML::Flow << YAML::BeginSeq;
    for (int n = 0; n < value->count; ++n) out << value->values[n];
    out << YAML::EndSeq;
  }
  void operator()(const std::string* value) const { begin() << YAML::DoubleQuoted << *value; }
  template <class T>
  void operator()(const std::optional<T>* value) const {
    if (*value) begin() << **value;
  }
  template <class T>
  void operator()(const T* value) const {
    begin() << *value;
  }
};

}  // namespace

std::string node_text(const YAML::Node& node) {
  if (node.IsScalar()) {
    const std::string text = node.Scalar();
    return text.size() <= 60 ? text : text.substr(0, 57) + "...";
  }
  return node.IsNull() ? "nothing" : (node.IsMap() ? "a map" : "a list");
}

void merge_missing(YAML::Node scenario, const YAML::Node& preset) {
  for (const auto& entry : preset) {
    const std::string key = entry.first.Scalar();
    if (!scenario[key])
      scenario[key] = entry.second;
    else if (scenario[key].IsMap() && entry.second.IsMap())
      merge_missing(scenario[key], entry.second);
  }
}

bool decode_number(const YAML::Node& node, const std::string& unit, double& number) {
  if (!node.IsScalar()) return false;
  if (unit == "s" && read_time_with_unit(node.Scalar(), number)) return true;
  return node.Tag() != "!" && YAML::convert<double>::decode(node, number);
}

bool read_float(const YAML::Node& node, const ParameterRow& row, const std::string& key,
                ValidationErrors& errors, float& number) {
  double found = 0;
  if (!read_number<float>(node, row, key, errors, found)) return false;
  number = static_cast<float>(found);
  return true;
}

void read_value(const YAML::Node& node, const ParameterRow& row, const std::string& key,
                ValidationErrors& errors, ParameterValue value) {
  std::visit(ReadValue{node, row, key, errors}, value);
}

void read_entry(const YAML::Node& section, const ParameterRow& row, const std::string& path,
                ValidationErrors& errors, ParameterValue value) {
  if (!section.IsDefined() || !section.IsMap()) return;
  const YAML::Node node = section[row.name];
  if (node.IsDefined()) read_value(node, row, path + row.name, errors, value);
}

void reject_unknown_keys(const YAML::Node& section, const std::string& path,
                         const std::set<std::string>& known, ValidationErrors& errors,
                         std::string (*help)(const std::string& key)) {
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

void emit_entry(YAML::Emitter& out, const ParameterRow& row, ConstParameterValue value) {
  std::visit(EmitEntry{out, row}, value);
}

void set_full_precision(YAML::Emitter& out) {
  out.SetFloatPrecision(std::numeric_limits<float>::max_digits10);
  out.SetDoublePrecision(std::numeric_limits<double>::max_digits10);
}

}  // namespace yaml
}  // namespace desert_sim
