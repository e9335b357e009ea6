#pragma once
/// Checks of parameters that were not read from YAML: of commands from services, whose fields can hold
/// anything, and of values that were worked out.

#include <string>

#include "src/core/parameter_values.hpp"
#include "src/core/validation_errors.hpp"

namespace desert_sim {

/// Adds an error unless a number is in its row's range and a choice is one. Texts and switches always pass.
void check_range(const ParameterRow& row, ConstParameterValue value, ValidationErrors& errors);

/// Throws ConfigError, in the name of `what`, unless every number is in its row's range and every choice is
/// one.
template <class P>
void check_ranges(const P& parameters, const std::string& what) {
  ValidationErrors errors(what);
  visit_parameters(parameters, [&](const ParameterRow& row, ConstParameterValue value) {
    check_range(row, value, errors);
  });
  errors.throw_if_any();
}

}  // namespace desert_sim
