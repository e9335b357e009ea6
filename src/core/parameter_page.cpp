#include "src/core/parameter_page.hpp"

#include <vector>

#include "src/core/joined.hpp"

namespace desert_sim {

namespace {

/// Writes the default of one row, and returns what is allowed.
struct DefaultAndRange {
  std::ostream& out;
  const ParameterRow& row;

  std::string operator()(const Choice* value) const {
    out << value->name(row);
    return joined(std::vector<std::string>(row.choices, row.choices + row.choice_count));
  }
  std::string operator()(const ShortList* value) const {
    out << "[";
    for (int n = 0; n < value->count; ++n) out << (n ? ", " : "") << value->values[n];
    out << "]";
    std::ostringstream allowed;
    allowed << "up to " << ShortList::capacity << " of " << row.lowest << " … " << row.highest;
    return allowed.str();
  }
  std::string operator()(const bool* value) const {
    out << (*value ? "true" : "false");
    return "true, false";
  }
  std::string operator()(const std::string* value) const {
    out << (value->empty() ? "" : "`" + *value + "`");
    return "text";
  }
  template <class T>
  std::string operator()(const std::optional<T>* value) const {
    if (*value) out << **value;
    std::ostringstream allowed;
    allowed << row.lowest << " … " << row.highest;
    return allowed.str();
  }
  template <class T>
  std::string operator()(const T* value) const {
    out << *value;
    return limit_text<T>(row.lowest) + " … " + limit_text<T>(row.highest);
  }
};

}  // namespace

void write_parameter_table_head(std::ostream& out) {
  out << "| key | default | unit | allowed | what |\n|---|---|---|---|---|\n";
}

void write_parameter_row(std::ostream& out, const ParameterRow& row, ConstParameterValue default_value) {
  out << "| `" << row.name << "` | ";
  const std::string allowed = std::visit(DefaultAndRange{out, row}, default_value);
  out << " | " << row.unit << " | " << allowed << " | " << row.doc << " |\n";
}

}  // namespace desert_sim
