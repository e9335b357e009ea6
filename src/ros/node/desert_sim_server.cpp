#include "src/ros/node/desert_sim_server.hpp"

#include <ros/console.h>

#include <algorithm>
#include <cmath>

#include "src/core/log.hpp"
#include "src/grid_map/grid_map_bag.hpp"
#include "src/scenario/scenario_file.hpp"

namespace desert_sim {

namespace {

constexpr std::uint32_t threads = 4, step_threads = 2;

SimulationThread::Options options_of(const NodeParameters& p) {
  SimulationThread::Options options;
  options.backend = backend_choices[static_cast<int>(p.backend)];
  options.threads = p.threads;
  options.niceness = p.niceness;
  options.step_rate = p.step_rate;
  options.paused = p.paused;
  options.journal = p.journal;
  options.undo_memory = static_cast<std::size_t>(p.undo_memory * 1e6);
  return options;
}

void log_to_ros(Severity severity, const std::string& message) {
  if (severity == Severity::warning)
    ROS_WARN("%s", message.c_str());
  else
    ROS_ERROR("%s", message.c_str());
}

/// Whether the path begins with the folder; a path that leads out of it again is for InputFile to refuse.
bool begins_with_folder(const std::string& path, const std::string& folder) {
  return !folder.empty() && path.compare(0, folder.size() + 1, folder + "/") == 0;
}

/// Reads the rasters of the node's own scenario wherever they lie, and all others below the data folder or
/// beside the installed scenarios, in the allowed formats, only.
RasterLoader node_raster_loader(const NodeSetup& setup, const DataFolder& files) {
  return [own = raster_paths(setup.scenario),
          load_own = raster_loader_with_bags({"", setup.node.all_raster_formats}),
          load_other = raster_loader_with_bags({files.path(), false})](const RasterRequest& request) {
    if (std::count(own.begin(), own.end(), request.path) > 0) return load_own(request);
    if (const std::string& installed = installed_scenario_folder();
        begins_with_folder(request.path, installed))
      return raster_loader_with_bags({installed, false})(request);
    return load_other(request);
  };
}

/// Logs what runs. Points and markers in rviz are single precision, which resolves a centimetre at 1e5 m.
void log_start(const Scenario& scenario, const std::string& backend) {
  const GridParameters& grid = scenario.grid;
  ROS_INFO("The scenario %s was loaded: %d x %d cells of %g m. Backend: %s.", scenario.name.c_str(),
           grid.width, grid.height, grid.cell_size, backend.c_str());
  const RunParameters& run = scenario.run;
  if (run.acceleration > 0)
    ROS_INFO(
        "run.acceleration: %g simulated seconds per second, in %g steps of %g s. step_rate has no effect.",
        run.acceleration, run.acceleration / run.time_step, run.time_step);
  const double farthest = std::max(std::abs(grid.origin_x), std::abs(grid.origin_y));
  if (farthest > 1e5)
    ROS_WARN(
        "The terrain extends to %.0f m from the origin of its frame: float32 coordinates (~points, markers) "
        "have a resolution of only %.2f m there. The display desert_sim/Terrain is exact under the Fixed "
        "Frame of "
        "~center_frame.",
        farthest, farthest * 6e-8);
}

}  // namespace

DesertSimServer::DesertSimServer(const ros::NodeHandle& private_node, const MonotonicClock& clock)
    : node_(private_node), spinner_(threads, &queue_), step_spinner_(step_threads, &step_queue_) {
  node_.setCallbackQueue(&queue_);
  set_log_sink(log_to_ros);
  NodeSetup setup = read_node_setup(node_);
  const NodeParameters& p = setup.node;
  resolve_grid(setup.scenario, raster_loader_with_bags({"", p.all_raster_formats}));
  check_map_sizes(setup.publishers.maps, setup.scenario.grid);
  make_way_for_journal(p.journal);
  files_ = std::make_unique<DataFolder>(p.data_dir);
  frames_ = std::make_unique<Frames>(p.frame_id);
  SimulationThread::Options options = options_of(p);
  options.clock = &clock;
  if (p.publish_clock) {
    clock_ = std::make_unique<ClockPublisher>();
    if (!ros::Time::isSimTime())
      ROS_WARN("publish_clock is true, but use_sim_time is not: no node follows /clock.");
    options.publish_clock = [this](double seconds) { clock_->publish(seconds); };
  }
  const AutosaveFiles autosaves(*files_, node_.getNamespace(), setup.scenario);
  if (p.resume) options.resume_from = autosaves.paths();
  if (p.resume && options.resume_from.empty())
    ROS_INFO(
        "resume is true, but no autosave was found: the simulation starts at the beginning of the scenario.");
  options.data_folder = files_->path();
  simulation_ =
      std::make_unique<SimulationThread>(setup.scenario, node_raster_loader(setup, *files_), options, [this] {
        if (TopicPublisher* publisher = publisher_to_notify_) publisher->notify();
      });
  log_start(simulation_->scenario().get(), simulation_->backend_choice());
  if (!p.center_frame.empty())
    frames_->announce_center(p.center_frame, *simulation_->terrain({Layer::elevation}).get().snapshot);
  publisher_ = std::make_unique<TopicPublisher>(node_, setup.publishers, *frames_, *simulation_);
  publisher_to_notify_ = publisher_.get();
  try {
    services_ = std::make_unique<Services>(
        ServiceContext{node_, step_queue_, *simulation_, *publisher_, *frames_, *files_, p.answer_timeout});
    if (p.autosave_period > 0)
      autosave_ = std::make_unique<Autosave>(autosaves, p.autosave_period, *simulation_, p.journal);
    forecast_ = std::make_unique<ForecastServer>(node_, *simulation_, *publisher_, *frames_,
                                                 p.forecast_threads, p.answer_timeout);
    diagnostics_ = std::make_unique<Diagnostics>(node_, p.diagnostic_period, *simulation_, *publisher_,
                                                 *forecast_, autosave_.get());
    cmd_wind_ = std::make_unique<CmdWindSubscriber>(node_, *simulation_, *frames_);
    reconfigure_ = std::make_unique<Reconfigure>(node_, *simulation_, *publisher_, p.answer_timeout);
    reload_ = std::make_unique<ParameterReload>(
        node_, setup, *simulation_, *publisher_, [this](const Scenario& scenario) {
          if (autosave_) autosave_->set_files(AutosaveFiles(*files_, node_.getNamespace(), scenario));
        });
    spinner_.start();
    step_spinner_.start();
  } catch (...) {
    simulation_->stop();  // it must not notify a publisher that is gone
    throw;
  }
}

DesertSimServer::~DesertSimServer() {
  // First what others wait for, so that they get their answers; then what waited.
  simulation_->stop();
  publisher_->stop();
  forecast_->stop();
  spinner_.stop();
  step_spinner_.stop();
  reload_.reset();
  reconfigure_.reset();
  cmd_wind_.reset();
  diagnostics_.reset();
  forecast_.reset();
  autosave_.reset();
  services_.reset();
  publisher_.reset();
}

}  // namespace desert_sim
