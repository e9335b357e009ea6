#include "src/ros/rover/rover_server.hpp"

#include <ros/console.h>
#include <ros/init.h>

#include <algorithm>

#include "src/client/ros_time.hpp"
#include "src/core/constants.hpp"
#include "src/core/number_text.hpp"
#include "src/ros/rover/rover_messages.hpp"
#include "src/rover/start_place.hpp"
#include "src/rover/state_file.hpp"
#include "src/rover/urdf.hpp"
#include "src/simulation/journal.hpp"

namespace desert_sim {

namespace {

constexpr std::uint32_t callback_threads = 2;
constexpr auto patience = std::chrono::milliseconds(50);
constexpr double longest_pause = 1;  // [s] of ROS time between two poses; what is more is left out

std::unique_ptr<RoverJournalWriter> start_journal(const RoverNodeParameters& p, const Rover& rover) {
  if (p.journal.empty()) return nullptr;
  make_way_for_journal(p.journal);
  return std::make_unique<RoverJournalWriter>(p.journal, rover, p.micro_relief);
}

SensorFrames sensor_frames(const RoverSetup& setup) {
  const SensorFrames names;
  return {setup.frame(names.base), setup.frame(names.lidar), setup.frame(names.camera),
          setup.frame(names.camera_optical)};
}

std::unique_ptr<SensorPublisher> make_sensors(const ros::NodeHandle& node, const RoverSetup& setup) {
  if (!setup.has_sensors()) return nullptr;
  SensorSetup sensors;
  sensors.lidar = setup.lidar;
  sensors.depth_camera = setup.depth_camera;
  sensors.media = setup.sensor_media;
  sensors.backend = setup.node.sensor_backend;
  sensors.threads = setup.node.sensor_threads;
  sensors.lockstep = setup.node.clock == RoverClock::lockstep;
  return std::make_unique<SensorPublisher>(node, sensors, sensor_frames(setup));
}

}  // namespace

RoverServer::RoverServer(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : node_(node),
      private_node_(private_node),
      setup_(read_rover_setup(private_node)),
      files_(setup_.node.data_dir),
      rover_(setup_.rover, setup_.wheel_ground, "parameters of " + private_node.getNamespace() + ": rover",
             {setup_.node.half_wet, setup_.node.saturated}),
      journal_(start_journal(setup_.node, rover_)),
      sensors_(make_sensors(node, setup_)),
      terrain_(setup_.node, setup_.has_sensors(),
               [this](const MapChange& change) {
                 // In lockstep sensors see the state that the rover drives on, which measure() gives them.
                 if (sensors_ && setup_.node.clock == RoverClock::ros)
                   sensors_->on_terrain(change.map, change.cells);
               }),
      publisher_(node, private_node, setup_),
      updater_(private_node, private_node, private_node.getNamespace()),
      spinner_(callback_threads, &queue_) {
  node_.setCallbackQueue(&queue_);
  private_node_.setCallbackQueue(&queue_);
  // What was advertised after that is no publisher, and roscpp ends a process that publishes by it. (ROS does
  // not come back: if it runs now, all above is.)
  if (ros::isShuttingDown()) throw Error("ROS is shutting down");
  if (setup_.node.tracks) tracks_ = std::make_unique<WheelTracks>(setup_);
  if (setup_.node.publish_description)
    node_.setParam("robot_description",
                   urdf_of(setup_.rover, setup_.lidar, setup_.depth_camera, setup_.frame("")));
  if (sensors_ && setup_.node.publish_tf) {
    std::vector<geometry_msgs::TransformStamped> mountings =
        sensor_transforms(sensor_frames(setup_), setup_.lidar, setup_.depth_camera);
    static_broadcaster_.sendTransform(mountings);
  }
  const boost::function<void(const geometry_msgs::TwistConstPtr&)> receive =
      [this](const geometry_msgs::TwistConstPtr& command) { receive_command(*command); };
  commands_ = node_.subscribe<geometry_msgs::Twist>("cmd_vel", 1, receive);
  advertise<DriveRover>("drive", &RoverServer::drive);
  advertise<SetRoverPose>("set_pose", &RoverServer::set_pose);
  advertise<std_srvs::Trigger>("reset", &RoverServer::reset);
  advertise<SaveRover>("save_state", &RoverServer::save_state);
  advertise<LoadRover>("load_state", &RoverServer::load_state);
  updater_.setHardwareID("desert_rover");
  updater_.add("rover", [this](auto& status) { diagnose(status); });
  updater_.add("terrain", [this](auto& status) { diagnose_terrain(status); });
  diagnostic_timer_ = private_node_.createWallTimer(ros::WallDuration(setup_.node.diagnostic_period),
                                                    [this](const ros::WallTimerEvent&) {
                                                      if (!is_near_the_last_time(ros::Time::now()))
                                                        updater_.force_update();
                                                    });
  publisher_.publish_status(status());
  spinner_.start();
  thread_ = std::thread([this] { run(); });
}

RoverServer::~RoverServer() {
  stopping_ = true;
  thread_.join();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    advanced_.notify_all();
  }
  spinner_.stop();
}

std::string RoverServer::failure() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_;
}

// ---- the thread that drives

void RoverServer::run() {
  try {
    setup_.node.clock == RoverClock::ros ? run_as_ros_time_passes() : run_in_lockstep();
  } catch (const std::exception& e) {
    const std::lock_guard<std::mutex> lock(mutex_);
    failure_ = limited_message(e.what());
    advanced_.notify_all();
  }
}

void RoverServer::run_as_ros_time_passes() {
  ros::Time last = ros::Time::now();
  auto due = std::chrono::steady_clock::now();
  const auto period = std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(1 / setup_.node.rate));
  while (!stopping_ && ros::ok()) {
    due = std::max(due + period, std::chrono::steady_clock::now());
    std::this_thread::sleep_until(due);
    const ros::Time now = ros::Time::now();
    if (now.isZero() || now == last) {  // nobody has told the time yet, or it stands still
      tell_status();
      continue;
    }
    const double seconds = last.isZero() ? 0 : std::clamp(seconds_between(last, now), 0.0, longest_pause);
    last = now;
    advance(seconds, terrain_.newest(), now);
  }
}

void RoverServer::tell_status() {
  const std::lock_guard<std::mutex> lock(mutex_);
  publisher_.publish_status(status());
}

void RoverServer::run_in_lockstep() {
  while (!stopping_ && ros::ok()) {
    const std::shared_ptr<const MapGround> ground = terrain_.next(patience);
    if (!ground) {
      tell_status();
      continue;
    }
    const double seconds = seconds_to(*ground);
    if (seconds >= 0) advance(seconds, ground, ground->maps().info().stamp);
  }
}

double RoverServer::seconds_to(const MapGround& ground) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const RoverState& state = rover_.state();
  const MapInfo& info = ground.maps().info();
  const double passed = info.sim_time - state.terrain_time;
  if (waits_for_loaded_step_ && (passed < 0 || info.step < state.terrain_step)) return -1;
  waits_for_loaded_step_ = false;
  if (!ground_ || passed < 0) return 0;
  const double seconds = passed * setup_.node.seconds_per_sim_second;
  if (seconds <= Rover::longest_advance) return seconds;
  ROS_WARN("The terrain's time jumped by %g s, which would be %g s of driving: the rover stays where it is.",
           passed, seconds);
  return 0;
}

void RoverServer::advance(double seconds, const std::shared_ptr<const MapGround>& ground,
                          const ros::Time& stamp) {
  std::unique_lock<std::mutex> lock(mutex_);
  ground_ = ground;
  if (ground && !rover_.state().placed) start_where_it_begins(*ground);
  const std::uint64_t ticks = rover_.state().ticks;
  rover_event::Advance event{seconds, std::nullopt, 0};
  std::string frame;
  if (ground) {
    const MapInfo& info = ground->maps().info();
    event.terrain = info.step;
    event.time = info.sim_time;
    frame = info.frame;
  }
  apply(event);
  publisher_.publish_pose(rover_, stamp, frame);
  if (sensors_ && ground && rover_.state().placed) measure(*ground, stamp, ticks);
  publisher_.publish_status(status());
  if (tracks_ && ground) {
    const Rover rover = rover_;
    const bool lockstep = setup_.node.clock == RoverClock::lockstep;
    if (!lockstep) lock.unlock();
    tracks_->follow(rover, ground->maps().info().cell_size);
  }
  advanced_.notify_all();
}

void RoverServer::measure(const MapGround& ground, const ros::Time& stamp, std::uint64_t ticks) {
  const RoverState& state = rover_.state();
  const geometry_msgs::Pose pose = pose_message(state.pose);
  sensors_->on_micro_relief(ground.micro_relief());
  if (setup_.node.clock == RoverClock::ros) {
    if (terrain_.want_sensor_layers(sensors_->has_subscribers())) sensors_->on_pose(stamp, pose);
    return;
  }
  const MapInfo& info = ground.maps().info();
  for (const std::shared_ptr<const LayerMap>& map : ground.maps().maps)
    if (map) sensors_->on_terrain(map, {0, 0, info.width, info.height});
  // By the rover's own time, which is part of its state, whatever the time of day is.
  const auto time = [](std::uint64_t n) { return static_cast<double>(n) * Rover::internal_step; };
  sensors_->on_pose(stamp, pose, SensorPublisher::TimeSpan{time(ticks), time(state.ticks)});
}

void RoverServer::start_where_it_begins(const MapGround& ground) {
  const MapInfo& info = ground.maps().info();
  const double yaw = setup_.node.yaw_deg * pi / 180, width = info.width * info.cell_size,
               height = info.height * info.cell_size;
  const StartArea area{info.origin_x + width / 2, info.origin_y + height / 2, width, height};
  const Start start = choose_start(rover_, area, setup_.node.x, setup_.node.y, yaw, ground);
  try {
    apply(rover_event::Place{start.place.x, start.place.y, yaw, true, info.step});
    start_problem_.clear();
    if (start.remark.empty()) return;
    const std::string text =
        "The rover starts at " + point_text(start.place.x, start.place.y) + " m: " + start.remark;
    if (start.is_bad)
      ROS_WARN("%s", text.c_str());
    else
      ROS_INFO("%s", text.c_str());
  } catch (const ConfigError& e) {
    if (start_problem_ != e.what()) ROS_ERROR("%s", e.what());
    start_problem_ = e.what();
  }
}

void RoverServer::apply(const RoverEvent& event) {
  desert_sim::apply(rover_, event, [this](std::uint64_t) -> const GroundSource& { return *ground_; });
  if (journal_) journal_->write(event);
}

// ---- commands

void RoverServer::receive_command(const geometry_msgs::Twist& m) {
  const std::lock_guard<std::mutex> lock(mutex_);
  try {
    apply(rover_event::Drive{{m.linear.x, m.linear.y, m.angular.z}, setup_.node.cmd_vel_timeout});
    refusal_.clear();
  } catch (const ConfigError& e) {
    ROS_WARN_THROTTLE(5, "cmd_vel: a message was refused: %s", e.what());
    refusal_ = "cmd_vel: " + std::string(e.what());
  }
  ++commands_received_;
  publisher_.publish_status(status());
}

// ---- what is told

RoverStatus RoverServer::status() const {
  RoverStatus m = status_message(rover_);
  m.header.stamp = ros::Time::now();
  m.refusal = refusal_;
  m.commands = commands_received_;
  m.terrain_connected = terrain_.connected();
  if (tracks_) m.tracks = tracks_->taken();
  if (ground_) {
    m.header.frame_id = ground_->maps().info().frame;
    m.terrain_stamp = ground_->maps().info().stamp;
  }
  if (!rover_.state().placed && !start_problem_.empty()) m.reason = start_problem_;
  return m;
}

void RoverServer::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using Level = diagnostic_msgs::DiagnosticStatus;
  const std::lock_guard<std::mutex> lock(mutex_);
  const RoverState& s = rover_.state();
  const char* const name = rover_conditions[static_cast<int>(s.condition)];
  const bool well = s.condition == RoverCondition::idle || s.condition == RoverCondition::driving;
  if (!failure_.empty())
    status.summary(Level::ERROR, failure_);
  else
    status.summary(well ? Level::OK : Level::WARN, well ? name : std::string(name) + ": " + s.reason);
  status.add("state", name);
  status.add("slip", s.slip);
  status.add("way commanded [m]", s.way_commanded);
  status.add("way made [m]", s.way_made);
  status.add("contact error [m]", s.contact_error);
}

void RoverServer::diagnose_terrain(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using Level = diagnostic_msgs::DiagnosticStatus;
  const bool connected = terrain_.connected();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!connected)
    status.summary(Level::WARN, "nobody publishes " + setup_.node.terrain_node + "/elevation");
  else if (!ground_)
    status.summary(Level::WARN, "no terrain has arrived yet");
  else
    status.summary(Level::OK, "the terrain is known");
  status.add("step", rover_.state().terrain_step);
  status.add("simulated time [s]", rover_.state().terrain_time);
  if (waits_for_loaded_step_)
    status.mergeSummary(Level::WARN, "the rover waits for the step of the state that was loaded");
}

}  // namespace desert_sim
