#include "src/scenario/range_checks.hpp"

#include <sstream>

#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

void check_range(const ParameterRow& row, ConstParameterValue value, ValidationErrors& errors) {
  std::visit(
      [&](const auto* at) {
        using T = std::decay_t<decltype(*at)>;
        if constexpr (std::is_same_v<T, Choice>) {
          if (at->number < 0 || at->number >= row.choice_count)
            errors.add(row.name, std::to_string(at->number) + " is not one of its choices");
        } else if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
          const double number = static_cast<double>(*at);
          if (!yaml::in_range<T>(number, row)) {
            std::ostringstream shown;
            shown << number << " is not in " << yaml::allowed_range<T>(row);
            errors.add(row.name, shown.str());
          }
        }
      },
      value);
}

}  // namespace desert_sim
