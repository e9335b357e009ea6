#pragma once
/// The services of the node, each room of them in a file of its own. Each turns a request into a command, or
/// a question, and waits for the answer of the simulation thread. (~set_parameters is in reconfigure.cpp,
/// ~reload_parameters in reload_parameters.cpp.)

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "src/core/data_folder.hpp"
#include "src/ros/conversion/frames.hpp"
#include "src/ros/services/answer.hpp"
#include "src/ros/simulation/simulation_thread.hpp"
#include "src/ros/topics/topic_publisher.hpp"

namespace desert_sim {

/// What services work with.
struct ServiceContext {
  ros::NodeHandle node;
  /// Serves ~step apart from the other services: it can take long, and ~pause must not wait for it.
  ros::CallbackQueue& step_queue;
  SimulationThread& simulation;
  TopicPublisher& publisher;
  Frames& frames;
  const DataFolder& files;
  double answer_timeout;  ///< see SimulationThread::Patience; ~step waits for its steps [s]
};

class Services {
 public:
  /// Advertises all services.
  explicit Services(ServiceContext context);
  Services(const Services&) = delete;
  Services& operator=(const Services&) = delete;

  /// Where what add() is given finds the rest of the node.
  const ServiceContext& context() const { return context_; }

  /// After a command that has replaced the terrain: moves the frame in its middle, and publishes all topics.
  void terrain_replaced();

  /// Calls serve(request, response) for each request to ~`name`. What it refuses (ConfigError), or any other
  /// failure, becomes the answer success = false with the reason.
  template <class Service, class Serve>
  void add(const std::string& name, Serve serve, ros::CallbackQueue* queue = nullptr) {
    using Request = typename Service::Request;
    using Response = typename Service::Response;
    const boost::function<bool(Request&, Response&)> callback = [name, serve = std::move(serve),
                                                                 timeout = context_.answer_timeout](
                                                                    Request& request, Response& response) {
      const SimulationThread::Patience patience(timeout);
      return answer(name, response, [&] { serve(std::as_const(request), response); });
    };
    advertise(ros::AdvertiseServiceOptions::create<Service>(name, callback, ros::VoidConstPtr(), queue));
  }

  /// A service that answers in its own way.
  void advertise(ros::AdvertiseServiceOptions options) {
    servers_.push_back(context_.node.advertiseService(options));
  }

 private:
  ServiceContext context_;
  std::mutex move_center_mutex_;  ///< held while terrain_replaced() moves the frame
  std::vector<ros::ServiceServer> servers_;
};

// Each is defined in the file of its name: add_wind_services() in wind_services.cpp.
void add_wind_services(Services& services);  ///< ~set_wind, ~set_wind_schedule, ~edit_wind, ~set_weather
void add_edit_services(Services& services);  ///< ~edit_terrain, ~edit_plants, ~undo, ~redo
void add_map_services(Services& services);   ///< ~query_terrain, ~get_submap, ~get_grid_map
void add_run_services(Services& services);   ///< ~step, ~pause, ~resume, ~reset
/// ~save_*, ~load_* of checkpoints, terrains, scenarios; ~new_scenario, ~export_terrain
void add_file_services(Services& services);
void add_parameter_services(Services& services);  ///< ~apply_settings, ~get_scenario

}  // namespace desert_sim
