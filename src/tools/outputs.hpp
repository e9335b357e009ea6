#pragma once
/// Output files of a headless run.

#include <array>
#include <string>

#include "src/simulation/simulation.hpp"
#include "src/tools/measurements.hpp"

namespace desert_sim {

struct RunReport {
  std::string backend, device;
  int threads = 0;                             ///< threads of the CPU backend; 0 on a GPU
  double milliseconds = 0;                     ///< wall time of all steps
  std::uint64_t steps_run = 0;                 ///< steps of this run, without those before a resume
  const Simulation* timed = nullptr;           ///< simulation whose processes were timed
  std::uint64_t timed_steps = 0;               ///< steps in which they were timed
  const Measurements* measurements = nullptr;  ///< null: none
};

/// Creates the folder and its missing parents, and checks that `file` can be written in it. Returns the
/// topmost folder that was created; empty if the folder existed. Throws ConfigError that begins with the
/// option; nothing is then left.
std::string create_output_folder(const std::string& folder, const std::string& option = "--out",
                                 const std::string& file = "summary.json");
/// Removes `folder` and its parents up to `topmost` as long as they are empty.
void remove_empty_folders(const std::string& topmost, const std::string& folder);

/// Writes `<layer>.tif` for each layer in use (unless `rasters` is false), elevation.png, wind.png, flux.png
/// if the flux is known, and summary.json. A build without GDAL and OpenCV writes only summary.json, with
/// "rasters": false.
void write_outputs(const std::string& folder, Simulation& simulation, const RunReport& report,
                   bool rasters = true);

/// The material that a run lost or gained, such as "-3 quanta of sand, 2 quanta of water"; empty if all
/// material is conserved.
std::string conservation_error(const std::array<MaterialBalance, material_count>& balance);

/// The content of summary.json.
std::string summary(Simulation& simulation, const RunReport& report);

}  // namespace desert_sim
