#pragma once
/// The certificate: runs of all kinds, and the one hash that each of them has on every machine. It is a file
/// in JSON with a run a line, config/certificate.json; `desert_run --certify` compares, and writes it.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/scenario/scenario.hpp"

namespace desert_sim {

/// What of a run is hashed.
enum class CertifiedResult : int {
  state,         ///< the state after the steps
  halves,        ///< likewise, with a checkpoint after half of them
  journal,       ///< the state at the end of the journal `file` of the scenario
  checkpoint,    ///< the state after so many more steps than the checkpoint `file` has
  rover,         ///< all states of a rover of the class `rover`, which drives while the terrain changes
  lidar,         ///< scans after the steps
  depth_camera,  ///< pictures likewise
  planner,       ///< costs and paths over the terrain after the steps, and through a forecast of as many more
  forecast,      ///< all that a forecast of so many steps tells
};
constexpr const char* certified_results[] = {"state", "halves",       "journal", "checkpoint", "rover",
                                             "lidar", "depth_camera", "planner", "forecast"};

struct CertifiedRun {
  std::string name;
  CertifiedResult result = CertifiedResult::state;
  std::string scenario;       ///< one of config/scenarios, or with a '/' the path of a file below the package
  std::string file, rover;    ///< of some results; the path of a file below the package
  int width = 0, height = 0;  ///< that the grid is cut to [cells]; 0: the scenario's own
  Settings settings;
  std::uint64_t steps = 0;
  std::optional<std::uint64_t> hash;  ///< none: it has not been recorded
};

using Certificate = std::vector<CertifiedRun>;

/// Throws ConfigError that names `path`, the run and the key: a file that cannot be read or is no
/// certificate, keys that are unknown, missing or no such value, two runs of one name.
Certificate read_certificate(const std::string& path);

/// The text of its file.
std::string certificate_text(const Certificate& runs);

/// Appends a run of each scenario in the package's config/scenarios that has none: 200 steps with at most 256
/// cells along an axis.
void add_new_scenarios(Certificate& runs);

}  // namespace desert_sim
