#include "src/ros/services/services.hpp"

namespace desert_sim {

Services::Services(ServiceContext context) : context_(std::move(context)) {
  add_wind_services(*this);
  add_edit_services(*this);
  add_map_services(*this);
  add_run_services(*this);
  add_file_services(*this);
  add_parameter_services(*this);
}

void Services::terrain_replaced() {
  const SimulationThread::Patience unlimited(0);  // it has been done, and cannot be refused any more
  if (context_.frames.has_center()) {
    // One thread at a time, each with a copy of its own: the last one that moves the frame has seen the
    // newest terrain.
    const std::lock_guard<std::mutex> lock(move_center_mutex_);
    context_.frames.move_center(*context_.simulation.terrain({Layer::elevation}).get().snapshot);
  }
  context_.publisher.publish_now(context_.answer_timeout);
}

}  // namespace desert_sim
