#pragma once
/// Writes parameter tables as markdown.

#include <ostream>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "src/core/joined.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim {

/// Writes a markdown table with one row per parameter: key, default (the value in `defaults`), unit, allowed
/// range and description.
template <class P>
void write_parameter_table(std::ostream& out, const P& defaults) {
  out << "| key | default | unit | allowed | what |\n|---|---|---|---|---|\n";
  for_each_parameter(defaults, [&](const auto& row, const auto& value) {
    using T = std::decay_t<decltype(value)>;
    out << "| `" << row.name << "` | ";
    std::ostringstream allowed;
    if constexpr (std::is_enum_v<T>) {
      out << row.choices[static_cast<int>(value)];
      allowed << joined(std::vector<std::string>(row.choices, row.choices + row.choice_count));
    } else if constexpr (std::is_same_v<T, ShortList>) {
      out << "[";
      for (int n = 0; n < value.count; ++n) out << (n ? ", " : "") << value.values[n];
      out << "]";
      allowed << "up to " << ShortList::capacity << " of " << row.lowest << " … " << row.highest;
    } else if constexpr (std::is_same_v<T, bool>) {
      out << (value ? "true" : "false");
      allowed << "true, false";
    } else if constexpr (std::is_same_v<T, std::string>) {
      out << (value.empty() ? "" : "`" + value + "`");
      allowed << "text";
    } else if constexpr (is_optional_number<T>) {
      if (value) out << *value;
      allowed << row.lowest << " … " << row.highest;
    } else {
      out << value;
      allowed << limit_text<T>(row.lowest) << " … " << limit_text<T>(row.highest);
    }
    out << " | " << row.unit << " | " << allowed.str() << " | " << row.doc << " |\n";
  });
}

}  // namespace desert_sim
