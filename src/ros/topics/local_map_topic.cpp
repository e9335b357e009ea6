/// ~local_map: layers of the terrain around the robot, as a grid_map_msgs/GridMap.

#include <boost/make_shared.hpp>

#include "src/ros/conversion/grid_map_message.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

class LocalMapTopic : public MessageTopic<GridMap> {
 public:
  explicit LocalMapTopic(const TopicContext& context) : MessageTopic(context, "local_map") {}
  double rate() const override { return map().local_map_rate; }
  /// The robot moves, even if the terrain does not change.
  bool only_after_change() const override { return false; }
  /// There must be a transform from the robot's frame to the terrain's.
  bool ready() override {
    tf2::Transform robot;
    std::string reason;
    const bool found = context().frames.latest_to_terrain(map().robot_frame, robot, reason);
    if (!found) set_problem(reason);
    return found;
  }
  bool publish(const TerrainState&) override {
    return publish_or_set_problem([this] {
      const std::vector<MapLayer>& layers = parameters().maps.local_map_layers;
      if (map().local_map_resolution > 0) {
        const MicroReliefCut cut = cut_micro_relief(context().simulation, layers, short_name(),
                                                    region_around_robot(), map().local_map_resolution);
        return publisher_.publish(
            boost::make_shared<GridMap>(grid_map(cut.state, frame(), layers, cut.window)));
      }
      const MapCut cut =
          cut_terrain(context().simulation, layers, short_name(),
                      [this](const Snapshot& terrain) { return window_of(region_around_robot(), terrain); });
      publisher_.publish(boost::make_shared<GridMap>(grid_map(cut.state, frame(), layers, cut.window)));
    });
  }

 private:
  const MapParameters& map() const { return parameters().maps.parameters; }

  MapRegion region_around_robot() const {
    tf2::Transform robot;
    std::string reason;
    if (!context().frames.latest_to_terrain(map().robot_frame, robot, reason)) throw ConfigError(reason);
    return {robot.getOrigin().x(), robot.getOrigin().y(), map().local_map_length_x, map().local_map_length_y};
  }
};

}  // namespace

void add_local_map_topic(const TopicContext& context, TopicList& topics) {
  topics.push_back(std::make_unique<LocalMapTopic>(context));
}

}  // namespace desert_sim
