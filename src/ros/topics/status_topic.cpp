#include "src/ros/topics/status_topic.hpp"

#include <ros/node_handle.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <utility>

#include "src/core/hash_text.hpp"
#include "src/core/pace_text.hpp"
#include "src/ros/conversion/messages.hpp"

namespace desert_sim {

namespace {

const char* state_text(RunState state) {
  switch (state) {
    case RunState::running:
      return SimulationStatus::RUNNING.c_str();
    case RunState::paused:
      return SimulationStatus::PAUSED.c_str();
    case RunState::waiting:
      return SimulationStatus::WAITING.c_str();
  }
  throw Error("the run state is unknown");
}

SimulationStatusPtr status_message(const StatusReport& report, const std::string& frame) {
  SimulationStatusPtr message = boost::make_shared<SimulationStatus>();
  message->header = header_of(report.moment, frame);
  message->state = state_text(report.state);
  message->message = report.backend_choice;
  message->scenario = report.scenario;
  message->backend = report.backend;
  message->device = report.device;
  message->step = report.moment.step;
  message->sim_time = report.moment.time;
  message->time_step = report.time_step;
  message->parts = static_cast<std::uint32_t>(report.parts);
  message->acceleration = report.acceleration;
  message->pace = pace_text(report.acceleration, report.step_rate, report.time_step);
  message->step_rate = report.step_rate;
  message->steps_per_second = report.steps_per_second;
  message->lag = report.lag;
  for (const ProcessTime& time : report.process_times) {
    ProcessTiming row;
    row.process = time.process;
    row.milliseconds = time.milliseconds;
    message->process_times.push_back(row);
  }
  for (int m = 0; m < material_count; ++m) {
    const MaterialBalance& b = report.balance[static_cast<std::size_t>(m)];
    if (b.initial == 0 && b.final == 0 && b.in == 0 && b.out == 0) continue;
    MaterialVolume row;
    row.material = material_names[m];
    row.initial = b.cubic_metres(b.initial);
    row.final = b.cubic_metres(b.final);
    row.entered = b.cubic_metres(b.in);
    row.left = b.cubic_metres(b.out);
    row.residual = b.relative_residual();
    message->volumes.push_back(row);
  }
  message->changes = report.changes;
  message->wind_above = vector_of(report.wind_above);
  if (report.hashed) message->state_hash = hash_text(report.hash);
  message->undoable = static_cast<std::uint32_t>(report.undoable);
  message->redoable = static_cast<std::uint32_t>(report.redoable);
  message->snapshots = report.snapshots;
  return message;
}

}  // namespace

StatusTopic::StatusTopic(const TopicContext& context) : context_(context) {
  ros::NodeHandle node = context.node;
  publisher_ = node.advertise<SimulationStatus>("status", 10,
                                                [this](const ros::SingleSubscriberPublisher&) { request(); });
}

void StatusTopic::request() {
  const std::lock_guard<std::mutex> lock(context_.mutex);
  requested_ = true;
  context_.wake_up.notify_all();
}

bool StatusTopic::consume_request() { return std::exchange(requested_, false); }

void StatusTopic::rate_changed() { due_.period_changed(now(), period_of(rate())); }

void StatusTopic::publish(const StatusReport& report, std::uint64_t publications) {
  const SimulationStatusPtr message = status_message(report, context_.frames.terrain_frame());
  message->publications = publications;
  last_ = *message;
  const SteadyClock::time_point time = now();
  due_.published(time, time, period_of(rate()));
  publisher_.publish(message);
}

void StatusTopic::publish_failure(const std::string& reason) {
  last_.header.stamp = ros::Time::now();
  last_.header.frame_id = context_.frames.terrain_frame();
  last_.state = SimulationStatus::ERROR;
  last_.message = reason;
  last_.steps_per_second = 0;
  last_.state_hash.clear();
  if (!publisher_) return;  // the node was told to end while it started
  // A copy, because later failures change the last status while this message may still wait to be sent.
  publisher_.publish(boost::make_shared<SimulationStatus>(last_));
}

}  // namespace desert_sim
