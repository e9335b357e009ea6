/// A subscriber of the publishing benchmark and the soak test: a TerrainClient in a process of its own, as a
/// planner would have one. Reads lines from its standard input: "on" subscribes, "on, with bytes" does so and
/// counts the bytes of messages, "report" prints as one line of JSON what came in since the last report,
/// "off" unsubscribes, the end ends it.
#include <ros/ros.h>

#include <iostream>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "include/desert_sim/client/terrain_client.hpp"

namespace {

using desert_sim::ElevationGrid;
using desert_sim::ElevationUpdate;
using desert_sim::MapChange;
using desert_sim::TerrainClient;

class Watch {
 public:
  explicit Watch(bool counts_bytes) {
    TerrainClient::Options options;
    options.on_change = [this](const MapChange& change) { take(change); };
    client_ = std::make_unique<TerrainClient>(ros::NodeHandle(), options);
    if (!counts_bytes) return;
    updates_ = ros::NodeHandle().subscribe<ElevationUpdate>(
        "desert_sim/elevation_updates", 200, [this](const ElevationUpdate::ConstPtr& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          if (!message->tiles.empty())
            update_bytes_.push_back(ros::serialization::serializationLength(*message));
        });
    keyframes_ = ros::NodeHandle().subscribe<ElevationGrid>(
        "desert_sim/elevation", 1, [this](const ElevationGrid::ConstPtr& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          keyframe_bytes_ = ros::serialization::serializationLength(*message);
        });
  }

  ~Watch() {
    updates_.shutdown();
    keyframes_.shutdown();
    client_.reset();  // it calls take()
  }

  std::string report() {
    const TerrainClient::Statistics now = client_->statistics();
    const auto since = [&](const char* name, std::uint64_t TerrainClient::Statistics::*count) {
      return "\"" + std::string(name) + "\": " + std::to_string(now.*count - last_.*count) + ", ";
    };
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::string text = "{" + since("keyframes", &TerrainClient::Statistics::keyframes) +
                             since("updates", &TerrainClient::Statistics::updates) +
                             since("gaps", &TerrainClient::Statistics::gaps) +
                             since("refused", &TerrainClient::Statistics::refused) +
                             "\"update_bytes\": " + list(update_bytes_) +
                             ", \"keyframe_bytes\": " + std::to_string(keyframe_bytes_) +
                             ", \"latencies\": " + list(latencies_) + "}";
    last_ = now;
    update_bytes_.clear();
    latencies_.clear();
    return text;
  }

 private:
  /// On the client's thread, once the map can be read. Keyframes have sequence 0.
  void take(const MapChange& change) {
    if (change.map->info().sequence == 0) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    latencies_.push_back((ros::WallTime::now() - ros::WallTime(change.map->info().stamp.toSec())).toSec());
  }
  template <class Number>
  static std::string list(const std::vector<Number>& numbers) {
    std::string text;
    for (const Number number : numbers) text += (text.empty() ? "" : ", ") + std::to_string(number);
    return "[" + text + "]";
  }

  std::mutex mutex_;
  std::vector<double> latencies_;  ///< from a state being reached to its being readable here, of updates [s]
  std::vector<std::uint32_t> update_bytes_;
  std::uint32_t keyframe_bytes_ = 0;
  TerrainClient::Statistics last_;  ///< at the last report
  ros::Subscriber updates_, keyframes_;
  std::unique_ptr<TerrainClient> client_;
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "publishing_subscriber", ros::init_options::AnonymousName);
  const ros::NodeHandle node;  // without any, ROS would end between two subscriptions
  ros::AsyncSpinner spinner(1);
  spinner.start();
  std::unique_ptr<Watch> watch;
  for (std::string line; std::getline(std::cin, line);) {
    if (line == "on" || line == "on, with bytes") watch = std::make_unique<Watch>(line != "on");
    if (line == "report" && watch) std::cout << watch->report() << std::endl;
    if (line == "off") watch.reset();
  }
  return 0;
}
