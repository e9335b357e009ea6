#include "desert_sim/ros/reconfigure.hpp"

#include <dynamic_reconfigure/ConfigDescription.h>
#include <ros/console.h>
#include <ros/serialization.h>

#include <utility>

#include "desert_sim/ros/reconfigure_messages.hpp"

namespace desert_sim {

namespace {

constexpr double look_every = 0.2;  // [s]

bool same(const dynamic_reconfigure::Config& a, const dynamic_reconfigure::Config& b) {
  const ros::SerializedMessage x = ros::serialization::serializeMessage(a),
                               y = ros::serialization::serializeMessage(b);
  return x.num_bytes == y.num_bytes && std::equal(x.buf.get(), x.buf.get() + x.num_bytes, y.buf.get());
}

}  // namespace

Reconfigure::Reconfigure(ros::NodeHandle node, SimulationThread& simulation, Topics& topics)
    : simulation_(simulation), topics_(topics) {
  const Scenario scenario = simulation_.scenario().get();
  descriptions_ = node.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", 1, true);
  updates_ = node.advertise<dynamic_reconfigure::Config>("parameter_updates", 1, true);
  descriptions_.publish(boost::make_shared<dynamic_reconfigure::ConfigDescription>(
      reconfigure_description(scenario, simulation_.step_rate())));
  publish(scenario);
  service_ = node.advertiseService("set_parameters", &Reconfigure::set, this);
  timer_ =
      node.createWallTimer(ros::WallDuration(look_every), [this](const ros::WallTimerEvent&) { look(); });
}

/// In their order, and without the lock across a publish.
void Reconfigure::publish(const Scenario& scenario) {
  const auto values =
      boost::make_shared<dynamic_reconfigure::Config>(reconfigure_values(scenario, simulation_.step_rate()));
  std::unique_lock<std::mutex> lock(mutex_);
  if (same(*values, published_)) return;
  published_ = *values;
  to_publish_ = values;
  if (publishing_) return;  // whoever does so now takes this one too
  publishing_ = true;
  while (to_publish_) {
    const dynamic_reconfigure::ConfigConstPtr next = std::exchange(to_publish_, nullptr);
    lock.unlock();
    updates_.publish(next);
    lock.lock();
  }
  publishing_ = false;
}

bool Reconfigure::set(Request& request, Response& response) {
  try {
    const double rate = reconfigure_step_rate(request.config, simulation_.step_rate());
    const Settings settings = reconfigure_settings(request.config, simulation_.scenario().get());
    if (!settings.empty()) {
      simulation_.apply(command::SetParameters{settings}).get();
      topics_.status_changed();
    }
    if (rate != simulation_.step_rate()) simulation_.set_step_rate(rate).get();
    const Scenario present = simulation_.scenario().get();
    response.config = reconfigure_values(present, simulation_.step_rate());
    publish(present);
    return true;
  } catch (const Error& e) {
    ROS_WARN("%s", e.what());  // its answer has no place for a reason
    return false;
  }
}

/// Other commands change the wind, and a reset or a checkpoint everything.
void Reconfigure::look() {
  const std::uint64_t commands = simulation_.commands();
  const double rate = simulation_.step_rate();
  if (commands == seen_ && rate == seen_rate_) return;
  try {
    publish(simulation_.scenario().get());
    seen_ = commands;
    seen_rate_ = rate;
  } catch (const Error&) {
    // The simulation is ending, or has failed, which ~status tells.
  }
}

}  // namespace desert_sim
