#include "src/ros/node/reconfigure.hpp"

#include <ros/console.h>
#include <ros/serialization.h>

#include <utility>

#include "src/ros/support/service_with_reason.hpp"

namespace desert_sim {

namespace {

constexpr double check_period = 0.2;  // [s]

bool same(const dynamic_reconfigure::Config& a, const dynamic_reconfigure::Config& b) {
  const ros::SerializedMessage x = ros::serialization::serializeMessage(a),
                               y = ros::serialization::serializeMessage(b);
  return x.num_bytes == y.num_bytes && std::equal(x.buf.get(), x.buf.get() + x.num_bytes, y.buf.get());
}

}  // namespace

Reconfigure::Reconfigure(ros::NodeHandle node, SimulationThread& simulation, TopicPublisher& publisher,
                         double answer_timeout)
    : simulation_(simulation), publisher_(publisher), answer_timeout_(answer_timeout) {
  const LiveParameters defaults = present();
  descriptions_ = {node, "parameter_descriptions", 1};
  updates_ = {node, "parameter_updates", 1};
  if (!descriptions_ || !updates_) return;  // ROS is shutting down and advertises nothing any more
  descriptions_.publish(reconfigure_description(defaults));
  publish(reconfigure_values(defaults));
  auto options = service_with_reason<dynamic_reconfigure::Reconfigure>(
      "set_parameters", [this](const Request& request, Response& response) {
        try {
          set(request, response);
        } catch (const Error& e) {
          ROS_WARN("%s", e.what());  // the client of dynamic_reconfigure keeps the reason from its user
          throw;
        }
      });
  service_ = node.advertiseService(options);
  timer_ = node.createWallTimer(ros::WallDuration(check_period),
                                [this](const ros::WallTimerEvent&) { publish_if_changed(); });
}

LiveParameters Reconfigure::present() const {
  return {simulation_.scenario().get(), publisher_.parameters(), simulation_.step_rate()};
}

/// Publishes in the order of calls, and without holding the mutex while it does.
void Reconfigure::publish(const dynamic_reconfigure::Config& values) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (same(values, published_)) return;
  published_ = values;
  to_publish_ = boost::make_shared<dynamic_reconfigure::Config>(values);
  if (publishing_) return;  // the thread that is publishing takes these values too
  publishing_ = true;
  while (to_publish_) {
    const dynamic_reconfigure::ConfigConstPtr next = std::exchange(to_publish_, nullptr);
    lock.unlock();
    updates_.publish(next);
    lock.lock();
  }
  publishing_ = false;
}

void Reconfigure::set(const Request& request, Response& response) {
  const SimulationThread::Patience patience(answer_timeout_);
  const LiveChange change = reconfigure_change(request.config, present());
  // First what can still be refused.
  if (!change.settings.empty()) {
    simulation_.apply(command::SetParameters{change.settings}).get();
    publisher_.status_changed();
  }
  const SimulationThread::Patience unlimited(
      0);  // some of it has been applied, and nothing else can be refused
  if (change.step_rate != simulation_.step_rate()) simulation_.set_step_rate(change.step_rate).get();
  publisher_.set_parameters(change.publishers);
  response.config = reconfigure_values(present());
  publish(response.config);
}

/// Parameters change not only by set(): commands change the wind, a reset or a checkpoint everything, and
/// ~reload_parameters anything.
void Reconfigure::publish_if_changed() {
  const std::uint64_t commands = simulation_.commands(), publishers = publisher_.parameter_changes();
  const double rate = simulation_.step_rate();
  if (commands == seen_commands_ && publishers == seen_publishers_ && rate == seen_rate_) return;
  try {
    publish(reconfigure_values(present()));
    seen_commands_ = commands;
    seen_publishers_ = publishers;
    seen_rate_ = rate;
  } catch (const Error&) {
    // The simulation is ending, or has failed, which ~status says.
  }
}

}  // namespace desert_sim
