#pragma once
/// The node's private parameters, the scenario that it is to run, and the page that describes the parameters.

#include <ros/node_handle.h>

#include <string>

#include "src/core/parameter_table.hpp"
#include "src/ros/topics/publisher_parameters.hpp"
#include "src/scenario/scenario.hpp"
#include "src/simulation/undo/edit_history.hpp"

namespace desert_sim {

enum class BackendChoice : int { automatic, cpu, cuda };
constexpr const char* backend_choices[] = {"auto", "cpu", "cuda"};

/// Parameters of the node itself. Those of its topics are PublisherParameters and MapParameters.
struct NodeParameters {
  std::string scenario, script;
  bool all_raster_formats = false;
  std::string frame_id = "map";
  std::string center_frame = "~terrain_center";
  BackendChoice backend = BackendChoice::automatic;
  int threads = 0;
  int niceness = 10;
  double step_rate = 10;
  bool paused = false;
  std::string data_dir;
  std::string journal;
  double autosave_period = 0;
  bool resume = false;
  bool publish_clock = false;
  double diagnostic_period = 1;
  double answer_timeout = 1;
  double undo_memory = default_undo_memory / 1e6;
  int forecast_threads = 0;
};
constexpr auto parameter_table(const NodeParameters*) {
  using P = NodeParameters;
  return std::make_tuple(
      parameter("scenario", &P::scenario,
                "A file, or the bare name of one in the package's config/scenarios; empty: the scenario's "
                "sections are parameters."),
      parameter(
          "script", &P::script,
          "A YAML file with a list of what happens when, which is added to the scenario's run.timeline; "
          "empty: none."),
      parameter("all_raster_formats", &P::all_raster_formats,
                "Whether the rasters of this scenario may have every format that GDAL reads, also those that "
                "name other files or hosts (VRT, WMS, /vsi paths); never those of what services load."),
      parameter("frame_id", &P::frame_id, "Frame of the terrain."),
      parameter(
          "center_frame", &P::center_frame,
          "Static frame that is published in the middle of the terrain, for views; a leading ~ stands for "
          "the node's name and a slash; empty: none."),
      parameter("backend", &P::backend, backend_choices, "auto takes CUDA where it is usable."),
      parameter("threads", &P::threads, 0, 4096, "1", "Threads of the CPU backend; 0: one a processor."),
      parameter("niceness", &P::niceness, 0, 19, "1",
                "Of the simulation's threads, as in nice(1): on a busy machine publishing and subscribers "
                "come first."),
      parameter("step_rate", &P::step_rate, 0, 1e6, "steps/s",
                "In wall time, or ROS time under use_sim_time; 0: as fast as it can. Of no effect while the "
                "scenario's "
                "run.acceleration is above 0."),
      parameter("paused", &P::paused, "Whether it starts paused."),
      parameter(
          "data_dir", &P::data_dir,
          "Checkpoints lie below this folder; empty: desert_sim in ROS's own folder ($ROS_HOME, or ~/.ros)."),
      parameter("journal", &P::journal,
                "File for the journal of commands, whose folder is made where it is missing; a file of that "
                "name gets the ending .previous. Empty: none."),
      parameter("autosave_period", &P::autosave_period, 0, 1e9, "s",
                "Of wall time, from one checkpoint in ~data_dir/autosave to the next; 0: none."),
      parameter("resume", &P::resume, "Whether it starts with its newest autosave that is whole."),
      parameter(
          "publish_clock", &P::publish_clock,
          "Whether it publishes /clock: simulated time, divided by run.acceleration where that is above 0; "
          "it then follows wall time itself."),
      parameter("diagnostic_period", &P::diagnostic_period, 0.01, 1e6, "s",
                "Of wall time, from one message on /diagnostics to the next."),
      parameter(
          "answer_timeout", &P::answer_timeout, 0, 1e6, "s",
          "Of wall time: a service whose request has waited so long for a step or another request to end "
          "refuses it, and changes nothing. 0: it waits. ~step waits for its steps."),
      parameter(
          "undo_memory", &P::undo_memory, 0, 1e6, "MB",
          "Of 10^6 bytes, for what ~undo and ~redo can bring back; the oldest strokes are forgotten first. "
          "0: nothing is kept."),
      parameter("forecast_threads", &P::forecast_threads, 0, 4096, "1",
                "Threads of the CPU backend that make forecasts, of a niceness of 15; 0: one a "
                "processor."));
}
static_assert(table_is_complete<NodeParameters>());

struct NodeSetup {
  NodeParameters node;
  PublisherSetup publishers;
  Scenario scenario;  ///< not yet resolved
};

/// Reads all private parameters of `private_node`: those of the tables, the lists `grid_map_layers` and
/// `local_map_layers`, `settings` (a list of "path=value" for a scenario that is a file), and the sections of
/// a scenario. Sections that are given beside a file override the file's keys. Throws ConfigError that lists
/// all errors; an unknown parameter is one.
NodeSetup read_node_setup(const ros::NodeHandle& private_node);

/// The page of the parameters in markdown, from their tables: what `desert_sim_node --describe` prints, and
/// what config/node_parameters.md holds.
std::string describe_node_parameters();

}  // namespace desert_sim
