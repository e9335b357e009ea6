#pragma once
/// The raw numbers of a raster's cells as values, and what among them seems to stand for missing data.

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

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
  /// and how to declare it: -9999, -32768 and numbers beyond ±1e30 anywhere; -99999, -32767, -999, 32767 and
  /// 65535 where no other number comes within 10 of them; 999 and 9999 only where they also reach the edge;
  /// and the lowest or highest number, whatever it is, where several cells but less than half have it and
  /// five times the range of all others, and 100 m, lie between it and them. Nothing for the number that is
  /// `told` already.
  std::vector<std::string> warnings(const std::string& path, std::optional<double> told = {}) const;

 private:
  enum class Where { anywhere, isolated, isolated_at_edge };
  struct Suspect {
    double number;
    Where where;
    long long cells = 0, at_edge = 0, near = 0;
  };
  /// The least of the numbers that are given, and the least of the others.
  struct Least {
    double number = std::numeric_limits<double>::infinity(), next = std::numeric_limits<double>::infinity();
    long long cells = 0;
    void see(double value);
  };
  bool is_nodata(double raw) const;
  bool is_usual_nodata(double number) const;

  const RasterOptions options_;
  const DeclaredValues declared_;
  long long cells_ = 0, huge_cells_ = 0;
  double huge_ = 0;
  Least lowest_, negative_highest_;
  std::array<Suspect, 9> suspects_{{{-9999, Where::anywhere},
                                    {-32768, Where::anywhere},
                                    {-99999, Where::isolated},
                                    {-32767, Where::isolated},
                                    {-999, Where::isolated},
                                    {32767, Where::isolated},
                                    {65535, Where::isolated},
                                    {999, Where::isolated_at_edge},
                                    {9999, Where::isolated_at_edge}}};
};

/// Logs a warning for each line of values.warnings().
void warn_of_undeclared_nodata(const CellValues& values, const std::string& path,
                               std::optional<double> told = {});

}  // namespace desert_sim
