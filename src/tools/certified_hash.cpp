#include "src/tools/certified_hash.hpp"

#include <filesystem>

#include "src/core/error.hpp"
#include "src/core/package_folder.hpp"
#include "src/scenario/scenario_file.hpp"
#include "src/simulation/checkpoint.hpp"
#include "src/simulation/session.hpp"

namespace desert_sim {

namespace {

constexpr const char* tests = "test/";  // what begins so is not installed

bool is_of_tests(const std::string& path) { return path.rfind(tests, 0) == 0; }

void require_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) throw ConfigError(path + ": no such file exists");
}

std::string scenario_path(const CertifiedRun& run) {
  return run.scenario.find('/') == std::string::npos ? scenario_file(run.scenario)
                                                     : package_file(run.scenario);
}

void step(Session& session, std::uint64_t steps) {
  for (std::uint64_t n = 0; n < steps; ++n) session.step();
}

std::uint64_t state_hash(const CertifiedRun& run, const CertifiedPlace& place) {
  Session session(certified_scenario(run), place.load_raster, place.backend, place.threads);
  step(session, run.steps);
  return session.simulation().state().hash();
}

std::uint64_t halves_hash(const CertifiedRun& run, const CertifiedPlace& place) {
  std::string checkpoint;
  {
    Session session(certified_scenario(run), place.load_raster, place.backend, place.threads);
    step(session, run.steps / 2);
    checkpoint = checkpoint_bytes(session.simulation());
  }
  const auto exec = make_exec(place.backend, place.threads);
  const auto simulation = simulation_from_bytes(checkpoint, *exec, run.name);
  while (simulation->steps() < run.steps) simulation->step();
  return simulation->state().hash();
}

std::uint64_t journal_hash(const CertifiedRun& run, const CertifiedPlace& place) {
  const Journal journal = read_journal(package_file(run.file));
  Session session(certified_scenario(run), place.load_raster, place.backend, place.threads, "",
                  journal.undo_memory);
  if (journal.version < 3) session.undo_edits_alone();
  for (const Journal::Entry& entry : journal.entries) {
    step(session, entry.tick - session.ticks());
    session.replay(entry.command);
  }
  step(session, journal.ticks - session.ticks());
  return session.simulation().state().hash();
}

std::uint64_t checkpoint_hash(const CertifiedRun& run, const CertifiedPlace& place) {
  const auto session =
      Session::from_checkpoint(package_file(run.file), place.load_raster, place.backend, place.threads);
  step(*session, run.steps);
  return session->simulation().state().hash();
}

}  // namespace

std::string package_file(const std::string& path) { return package_folder() + "/" + path; }

std::string rover_file(const std::string& name) { return package_file("config/rovers/" + name + ".yaml"); }

Scenario certified_scenario(const CertifiedRun& run) {
  Settings settings;
  if (run.width > 0)
    settings = {"grid.width=" + std::to_string(run.width), "grid.height=" + std::to_string(run.height)};
  settings.insert(settings.end(), run.settings.begin(), run.settings.end());
  return load_scenario(scenario_path(run), settings);
}

std::string why_not_run(const CertifiedRun& run) {
  try {
    for (const std::string& path : {run.scenario, run.file})
      if (is_of_tests(path) && !std::filesystem::exists(package_file(tests)))
        return "it needs " + path + ", which is not installed";
    if (!run.file.empty()) require_file(package_file(run.file));
    if (!run.rover.empty()) require_file(rover_file(run.rover));
    if (run.scenario.empty()) return "";
    const Scenario scenario = certified_scenario(run);
#if !DESERT_WITH_IO
    if (!raster_paths(scenario).empty()) return "it reads a raster, and this build has no GDAL";
#endif
    return "";
  } catch (const ConfigError& e) {
    throw ConfigError("certificate: run " + run.name + ": " + e.what());
  }
}

std::uint64_t certified_hash(const CertifiedRun& run, const CertifiedPlace& place) {
  switch (run.result) {
    case CertifiedResult::state:
      return state_hash(run, place);
    case CertifiedResult::halves:
      return halves_hash(run, place);
    case CertifiedResult::journal:
      return journal_hash(run, place);
    case CertifiedResult::checkpoint:
      return checkpoint_hash(run, place);
    case CertifiedResult::rover:
      return rover_hash(run, place);
    case CertifiedResult::lidar:
      return lidar_hash(run, place);
    case CertifiedResult::depth_camera:
      return depth_camera_hash(run, place);
    case CertifiedResult::planner:
      return planner_hash(run, place);
    case CertifiedResult::forecast:
      return forecast_hash(run, place);
  }
  throw Error("certificate: run " + run.name + ": has no such result");
}

}  // namespace desert_sim
