#pragma once
/// What a run has written over time: terrain.nc, or the rasters in its folder and in step_*.

#include <memory>
#include <string>
#include <vector>

namespace desert_sim {

/// A layer at one time, row-major from the south-west.
struct LayerField {
  int width = 0, height = 0;
  double cell_size = 1, origin_x = 0, origin_y = 0;
  bool periodic = false;
  std::vector<float> values;
};

class RunHistory {
 public:
  virtual ~RunHistory() = default;
  virtual const std::vector<double>& times() const = 0;  ///< rising [s]
  /// Whether the run has written this layer at this time.
  virtual bool has(const std::string& layer, std::size_t time) const = 0;
  /// Throws ConfigError if the run has not written this layer.
  virtual LayerField read(const std::string& layer, std::size_t time) const = 0;
};

/// Of a NetCDF file, or of the --out folder of desert_run. Throws ConfigError if it is neither, or if the
/// build cannot read it.
std::unique_ptr<RunHistory> open_history(const std::string& path);

}  // namespace desert_sim
