/// The services of RoverServer.
#include <desert_sim/Step.h>
#include <ros/console.h>

#include <chrono>

#include "include/desert_sim/client/service_call.hpp"
#include "src/core/files.hpp"
#include "src/core/hash_text.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/ros/rover/rover_messages.hpp"
#include "src/ros/rover/rover_server.hpp"
#include "src/ros/services/answer.hpp"
#include "src/rover/state_file.hpp"

namespace desert_sim {

template <class Service>
void RoverServer::advertise(const std::string& name,
                            void (RoverServer::*serve)(const typename Service::Request&,
                                                       typename Service::Response&)) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Request&, Response&)> callback = [this, name, serve](Request& request,
                                                                                  Response& response) {
    return answer(name, response, [&] { (this->*serve)(request, response); });
  };
  servers_.push_back(private_node_.advertiseService<Request, Response>(name, callback));
}
template void RoverServer::advertise<DriveRover>(const std::string&,
                                                 void (RoverServer::*)(const DriveRoverRequest&,
                                                                       DriveRoverResponse&));
template void RoverServer::advertise<SetRoverPose>(const std::string&,
                                                   void (RoverServer::*)(const SetRoverPoseRequest&,
                                                                         SetRoverPoseResponse&));
template void RoverServer::advertise<std_srvs::Trigger>(const std::string&,
                                                        void (RoverServer::*)(const std_srvs::TriggerRequest&,
                                                                              std_srvs::TriggerResponse&));
template void RoverServer::advertise<SaveRover>(const std::string&,
                                                void (RoverServer::*)(const SaveRoverRequest&,
                                                                      SaveRoverResponse&));
template void RoverServer::advertise<LoadRover>(const std::string&,
                                                void (RoverServer::*)(const LoadRoverRequest&,
                                                                      LoadRoverResponse&));

void RoverServer::catch_up() {
  if (setup_.node.clock == RoverClock::ros) return;
  const std::string service = setup_.node.terrain_node + "/step";
  Step now;
  now.request.steps = 0;
  if (!call_service(service, now))
    throw ConfigError("the terrain is not there: " + service + " does not answer");
  if (!now.response.success) throw ConfigError("the terrain does not tell its step: " + now.response.message);
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(setup_.node.answer_timeout);
  std::unique_lock<std::mutex> lock(mutex_);
  while (!(ground_ && rover_.state().terrain_step == now.response.step &&
           rover_.state().terrain_time == now.response.sim_time) ||
         waits_for_loaded_step_) {
    if (stopping_) throw ConfigError("the rover is ending");
    if (!failure_.empty()) throw ConfigError(failure_);
    if (advanced_.wait_until(lock, std::chrono::time_point_cast<std::chrono::steady_clock::duration>(end)) ==
        std::cv_status::timeout)
      throw ConfigError("the rover has not come to step " + std::to_string(now.response.step) +
                        " of the terrain within " + std::to_string(setup_.node.answer_timeout) +
                        " s (it is at step " + std::to_string(rover_.state().terrain_step) + ")");
  }
}

const MapGround& RoverServer::known_ground() const {
  if (!ground_)
    throw ConfigError("the rover has no terrain yet: " + setup_.node.terrain_node + " has not sent any");
  return *ground_;
}

void RoverServer::drive(const DriveRoverRequest& request, DriveRoverResponse& response) {
  catch_up();
  const std::lock_guard<std::mutex> lock(mutex_);
  known_ground();
  response.terrain_step = rover_.state().terrain_step;
  response.state_hash = hash_text(hash_of(rover_.state()));
  constexpr double for_ever = 1e9;
  const geometry_msgs::Twist& t = request.twist;
  apply(rover_event::Drive{{t.linear.x, t.linear.y, t.angular.z},
                           request.seconds == 0 ? for_ever : request.seconds});
}

void RoverServer::set_pose(const SetRoverPoseRequest& request, SetRoverPoseResponse& response) {
  catch_up();
  const std::lock_guard<std::mutex> lock(mutex_);
  known_ground();
  apply(rover_event::Place{request.pose.x, request.pose.y, request.pose.theta, false,
                           rover_.state().terrain_step});
  response.reached = pose_message(rover_.state().pose);
}

void RoverServer::reset(const std_srvs::TriggerRequest&, std_srvs::TriggerResponse& response) {
  {
    // A state that was loaded may belong to another step than the terrain's, which no longer matters.
    const std::lock_guard<std::mutex> lock(mutex_);
    waits_for_loaded_step_ = false;
    if (ground_) {
      const MapInfo& info = ground_->maps().info();
      apply(rover_event::Advance{0, info.step, info.sim_time});
    }
  }
  catch_up();
  const std::lock_guard<std::mutex> lock(mutex_);
  start_where_it_begins(known_ground());
  if (!start_problem_.empty()) throw ConfigError(start_problem_);
  response.message = "the rover is at its start";
}

void RoverServer::save_state(const SaveRoverRequest& request, SaveRoverResponse& response) {
  catch_up();
  std::unique_lock<std::mutex> lock(mutex_);
  const std::string bytes = rover_state_bytes(rover_);
  response.terrain_step = rover_.state().terrain_step;
  response.state_hash = hash_text(hash_of(rover_.state()));
  lock.unlock();
  const WritableFile file = files_.for_writing(request.name);
  file.write([&bytes](const std::string& path) { write_file(path, bytes); });
  response.path = file.path();
}

void RoverServer::load_state(const LoadRoverRequest& request, LoadRoverResponse& response) {
  const std::string path = files_.for_reading(request.name);
  const std::lock_guard<std::mutex> lock(mutex_);
  Rover loaded = rover_;
  load_rover(path, loaded, files_.path());
  apply(rover_event::SetState{rover_state_bytes(loaded)});
  const RoverState& state = rover_.state();
  waits_for_loaded_step_ = setup_.node.clock == RoverClock::lockstep &&
                           !(ground_ && ground_->maps().info().step == state.terrain_step);
  response.terrain_step = state.terrain_step;
  response.state_hash = hash_text(hash_of(state));
}

}  // namespace desert_sim
