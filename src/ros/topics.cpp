#include "desert_sim/ros/topics.hpp"

#include <ros/console.h>
#include <std_msgs/Empty.h>

#include <algorithm>

#include "desert_sim/ros/messages.hpp"
#include "desert_sim/ros/point_cloud.hpp"

namespace desert_sim {

namespace {

template <class Duration>
Duration period_of(double rate) {
  return rate > 0 ? std::chrono::duration_cast<Duration>(std::chrono::duration<double>(1 / rate))
                  : Duration::zero();
}

template <class Time, class Duration>
void next_time(Time& due, Duration period) {
  const Time now = Time::clock::now();
  due += period;
  if (due <= now) due = now + period;
}

/// Updates that may wait for a subscriber that is slow; whoever misses one asks for a keyframe. An update is
/// at most as large as the whole surface.
std::uint32_t update_queue(const Snapshot& terrain) {
  constexpr std::size_t longest = 100, shortest = 2, most_bytes = std::size_t{256} << 20;
  const std::size_t bytes =
      sizeof(float) * static_cast<std::size_t>(terrain.width) * static_cast<std::size_t>(terrain.height);
  return static_cast<std::uint32_t>(std::clamp(most_bytes / bytes, shortest, longest));
}

}  // namespace

// ---- the table of topics ----

Topics::Topics(ros::NodeHandle node, const PublisherParameters& parameters, const MapSetup& maps,
               const Frames& frames, SimulationThread& simulation)
    : node_(std::move(node)),
      frames_(frames),
      frame_(frames.terrain_frame()),
      simulation_(simulation),
      status_period_(period_of<Clock::duration>(parameters.status_rate)) {
  add_elevation(parameters);
  add_others(parameters);
  add_grid_map(maps);
  add_local_map(maps);
  add_costmap(maps.parameters);
  add_image(maps.parameters);
  status_ = advertise<SimulationStatus>("status", 10, [this] { status_changed(); });
  diff_ = node_.advertise<TerrainDiff>("terrain_diff", 100);
  thread_ = std::thread([this] { thread(); });
}

Topics::~Topics() { stop(); }

Topics::Topic& Topics::add(double rate, std::vector<Layer> layers) {
  topics_.push_back(std::make_unique<Topic>());
  topics_.back()->period = period_of<Clock::duration>(rate);
  topics_.back()->layers = std::move(layers);
  return *topics_.back();
}

void Topics::add_elevation(const PublisherParameters& p) {
  // Updates stand first: where both are due, the last update of the old keyframe goes out before the new one.
  Topic& updates = add(p.update_rate, {Layer::elevation});
  Topic& keyframes = add(p.keyframe_rate, {Layer::elevation});
  keyframes.publisher = advertise_terrain<ElevationGrid>("elevation", 1, keyframes);
  // Whoever begins to listen to updates needs a keyframe to write them over.
  updates.publisher = advertise_terrain<ElevationUpdate>(
      "elevation_updates", update_queue(*simulation_.terrain({}).get().snapshot), keyframes);
  elevation_ = std::make_unique<ElevationStream>(keyframes.publisher, updates.publisher, frame_,
                                                 p.update_threshold, p.update_tile);
  // roscpp has one connection a topic and process: those who share one are no new subscribers, and ask.
  keyframe_requests_ = node_.subscribe<std_msgs::Empty>(
      "request_keyframe", 1, [this, &keyframes](const std_msgs::Empty::ConstPtr&) { want(keyframes); });
  updates.publish = [this](const TerrainState& state) { return elevation_->publish_update(state); };
  keyframes.publish = [this](const TerrainState& state) {
    elevation_->publish_keyframe(state);
    return true;
  };
}

void Topics::add_others(const PublisherParameters& p) {
  Topic& wind = add(p.wind_rate, {Layer::wind_x, Layer::wind_y});
  wind.publisher = advertise_terrain<WindField>("wind", 1, wind);
  wind.publish = [this, &wind, decimation = p.wind_decimation](const TerrainState& state) {
    wind.publisher.publish(wind_message(state, frame_, decimation));
    return true;
  };
  Topic& markers = add(p.wind_markers_rate, wind_marker_layers());
  markers_ = std::make_unique<WindMarkers>(frame_, p.wind_markers_count);
  markers.publisher = advertise_terrain<visualization_msgs::MarkerArray>("wind_markers", 1, markers);
  markers.publish = [this, &markers](const TerrainState& state) {
    markers.publisher.publish(markers_->markers(state));
    return true;
  };
  Topic& points = add(p.points_rate, point_layers());
  points.publisher = advertise_terrain<sensor_msgs::PointCloud2>("points", 1, points);
  points.publish = [this, &points, count = p.points_count](const TerrainState& state) {
    points.publisher.publish(point_cloud(state, frame_, count));
    return true;
  };
}

// ---- from other threads ----

void Topics::notify() {
  if (!listens_to_changes_ && !simulation_.failed()) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  woken_.notify_all();
}

void Topics::want(Topic& topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  topic.wanted = true;
  woken_.notify_all();
}

void Topics::status_changed() {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_wanted_ = true;
  woken_.notify_all();
}

void Topics::publish_now() {
  std::unique_lock<std::mutex> lock(mutex_);
  const std::uint64_t mine = ++asked_;
  woken_.notify_all();
  served_some_.wait(lock, [&] { return served_ >= mine || stopping_ || !failure_.empty(); });
}

void Topics::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    woken_.notify_all();
    served_some_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

std::string Topics::failure() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_;
}

std::map<std::string, std::string> Topics::problems() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return problems_;
}

std::vector<TopicRate> Topics::rates() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<TopicRate> rates;
  for (const auto& topic : topics_) {
    const double wanted =
        topic->period.count() > 0 ? 1 / std::chrono::duration<double>(topic->period).count() : 0.0;
    rates.push_back({topic->name(), wanted, topic->meter.rate(steady_now()), topic->subscribers()});
  }
  return rates;
}

// ---- on the publishing thread ----

void Topics::set_problem(const std::string& topic, const std::string& problem) {
  if (!problem.empty()) ROS_WARN_THROTTLE(30, "%s: %s", topic.c_str(), problem.c_str());
  const std::lock_guard<std::mutex> lock(mutex_);
  if (problem.empty()) {
    problems_.erase(topic);
  } else {
    problems_[topic] = problem;
  }
}

void Topics::thread() {
  std::string failure;
  try {
    loop();
  } catch (const std::exception& e) {
    // The simulation refuses to answer once it has ended.
    if (!simulation_.ended()) failure = std::string("publishing failed: ") + e.what();
  }
  if (simulation_.failed()) failure = simulation_.failure();
  if (!failure.empty()) keep_telling(failure);
}

/// Until the end, to everybody who comes.
void Topics::keep_telling(const std::string& failure) {
  publish_failure(failure);
  std::unique_lock<std::mutex> lock(mutex_);
  failure_ = failure;
  served_some_.notify_all();
  status_wanted_ = false;
  while (!stopping_) {
    woken_.wait(lock, [this] { return stopping_ || status_wanted_; });
    if (!status_wanted_) continue;
    status_wanted_ = false;
    lock.unlock();
    publish_failure(failure);
    lock.lock();
  }
}

void Topics::loop() {
  bool all, status;
  std::uint64_t asked;
  while (wait(all, status, asked)) {
    const std::vector<Topic*> due = ready_ones(topics_that_are_due(all));
    if (!due.empty()) publish_terrain(due);
    if (status_.getNumSubscribers() > 0 &&
        (status || all || (status_period_.count() > 0 && Clock::now() >= status_due_)))
      publish_status();
    const std::lock_guard<std::mutex> lock(mutex_);
    served_ = asked;
    served_some_.notify_all();
  }
}

bool Topics::wait(bool& all, bool& status, std::uint64_t& asked) {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_ && !simulation_.failed()) {
    Clock::time_point next = Clock::now() + std::chrono::seconds(1);
    bool listen = false;
    listens_to_changes_ = true;  // before looking at what has changed, so that no change is missed
    if (asked_ != served_ || status_wanted_ || something_is_due(next, listen)) {
      listens_to_changes_ = false;
      all = asked_ != served_;
      asked = asked_;
      status = status_wanted_;
      status_wanted_ = false;
      return true;
    }
    listens_to_changes_ = listen;
    woken_.wait_until(lock, next);
  }
  return false;
}

/// Else `next` becomes the time at which to look again, and `listen` says whether to look after each change.
bool Topics::something_is_due(Clock::time_point& next, bool& listen) {
  const Clock::time_point now = Clock::now();
  for (const auto& topic : topics_) {
    if (!topic->has_subscribers()) {
      topic->wanted = false;
      continue;
    }
    if (topic->wanted || topic->terrain != simulation_.terrains()) return true;
    if (topic->period.count() == 0) continue;
    if (topic->due > now) {
      next = std::min(next, topic->due);
    } else {
      if (topic->follows || topic->change != simulation_.changes()) return true;
      listen = true;
    }
  }
  if (status_period_.count() > 0 && status_.getNumSubscribers() > 0) {
    if (status_due_ <= now) return true;
    next = std::min(next, status_due_);
  }
  return false;
}

std::vector<Topics::Topic*> Topics::topics_that_are_due(bool all) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Clock::time_point now = Clock::now();
  std::vector<Topic*> due;
  for (const auto& topic : topics_) {
    if (!topic->has_subscribers()) continue;
    const bool changed = topic->change != simulation_.changes();
    const bool by_rate = topic->period.count() > 0 && now >= topic->due && (changed || topic->follows);
    const bool at_once = all && changed && !(topic->covered && topic->covered());
    if (topic->wanted || topic->terrain != simulation_.terrains() || at_once || by_rate)
      due.push_back(topic.get());
    topic->wanted = false;
  }
  return due;
}

/// The others wait for their next time.
std::vector<Topics::Topic*> Topics::ready_ones(const std::vector<Topic*>& due) {
  std::vector<Topic*> ready;
  for (Topic* topic : due) {
    if (!topic->ready || topic->ready()) {
      ready.push_back(topic);
    } else {
      topic->change = simulation_.changes();
      topic->terrain = simulation_.terrains();
      next_time(topic->due, topic->period);
    }
  }
  return ready;
}

void Topics::publish_terrain(const std::vector<Topic*>& due) {
  std::vector<Layer> layers;
  for (const Topic* topic : due)
    for (Layer layer : topic->layers)
      if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
  const TerrainState state = simulation_.terrain(layers).get();
  for (Topic* topic : due) {
    if (topic->publish(state)) {
      ++publications_;
      const std::lock_guard<std::mutex> lock(mutex_);
      topic->meter.count(steady_now());
    }
    topic->change = state.moment.change;
    topic->terrain = state.moment.terrain;
    next_time(topic->due, topic->period);
  }
}

void Topics::publish_status() {
  const SimulationStatusPtr message = status_message(simulation_.report().get(), frame_);
  message->publications = publications_;
  last_status_ = *message;
  status_.publish(message);
  next_time(status_due_, status_period_);
}

void Topics::publish_failure(const std::string& what) {
  last_status_.header.stamp = ros::Time::now();
  last_status_.header.frame_id = frame_;
  last_status_.state = SimulationStatus::ERROR;
  last_status_.message = what;
  last_status_.steps_per_second = 0;
  last_status_.state_hash.clear();
  status_.publish(boost::make_shared<SimulationStatus>(last_status_));  // which later ones do not change
}

}  // namespace desert_sim
