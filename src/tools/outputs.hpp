#pragma once
/// What a headless run leaves behind.

#include <array>
#include <string>

#include "src/simulation/simulation.hpp"

namespace desert_sim {

struct RunReport {
  std::string backend, device;
  int threads = 0;                    ///< of the CPU backend; 0 on a GPU
  double milliseconds = 0;            ///< of all steps together
  std::uint64_t steps_run = 0;        ///< in this run; a resumed one began later
  const Simulation* timed = nullptr;  ///< whose processes were timed, in so many steps
  std::uint64_t timed_steps = 0;
};

/// Makes the folder (its parent must exist) and checks that it can be written to. Throws ConfigError.
void prepare_folder(const std::string& folder);

/// `<layer>.tif` for each layer in use, elevation.png, wind.png and summary.json. Without GDAL and OpenCV
/// only summary.json, which says so.
void write_outputs(const std::string& folder, Simulation& simulation, const RunReport& report);

/// What the books of a run miss, "-3 quanta of sand, 2 quanta of water"; empty if they close.
std::string missing_material(const std::array<MaterialBalance, material_count>& balance);

/// summary.json as text.
std::string summary(Simulation& simulation, const RunReport& report);

}  // namespace desert_sim
