#pragma once
/// Writes parameter tables as markdown.

#include <ostream>

#include "src/core/parameter_values.hpp"

namespace desert_sim {

void write_parameter_table_head(std::ostream& out);
/// One row: key, default, unit, allowed range and description.
void write_parameter_row(std::ostream& out, const ParameterRow& row, ConstParameterValue default_value);

/// Writes a markdown table with one row per parameter; its defaults are the values in `defaults`.
template <class P>
void write_parameter_table(std::ostream& out, const P& defaults) {
  write_parameter_table_head(out);
  visit_parameters(defaults, [&](const ParameterRow& row, ConstParameterValue value) {
    write_parameter_row(out, row, value);
  });
}

}  // namespace desert_sim
