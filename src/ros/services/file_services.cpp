/// Services for checkpoints, terrains and scenarios in files.

#include <desert_sim/ExportTerrain.h>
#include <desert_sim/LoadCheckpoint.h>
#include <desert_sim/LoadScenario.h>
#include <desert_sim/LoadTerrain.h>
#include <desert_sim/NewScenario.h>
#include <desert_sim/SaveCheckpoint.h>
#include <desert_sim/SaveScenario.h>
#include <desert_sim/SaveTerrain.h>
#include <ros/console.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>

#include "src/core/did_you_mean.hpp"
#include "src/core/hash_text.hpp"
#include "src/core/joined.hpp"
#include "src/core/number_text.hpp"
#include "src/core/quoted.hpp"
#include "src/export/export_formats.hpp"
#include "src/ros/services/services.hpp"
#include "src/ros/services/terrain_formats.hpp"
#include "src/scenario/band_terrain.hpp"
#include "src/scenario/scenario_file.hpp"

namespace desert_sim {

namespace {

constexpr const char* terrain_file = "terrain.yaml";  // in the folder of a saved terrain

std::string saved_scenario_in(const std::string& folder) { return folder + "/" + saved_scenario_file; }

/// A name that is no file's either may be that of an installed scenario, mistyped.
std::string scenario_below_data_folder(const DataFolder& files, const std::string& name) {
  try {
    return files.for_reading(files.has_folder(name) ? saved_scenario_in(name) : name);
  } catch (const ConfigError& e) {
    if (name.find('/') != std::string::npos) throw;
    const std::string known = joined(installed_scenarios());
    throw ConfigError(std::string(e.what()) + "; nor is it an installed scenario (known: " + known + ")" +
                      did_you_mean(name, known));
  }
}

/// Terrains and scenarios are several files, which are written after the simulation was asked whether the
/// journal needs what is there. Until all are written nothing is loaded: it could be a part of them, or what
/// the journal needs from then on. Nor are others written.
class FilesLock {
 public:
  /// Waits as long as SimulationThread::Patience says. Throws ConfigError.
  std::unique_lock<std::timed_mutex> lock() {
    std::unique_lock<std::timed_mutex> lock(mutex_, std::defer_lock);
    const double seconds = SimulationThread::Patience::seconds();
    if (!(seconds > 0))
      lock.lock();
    else if (!lock.try_lock_for(std::chrono::duration<double>(seconds)))
      throw ConfigError("other files have been written or loaded for " + number_text(seconds) +
                        " s (~answer_timeout); this request was withdrawn and has changed nothing");
    return lock;
  }

 private:
  std::timed_mutex mutex_;
};

/// Starts the simulation from what is in files.
class Loader {
 public:
  Loader(Services& services, std::shared_ptr<FilesLock> files)
      : services_(services), files_(std::move(files)) {}

  ReachedState load(const Command& command) {
    auto lock = files_->lock();
    const ReachedState reached = services_.context().simulation.apply(command, true).get();
    lock.unlock();
    services_.terrain_replaced();
    return reached;
  }
  /// The hash of the new state.
  std::string load_scenario(const command::LoadScenario& command) {
    const ReachedState reached = load(command);
    ROS_INFO("%s was loaded.", command.path.c_str());
    return hash_text(reached.hash);
  }

 private:
  Services& services_;
  std::shared_ptr<FilesLock> files_;
};

void save_checkpoint(const ServiceContext& c, const SaveCheckpointRequest& request,
                     SaveCheckpointResponse& response) {
  const WritableFile file = c.files.for_writing(request.name);
  const ReachedState reached =
      file.write([&](const std::string& path) { return c.simulation.save_checkpoint(path).get(); });
  response.path = file.path();
  response.step = reached.moment.step;
  response.state_hash = hash_text(reached.hash);
  ROS_INFO("The checkpoint of step %lu was saved to %s.", static_cast<unsigned long>(response.step),
           response.path.c_str());
}

void load_checkpoint(Loader& loader, const std::string& path, LoadCheckpointResponse& response) {
  const ReachedState reached = loader.load(command::LoadCheckpoint{path, 0});
  response.step = reached.moment.step;
  response.sim_time = reached.moment.time;
  response.state_hash = hash_text(reached.hash);
  ROS_INFO("The checkpoint of step %lu was loaded from %s.", static_cast<unsigned long>(response.step),
           path.c_str());
}

void save_terrain_folder(const ServiceContext& c, FilesLock& files, const SaveTerrainRequest& request,
                         SaveTerrainResponse& response) {
  const TerrainFormat format = terrain_format(request.format);
  if (is_bag(request.name))
    throw ConfigError(
        "name: " + in_quotes(request.name) +
        " has the extension .bag, which load_terrain reads as a file (allowed: the name of a folder)");
  const WritableFile file = c.files.for_writing(request.name + "/" + terrain_file);
  const auto lock = files.lock();
  const TerrainToSave terrain = c.simulation.terrain_to_save(file.path()).get();
  const LayerWriter writer =
      layer_writer(format, terrain, c.frames.terrain_frame(), c.node.resolveName("grid_map"));
  file.write([&](const std::string& path) {
    save_terrain(path, terrain.scenario, *terrain.state.snapshot, writer, hash_text(terrain.hash));
  });
  response.path = file.path();
  response.step = terrain.state.moment.step;
  ROS_INFO("The terrain of step %lu was saved to %s.", static_cast<unsigned long>(response.step),
           response.path.c_str());
}

void export_terrain_files(const ServiceContext& c, FilesLock& files, const ExportTerrainRequest& request,
                          ExportTerrainResponse& response) {
  DataFolder::require_name(request.name);
  export_format(request.name);  // refuses other endings before there are new folders
  const WritableFile file = c.files.for_writing(request.name);
  const std::vector<std::string> all = exported_files(file.path());
  const auto lock = files.lock();
  const TerrainToExport terrain = c.simulation.terrain_to_export(all).get();
  const Snapshot& snapshot = *terrain.state.snapshot;
  file.write([&](const std::string& path) {
    require_exportable(path, snapshot.width, snapshot.height, terrain.rasters);
    export_terrain(path, {terrain.state.snapshot, terrain.state.plants, [&] {
                            if (c.simulation.ended())
                              throw ConfigError(file.path() + ": is not written: the node ends");
                          }});
  });
  response.path = file.path();
  response.files = all;
  response.step = terrain.state.moment.step;
  ROS_INFO("The terrain of step %lu was exported to %s.", static_cast<unsigned long>(response.step),
           response.path.c_str());
}

/// The name would lead to the installed scenario when it is loaded.
void require_not_installed(const std::string& name) {
  const std::string folder = std::filesystem::path(name + "/").lexically_normal().parent_path().string();
  if (!installed_scenario_file(folder).empty())
    throw ConfigError("name: " + in_quotes(name) +
                      " is that of an installed scenario (allowed: another one, such as " +
                      in_quotes("my_" + folder) + ")");
}

void save_scenario_folder(const ServiceContext& c, FilesLock& files, const SaveScenarioRequest& request,
                          SaveScenarioResponse& response) {
  require_not_installed(request.name);
  const WritableFile file = c.files.for_writing(saved_scenario_in(request.name));
  const auto lock = files.lock();
  const ScenarioToSave saved = c.simulation.scenario_to_save(file.path()).get();
  file.write([&](const std::string& path) {
    save_scenario(path, saved.scenario, saved.moment.step, saved.checkpoint);
  });
  response.path = file.path();
  response.step = saved.moment.step;
  response.state_hash = hash_text(saved.hash);
  ROS_INFO("The scenario was saved at step %lu to %s.", static_cast<unsigned long>(response.step),
           response.path.c_str());
}

/// The command that starts an installed scenario, or one below the data folder.
command::LoadScenario named_scenario(const DataFolder& files, const LoadScenarioRequest& request) {
  const std::string& name = request.name;
  command::LoadScenario command;
  command.path = installed_scenario_file(name);
  command.settings = request.settings;
  if (command.path.empty()) {
    command.path = scenario_below_data_folder(files, name);
    return command;
  }
  for (const std::string& other : {saved_scenario_in(name), "./" + name})
    if (files.has_file(other)) throw ConfigError("name: " + two_meanings(name, other));
  command.folder = installed_scenario_folder();
  return command;
}

/// The command that starts a text; files that it names are looked up below the data folder.
command::LoadScenario new_scenario(const DataFolder& files, const NewScenarioRequest& request) {
  const std::string name = request.name.empty() ? "new" : request.name;
  if (name.find('/') != std::string::npos)
    throw ConfigError("name: " + in_quotes(name) + " has a '/' (allowed: a name, which is no path)");
  if (request.yaml.empty()) throw ConfigError("yaml: is empty (allowed: the text of a scenario)");
  if (request.yaml.size() > max_scenario_bytes)
    throw ConfigError("yaml: has " + std::to_string(request.yaml.size()) + " bytes (allowed: at most " +
                      std::to_string(max_scenario_bytes) + ")");
  command::LoadScenario command;
  command.path = files.path() + "/" + name + ".yaml";
  command.yaml = request.yaml;
  command.settings = request.settings;
  return command;
}

}  // namespace

void add_file_services(Services& services) {
  const ServiceContext& c = services.context();
  const auto files = std::make_shared<FilesLock>();
  const auto loader = std::make_shared<Loader>(services, files);

  services.add<SaveCheckpoint>("save_checkpoint",
                               [&c](const SaveCheckpointRequest& request, SaveCheckpointResponse& response) {
                                 save_checkpoint(c, request, response);
                               });
  services.add<LoadCheckpoint>("load_checkpoint", [&c, loader](const LoadCheckpointRequest& request,
                                                               LoadCheckpointResponse& response) {
    load_checkpoint(*loader, c.files.for_reading(request.name), response);
  });
  services.add<SaveTerrain>("save_terrain",
                            [&c, files](const SaveTerrainRequest& request, SaveTerrainResponse& response) {
                              save_terrain_folder(c, *files, request, response);
                            });
  services.add<ExportTerrain>(
      "export_terrain", [&c, files](const ExportTerrainRequest& request, ExportTerrainResponse& response) {
        export_terrain_files(c, *files, request, response);
      });
  services.add<LoadTerrain>(
      "load_terrain", [&c, loader](const LoadTerrainRequest& request, LoadTerrainResponse& response) {
        const std::string name = is_bag(request.name) ? request.name : request.name + "/" + terrain_file;
        response.state_hash =
            loader->load_scenario({c.files.for_reading(name), true, 0, request.fill_nodata != 0});
      });
  services.add<LoadScenario>(
      "load_scenario", [&c, loader](const LoadScenarioRequest& request, LoadScenarioResponse& response) {
        response.state_hash = loader->load_scenario(named_scenario(c.files, request));
      });
  services.add<SaveScenario>("save_scenario",
                             [&c, files](const SaveScenarioRequest& request, SaveScenarioResponse& response) {
                               save_scenario_folder(c, *files, request, response);
                             });
  services.add<NewScenario>("new_scenario",
                            [&c, loader](const NewScenarioRequest& request, NewScenarioResponse& response) {
                              response.state_hash = loader->load_scenario(new_scenario(c.files, request));
                            });
}

}  // namespace desert_sim
