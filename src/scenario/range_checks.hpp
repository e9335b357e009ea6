#pragma once
/// Checks of parameters that were not read from YAML: of commands from services, whose fields can hold
/// anything, and of values that were worked out.

#include <sstream>
#include <string>

#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

/// Throws ConfigError, in the name of `what`, unless every number is in its row's range and every choice is
/// one.
template <class P>
void check_ranges(const P& parameters, const std::string& what) {
  ValidationErrors errors(what);
  for_each_parameter(parameters, [&](const auto& row, const auto& value) {
    using T = std::decay_t<decltype(value)>;
    if constexpr (std::is_enum_v<T>) {
      if (static_cast<int>(value) < 0 || static_cast<int>(value) >= row.choice_count)
        errors.add(row.name, std::to_string(static_cast<int>(value)) + " is not one of its choices");
    } else if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
      const double number = static_cast<double>(value);
      if (!yaml::in_range<T>(number, row)) {
        std::ostringstream shown;
        shown << "= " << number << " is not in " << yaml::allowed_range<T>(row);
        errors.add(row.name, shown.str());
      }
    }
  });
  errors.throw_if_any();
}

}  // namespace desert_sim
