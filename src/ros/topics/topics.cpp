#include "src/ros/topics/topics.hpp"

#include <pthread.h>
#include <ros/console.h>

#include <algorithm>

#include "src/ros/conversion/messages.hpp"

namespace desert_sim {

Topics::Topics(ros::NodeHandle node, const PublisherSetup& parameters, const Frames& frames,
               SimulationThread& simulation)
    : node_(std::move(node)),
      frames_(frames),
      frame_(frames.terrain_frame()),
      simulation_(simulation),
      parameters_(parameters) {
  add_elevation();
  add_wind();
  add_points();
  add_plants();
  add_grid_map();
  add_local_map();
  add_costmap();
  add_image();
  status_ = advertise<SimulationStatus>("status", 10, [this] { status_changed(); });
  diff_ = node_.advertise<TerrainDiff>("terrain_diff", 100);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    adopt(parameters);
  }
  thread_ = std::thread([this] { thread(); });
}

Topics::~Topics() { stop(); }

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

void Topics::set_parameters(const PublisherSetup& parameters) {
  const std::lock_guard<std::mutex> lock(mutex_);
  new_parameters_ = parameters;
  ++parameter_changes_;
  woken_.notify_all();
}

PublisherSetup Topics::parameters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return new_parameters_ ? *new_parameters_ : parameters_;
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
  for (const auto& topic : topics_)
    rates.push_back({topic->name(), *topic->rate, topic->meter.rate(steady_now()), topic->subscribers()});
  return rates;
}

// ---- on the publishing thread ----

void Topics::adopt(const PublisherSetup& parameters) {
  parameters_ = parameters;
  const PublisherParameters& p = parameters_.topics;
  const MapParameters& maps = parameters_.maps.parameters;
  elevation_->configure(p.update_threshold, p.update_tile);
  costmap_->configure(maps.costmap_update_rate, maps.costmap_update_threshold);
  for (const auto& topic : topics_) topic->rate_changed();
  status_due_ = std::min(status_due_, SteadyClock::now() + period_of(p.status_rate));
}

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
  pthread_setname_np(pthread_self(), "publishing");  // for top -H and profilers
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
        (status || all || (parameters_.topics.status_rate > 0 && SteadyClock::now() >= status_due_)))
      publish_status();
    const std::lock_guard<std::mutex> lock(mutex_);
    served_ = asked;
    served_some_.notify_all();
  }
}

bool Topics::wait(bool& all, bool& status, std::uint64_t& asked) {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_ && !simulation_.failed()) {
    if (new_parameters_) adopt(*new_parameters_);
    new_parameters_.reset();
    SteadyClock::time_point next = SteadyClock::now() + std::chrono::seconds(1);
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
bool Topics::something_is_due(SteadyClock::time_point& next, bool& listen) {
  for (const auto& topic : topics_) {
    if (!topic->has_subscribers()) {
      topic->wanted = false;
      continue;
    }
    if (topic->due_at_once(simulation_) || topic->due_by_rate(simulation_)) return true;
    if (*topic->rate == 0) continue;
    if (topic->due > SteadyClock::now())
      next = std::min(next, topic->due);
    else
      listen = true;
  }
  if (parameters_.topics.status_rate > 0 && status_.getNumSubscribers() > 0) {
    if (status_due_ <= SteadyClock::now()) return true;
    next = std::min(next, status_due_);
  }
  return false;
}

std::vector<Topic*> Topics::topics_that_are_due(bool all) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Topic*> due;
  for (const auto& topic : topics_) {
    if (!topic->has_subscribers()) continue;
    const bool shows_change = all && topic->changed(simulation_) && !(topic->covered && topic->covered());
    if (shows_change || topic->due_at_once(simulation_) || topic->due_by_rate(simulation_))
      due.push_back(topic.get());
    topic->wanted = false;
  }
  return due;
}

/// The others wait for their next time.
std::vector<Topic*> Topics::ready_ones(const std::vector<Topic*>& due) {
  std::vector<Topic*> ready;
  for (Topic* topic : due) {
    if (!topic->ready || topic->ready()) {
      ready.push_back(topic);
    } else {
      topic->shown(simulation_.changes(), simulation_.terrains());
    }
  }
  return ready;
}

void Topics::publish_terrain(const std::vector<Topic*>& due) {
  std::vector<Layer> layers;
  StateQuery held;
  for (const Topic* topic : due) {
    if (topic->besides) topic->besides(held);
    for (Layer layer : topic->layers())
      if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
  }
  const TerrainState state = simulation_.terrain(layers, {}, held).get();
  for (Topic* topic : due) {
    if (topic->publish(state)) {
      ++publications_;
      const std::lock_guard<std::mutex> lock(mutex_);
      topic->meter.count(steady_now());
    }
    topic->shown(state.moment.change, state.moment.terrain);
  }
}

void Topics::publish_status() {
  const SimulationStatusPtr message = status_message(simulation_.report().get(), frame_);
  message->publications = publications_;
  last_status_ = *message;
  status_.publish(message);
  next_time(status_due_, period_of(parameters_.topics.status_rate));
}

void Topics::publish_failure(const std::string& what) {
  last_status_.header.stamp = ros::Time::now();
  last_status_.header.frame_id = frame_;
  last_status_.state = SimulationStatus::ERROR;
  last_status_.message = what;
  last_status_.steps_per_second = 0;
  last_status_.state_hash.clear();
  if (!status_) return;                                                 // ended while it started
  status_.publish(boost::make_shared<SimulationStatus>(last_status_));  // which later ones do not change
}

}  // namespace desert_sim
