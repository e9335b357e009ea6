#pragma once
/// Parameters of a table (parameter_table.hpp) for code that is compiled once for all tables.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "src/core/parameter_table.hpp"

namespace desert_sim {

/// The value of any enumeration: the number of its choice.
struct Choice {
  int number = 0;
  const char* name(const ParameterRow& row) const { return row.choices[number]; }
};

/// A parameter of a type that is known when the program runs. A value that can change, and one that cannot.
using ParameterValue =
    std::variant<bool*, int*, std::uint64_t*, float*, double*, std::string*, ShortList*, std::optional<int>*,
                 std::optional<float>*, std::optional<double>*, Choice*>;
using ConstParameterValue =
    std::variant<const bool*, const int*, const std::uint64_t*, const float*, const double*,
                 const std::string*, const ShortList*, const std::optional<int>*, const std::optional<float>*,
                 const std::optional<double>*, const Choice*>;
using ParameterVisit = std::function<void(const ParameterRow&, ParameterValue)>;
using ConstParameterVisit = std::function<void(const ParameterRow&, ConstParameterValue)>;

/// for_each_parameter() for code that is compiled once for all tables.
template <class P>
void visit_parameters(P& parameters, const ParameterVisit& visit) {
  for_each_parameter(parameters, [&](const auto& row, auto& value) {
    using T = std::decay_t<decltype(value)>;
    if constexpr (std::is_enum_v<T>) {
      Choice choice{static_cast<int>(value)};
      visit(row, &choice);
      value = static_cast<T>(choice.number);
    } else {
      visit(row, &value);
    }
  });
}
template <class P>
void visit_parameters(const P& parameters, const ConstParameterVisit& visit) {
  for_each_parameter(parameters, [&](const auto& row, const auto& value) {
    if constexpr (std::is_enum_v<std::decay_t<decltype(value)>>) {
      const Choice choice{static_cast<int>(value)};
      visit(row, &choice);
    } else {
      visit(row, &value);
    }
  });
}

}  // namespace desert_sim
