#pragma once
/// The file terrain.nc of a run: all layers in use, time by time.

#include <memory>
#include <string>

#include "src/simulation/simulation.hpp"

namespace desert_sim {

class NetcdfWriter;

class TerrainSeries {
 public:
  /// Creates the file with the state now. Throws ConfigError in a build that knows no NetCDF.
  TerrainSeries(const std::string& path, Simulation& simulation);
  ~TerrainSeries();
  /// Appends the state, unless it is the one that was written last.
  void add(Simulation& simulation);

 private:
  std::unique_ptr<NetcdfWriter> file_;
  std::uint64_t last_step_ = 0;
};

}  // namespace desert_sim
