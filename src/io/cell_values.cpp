#include "src/io/cell_values.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <set>

#include "src/core/log.hpp"

namespace desert_sim {

namespace {

constexpr double huge_number = 1e30;  // real elevations are far smaller; nodata are ±1e38 or ±3.4e38
constexpr double isolation = 10;      // of a number that may be an elevation as well
constexpr double outlier_ranges = 5, outlier_metres = 100;

/// The shortest text that is read back as the same number; as the same float if the number is one.
std::string shortest_text(double number) {
  const bool is_float = std::abs(number) <= std::numeric_limits<float>::max() &&
                        static_cast<double>(static_cast<float>(number)) == number;
  char text[40];
  if (number == std::floor(number) && std::abs(number) < 1e15) {
    std::snprintf(text, sizeof text, "%.0f", number);
    return text;
  }
  for (int digits = 1; digits <= std::numeric_limits<double>::max_digits10; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, number);
    if (is_float ? std::strtof(text, nullptr) == static_cast<float>(number)
                 : std::strtod(text, nullptr) == number)
      break;
  }
  return text;
}

std::string warning(const std::string& path, double number, long long count, long long cells) {
  char share[80];
  std::snprintf(share, sizeof share, "%.3g %% of its cells (%lld of %lld) are ",
                100.0 * static_cast<double>(count) / static_cast<double>(cells), count, cells);
  const std::string text = shortest_text(number);
  return "raster '" + path + "': " + share + text +
         ", which seems to stand for missing data but is not declared to (in the raster step: nodata: " +
         text + ")";
}

}  // namespace

bool CellValues::is_nodata(double raw) const {
  if (!options_.nodata) return false;
  if (raw == *options_.nodata) return true;
  // -3.4028235e38 and the like are rounded differently as text, as float and as double.
  return std::abs(raw) > huge_number && std::abs(raw - *options_.nodata) < 1e-6 * std::abs(raw);
}

void CellValues::Least::see(double value) {
  if (value == number) {
    ++cells;
  } else if (value < number) {
    next = number;
    number = value;
    cells = 1;
  } else {
    next = std::min(next, value);
  }
}

bool CellValues::is_usual_nodata(double number) const {
  return std::any_of(suspects_.begin(), suspects_.end(), [number](const Suspect& s) {
    return s.number == number && s.where != Where::isolated_at_edge;
  });
}

float CellValues::convert(double raw, bool at_edge) {
  ++cells_;
  if (is_nodata(raw)) return std::numeric_limits<float>::quiet_NaN();
  if (std::abs(raw) > huge_number && std::isfinite(raw)) {
    huge_ = raw;
    ++huge_cells_;
  } else if (std::isfinite(raw) && !is_usual_nodata(raw)) {
    lowest_.see(raw);
    negative_highest_.see(-raw);
  }
  for (Suspect& s : suspects_) {
    if (!(std::abs(raw - s.number) < isolation)) continue;
    if (raw == s.number) {
      ++s.cells;
      s.at_edge += at_edge;
    } else {
      ++s.near;
    }
  }
  const double value = raw * declared_.scale + declared_.offset;
  return static_cast<float>(value * options_.scale + options_.offset);
}

std::vector<std::string> CellValues::warnings(const std::string& path, std::optional<double> told) const {
  std::vector<std::string> lines;
  std::set<double> known;
  if (told) known.insert(*told);
  const auto tell = [&](double number, long long count) {
    if (known.insert(number).second) lines.push_back(warning(path, number, count, cells_));
  };
  for (const Suspect& s : suspects_)
    if (s.cells > 0 && (s.where == Where::anywhere || s.near == 0) &&
        (s.where != Where::isolated_at_edge || s.at_edge > 0))
      tell(s.number, s.cells);
  const double metres = std::abs(declared_.scale * options_.scale);
  const auto lies_apart = [&](double gap, double range, long long count) {
    return count > 1 && 2 * count < cells_ && std::isfinite(gap) && gap > outlier_ranges * range &&
           gap * metres > outlier_metres;
  };
  const double lowest = lowest_.number, highest = -negative_highest_.number;
  const double second = lowest_.next, second_highest = -negative_highest_.next;
  if (lies_apart(second - lowest, highest - second, lowest_.cells)) {
    tell(lowest, lowest_.cells);
  } else if (lies_apart(highest - second_highest, second_highest - lowest, negative_highest_.cells)) {
    tell(highest, negative_highest_.cells);
  }
  if (huge_cells_ > 0) tell(huge_, huge_cells_);
  return lines;
}

void warn_of_undeclared_nodata(const CellValues& values, const std::string& path,
                               std::optional<double> told) {
  for (const std::string& line : values.warnings(path, told)) log_warning(line);
}

}  // namespace desert_sim
