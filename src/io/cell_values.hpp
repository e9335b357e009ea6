#pragma once
/// The raw numbers of a raster's cells as values, and what among them seems to stand for missing data.

#include <array>
#include <string>

#include "src/io/declared_values.hpp"
#include "src/io/raster.hpp"

namespace desert_sim {

/// Converts the cells of a raster one by one and counts numbers that usually stand for missing data where
/// they do so without being declared.
class CellValues {
 public:
  explicit CellValues(const RasterOptions& options, const DeclaredValues& declared = {})
      : options_(options), declared_(declared) {}

  /// (raw · declared scale + declared offset) · scale + offset as float32; NaN if the raw number is the
  /// nodata of the options. `at_edge`: whether the cell is one of the outermost of its raster.
  float convert(double raw, bool at_edge);

  /// One line for each number that seems to stand for missing data, with its share of the converted cells,
  /// and how to declare it: -9999, -32768, numbers beyond ±1e30 anywhere; 999 and 9999 only where they
  /// reach the edge and no other number comes within 10 of them.
  std::vector<std::string> warnings(const std::string& path) const;

 private:
  struct Suspect {
    double number;
    bool only_at_edge;
    long long cells = 0, at_edge = 0, near = 0;
  };
  bool is_nodata(double raw) const;

  const RasterOptions options_;
  const DeclaredValues declared_;
  long long cells_ = 0, huge_cells_ = 0;
  double huge_ = 0;
  std::array<Suspect, 4> suspects_{{{-9999, false}, {-32768, false}, {999, true}, {9999, true}}};
};

/// Logs a warning for each line of values.warnings().
void warn_of_undeclared_nodata(const CellValues& values, const std::string& path);

}  // namespace desert_sim
