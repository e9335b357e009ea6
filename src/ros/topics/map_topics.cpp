/// The topics that show the terrain as maps: ~grid_map, ~local_map, ~costmap, ~image.
#include <image_transport/image_transport.h>

#include <boost/make_shared.hpp>

#include "src/io/snapshots.hpp"
#include "src/ros/conversion/grid_map_message.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/ros/topics/map_cut.hpp"
#include "src/ros/topics/topics.hpp"

namespace desert_sim {

namespace {

const std::vector<Layer> picture_layers{Layer::elevation, Layer::sand, Layer::vegetation,  Layer::obstacle,
                                        Layer::water,     Layer::soil, Layer::wind_shadow, Layer::plants};

sensor_msgs::ImagePtr picture_message(const TerrainState& state, const std::string& frame) {
  const cv::Mat picture = hillshade_picture(picture_of(*state.snapshot));
  sensor_msgs::ImagePtr message = boost::make_shared<sensor_msgs::Image>();
  message->header = header_of(state.moment, frame);
  message->width = static_cast<std::uint32_t>(picture.cols);
  message->height = static_cast<std::uint32_t>(picture.rows);
  message->encoding = "bgr8";
  message->step = 3 * message->width;
  message->data.reserve(static_cast<std::size_t>(message->step) * message->height);
  for (int row = 0; row < picture.rows; ++row) {
    const std::uint8_t* first = picture.ptr<std::uint8_t>(row);
    message->data.insert(message->data.end(), first, first + message->step);
  }
  return message;
}

}  // namespace

bool Topics::publish_cut(const Topic& topic, const std::string& name, const std::vector<MapLayer>& layers,
                         int decimation, const std::function<MapWindow(const Snapshot&)>& choose) {
  std::string problem;
  try {
    const MapCut cut = cut_terrain(simulation_, layers, [&](const Snapshot& terrain) {
      const MapWindow window = choose(terrain);
      require_moderate(window, layers.size(), name);
      return window;
    });
    topic.publisher.publish(
        boost::make_shared<GridMap>(grid_map(cut.state, frame_, layers, cut.window, decimation)));
  } catch (const ConfigError& e) {
    problem = e.what();
  }
  set_problem(name, problem);
  return problem.empty();
}

void Topics::add_grid_map() {
  const MapSetup& maps = parameters_.maps;
  const MapParameters& p = maps.parameters;
  const auto whole = [&p] { return p.grid_map_length_x == 0; };
  Topic& topic = add(p.grid_map_rate, [&maps, whole] {
    return whole() ? terrain_layers(maps.grid_map_layers) : std::vector<Layer>();
  });
  topic.publisher = advertise_terrain<GridMap>("grid_map", 1, topic);
  topic.publish = [this, &topic, &maps, &p, whole](const TerrainState& state) {
    if (!whole())
      return publish_cut(
          topic, "grid_map", maps.grid_map_layers, p.grid_map_decimation, [&p](const Snapshot& terrain) {
            return window_of({p.grid_map_x, p.grid_map_y, p.grid_map_length_x, p.grid_map_length_y}, terrain);
          });
    topic.publisher.publish(boost::make_shared<GridMap>(
        grid_map(state, frame_, maps.grid_map_layers, whole_window(*state.snapshot), p.grid_map_decimation)));
    return true;
  };
}

void Topics::add_local_map() {
  const MapSetup& maps = parameters_.maps;
  const MapParameters& p = maps.parameters;
  Topic& topic = add(p.local_map_rate, std::vector<Layer>());
  topic.publisher = advertise_terrain<GridMap>("local_map", 1, topic);
  topic.follows = true;
  topic.ready = [this, &p] {
    tf2::Transform robot;
    std::string why;
    const bool found = frames_.latest_to_terrain(p.robot_frame, robot, why);
    if (!found) set_problem("local_map", why);
    return found;
  };
  topic.publish = [this, &topic, &maps, &p](const TerrainState&) {
    return publish_cut(topic, "local_map", maps.local_map_layers, 1, [this, &p](const Snapshot& terrain) {
      tf2::Transform robot;
      std::string why;
      if (!frames_.latest_to_terrain(p.robot_frame, robot, why)) throw ConfigError(why);
      return window_of(
          {robot.getOrigin().x(), robot.getOrigin().y(), p.local_map_length_x, p.local_map_length_y},
          terrain);
    });
  };
}

void Topics::add_costmap() {
  const MapParameters& p = parameters_.maps.parameters;
  // In the order of ~elevation's, and for its reason.
  Topic& updates = add(p.costmap_update_rate, std::vector<Layer>());
  Topic& keyframes = add(p.costmap_keyframe_rate, std::vector<Layer>());
  // move_base has two costmaps in one process, of which the second waits for a map and is no new subscriber
  // to us. roscpp hands it the last message there was, but only of a topic that somebody advertises as
  // latched.
  costmap_is_latched_ = node_.advertise<nav_msgs::OccupancyGrid>("costmap", 1, true);
  keyframes.publisher = advertise_named<nav_msgs::OccupancyGrid>("costmap", 1, keyframes, keyframes);
  updates.publisher =
      advertise_named<map_msgs::OccupancyGridUpdate>("costmap_updates", 10, updates, keyframes);
  costmap_ = std::make_unique<CostmapStream>(keyframes.publisher, updates.publisher, frame_);
  keyframes.covered = [&updates, &keyframes] { return keyframes.names.are_among(updates.names); };
  updates.besides = [this](StateQuery& held) { costmap_->ask_for_update(held.costs); };
  keyframes.besides = [](StateQuery& held) { held.costs.whole = true; };
  updates.publish = [this](const TerrainState& state) { return costmap_->publish_update(state); };
  keyframes.publish = [this](const TerrainState& state) {
    costmap_->publish_keyframe(state);
    return true;
  };
}

void Topics::add_image() {
  Topic& topic = add(parameters_.maps.parameters.image_rate, picture_layers);
  topic.image = image_transport::ImageTransport(node_).advertise(
      "image", 1, [this, &topic](const image_transport::SingleSubscriberPublisher&) { want(topic); });
  topic.publish = [this, &topic](const TerrainState& state) {
    topic.image.publish(picture_message(state, frame_));
    return true;
  };
}

}  // namespace desert_sim
