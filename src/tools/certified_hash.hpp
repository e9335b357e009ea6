#pragma once
/// The hash of a run of the certificate.

#include "src/scenario/raster_grid.hpp"
#include "src/tools/certificate.hpp"

namespace desert_sim {

/// Where runs are done.
struct CertifiedPlace {
  std::string backend;  ///< cpu or cuda
  int threads = 1;      ///< of the CPU backend, for each run
  RasterLoader load_raster;
};

/// Why this build, with the files that are installed, has no way to make the run; empty if it has. Throws
/// ConfigError that names the run if its scenario, rover or file is missing, or its settings are refused.
std::string why_not_run(const CertifiedRun& run);

/// Makes the run. Throws what its parts throw.
std::uint64_t certified_hash(const CertifiedRun& run, const CertifiedPlace& place);

// ---- Its parts.

/// The scenario of the run, with its settings.
Scenario certified_scenario(const CertifiedRun& run);
/// The path of a file below the package's folder.
std::string package_file(const std::string& path);
/// The file of a class of rovers.
std::string rover_file(const std::string& name);

std::uint64_t rover_hash(const CertifiedRun& run, const CertifiedPlace& place);
std::uint64_t lidar_hash(const CertifiedRun& run, const CertifiedPlace& place);
std::uint64_t depth_camera_hash(const CertifiedRun& run, const CertifiedPlace& place);
std::uint64_t planner_hash(const CertifiedRun& run, const CertifiedPlace& place);
std::uint64_t forecast_hash(const CertifiedRun& run, const CertifiedPlace& place);

}  // namespace desert_sim
