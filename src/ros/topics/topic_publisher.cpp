#include "src/ros/topics/topic_publisher.hpp"

#include <pthread.h>

#include <algorithm>

namespace desert_sim {

TopicPublisher::TopicPublisher(const ros::NodeHandle& node, const PublisherSetup& parameters,
                               const Frames& frames, SimulationThread& simulation)
    : simulation_(simulation),
      parameters_(parameters),
      context_{node, simulation, frames, parameters_, mutex_, wake_up_},
      status_(context_),
      topics_(make_topics(context_)),
      thread_([this] { run_thread(); }) {}

TopicPublisher::~TopicPublisher() { stop(); }

// ---- From other threads.

void TopicPublisher::notify() {
  if (!listens_to_changes_ && !simulation_.failed()) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  wake_up_.notify_all();
}

void TopicPublisher::publish_now(double patience) {
  std::unique_lock<std::mutex> lock(mutex_);
  const std::uint64_t mine = ++requests_;
  wake_up_.notify_all();
  const auto served = [&] { return served_ >= mine || stopping_ || !failure_.empty(); };
  if (patience > 0)
    served_changed_.wait_for(lock, std::chrono::duration<double>(patience), served);
  else
    served_changed_.wait(lock, served);
}

void TopicPublisher::set_parameters(const PublisherSetup& parameters) {
  const std::lock_guard<std::mutex> lock(mutex_);
  new_parameters_ = parameters;
  ++parameter_changes_;
  wake_up_.notify_all();
}

PublisherSetup TopicPublisher::parameters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return new_parameters_ ? *new_parameters_ : parameters_;
}

void TopicPublisher::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    wake_up_.notify_all();
    served_changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

std::string TopicPublisher::failure() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_;
}

std::map<std::string, std::string> TopicPublisher::problems() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::map<std::string, std::string> problems;
  for (const auto& topic : topics_)
    if (!topic->problem().empty()) problems[topic->short_name()] = topic->problem();
  return problems;
}

std::vector<TopicRate> TopicPublisher::rates() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<TopicRate> rates;
  for (const auto& topic : topics_) rates.push_back(topic->measured_rate());
  return rates;
}

// ---- On the publishing thread.

void TopicPublisher::run_thread() {
  pthread_setname_np(pthread_self(), "publishing");  // for top -H and profilers
  std::string failure;
  try {
    publish_until_stopped();
  } catch (const std::exception& e) {
    // The simulation refuses to answer once it has ended.
    if (!simulation_.ended()) failure = std::string("publishing failed: ") + e.what();
  }
  if (simulation_.failed()) failure = simulation_.failure();
  if (!failure.empty()) repeat_failure_status(failure);
}

void TopicPublisher::publish_until_stopped() {
  while (const std::optional<Work> work = wait_for_work()) {
    const std::vector<Topic*> due = ready_topics(due_topics(work->all_changes));
    if (!due.empty()) publish_topics(due, work->all_changes);
    publish_status_if_due(*work);
    const std::lock_guard<std::mutex> lock(mutex_);
    served_ = work->request;
    served_changed_.notify_all();
  }
}

std::optional<TopicPublisher::Work> TopicPublisher::wait_for_work() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_ && !simulation_.failed()) {
    apply_new_parameters();
    const MonotonicClock& clock = simulation_.clock();
    SteadyClock::time_point next = clock.now() + std::chrono::seconds(1);
    bool listen = false;
    listens_to_changes_ = true;  // before looking at what has changed, so that no change is missed
    if (requests_ != served_ || status_.is_requested() || any_topic_is_due(next, listen)) {
      listens_to_changes_ = false;
      return Work{requests_ != served_, status_.consume_request(), requests_};
    }
    listens_to_changes_ = listen;
    clock.wait_until(wake_up_, lock, next);
  }
  return std::nullopt;
}

/// The caller holds the mutex.
void TopicPublisher::apply_new_parameters() {
  if (!new_parameters_) return;
  parameters_ = *new_parameters_;
  new_parameters_.reset();
  for (const auto& topic : topics_) topic->rate_changed();
  status_.rate_changed();
}

/// If nothing is due, `next` becomes the time at which to look again, and `listen` says whether to look after
/// each change too. The caller holds the mutex.
bool TopicPublisher::any_topic_is_due(SteadyClock::time_point& next, bool& listen) {
  for (const auto& topic : topics_) {
    if (!topic->has_subscribers()) {
      topic->drop_request();
      topic->release();
      continue;
    }
    if (topic->is_due()) return true;
    if (!topic->follows_rate()) continue;
    listen = listen || topic->listens();
    const SteadyClock::time_point wake = topic->wake_time();
    if (wake > simulation_.clock().now()) next = std::min(next, wake);
  }
  if (status_.rate() > 0 && status_.has_subscribers()) {
    if (status_.is_due_by_rate()) return true;
    next = std::min(next, status_.due_time());
  }
  return false;
}

std::vector<Topic*> TopicPublisher::due_topics(bool all_changes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Topic*> due;
  for (const auto& topic : topics_) {
    if (!topic->has_subscribers()) continue;
    if ((all_changes && topic->has_unpublished_change()) || topic->is_due()) due.push_back(topic.get());
    topic->drop_request();
  }
  return due;
}

/// Those of `due` that can be published now; the others wait for their next due time.
std::vector<Topic*> TopicPublisher::ready_topics(const std::vector<Topic*>& due) {
  std::vector<Topic*> ready;
  for (Topic* topic : due) {
    if (topic->ready()) {
      ready.push_back(topic);
    } else {
      topic->mark_published(simulation_.changes(), simulation_.terrains(), simulation_.clock().now());
    }
  }
  return ready;
}

/// Publishes one state, which has what all of these need.
void TopicPublisher::publish_topics(const std::vector<Topic*>& due, bool all_changes) {
  const SteadyClock::time_point begin = simulation_.clock().now();
  std::vector<Layer> layers;
  StateQuery query;
  for (Topic* topic : due) {
    topic->add_to(query);
    for (Layer layer : topic->layers())
      if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
  }
  const TerrainState state = simulation_.terrain(layers, {}, query).get();
  for (Topic* topic : due) {
    if (all_changes ? topic->publish_all(state) : topic->publish(state)) {
      ++publications_;
      topic->count_message();
    }
    topic->mark_published(state.moment.change, state.moment.terrain, begin);
  }
}

void TopicPublisher::publish_status_if_due(const Work& work) {
  if (status_.has_subscribers() && (work.status || work.all_changes || status_.is_due_by_rate()))
    status_.publish(simulation_.report().get(), publications_);
}

/// Publishes the failure at once, and to each new subscriber until the node ends.
void TopicPublisher::repeat_failure_status(const std::string& failure) {
  status_.publish_failure(failure);
  std::unique_lock<std::mutex> lock(mutex_);
  failure_ = failure;
  served_changed_.notify_all();
  status_.consume_request();
  while (!stopping_) {
    wake_up_.wait(lock, [this] { return stopping_ || status_.is_requested(); });
    if (!status_.consume_request()) continue;
    lock.unlock();
    status_.publish_failure(failure);
    lock.lock();
  }
}

}  // namespace desert_sim
