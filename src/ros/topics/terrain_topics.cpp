/// The topics that show the terrain as it is: ~elevation and its updates, ~wind, ~wind_markers, ~points,
/// ~water_points, ~plants, ~plant_markers.
#include <std_msgs/Empty.h>

#include <algorithm>

#include "src/ros/conversion/messages.hpp"
#include "src/ros/conversion/point_cloud.hpp"
#include "src/ros/topics/topics.hpp"

namespace desert_sim {

namespace {

/// Updates that may wait for a subscriber that is slow; whoever misses one asks for a keyframe. An update is
/// at most about as large as the whole surface.
std::uint32_t update_queue(const Snapshot& terrain) {
  constexpr std::size_t longest = 100, shortest = 2, most_bytes = std::size_t{256} << 20;
  const std::size_t bytes =
      sizeof(float) * static_cast<std::size_t>(terrain.width) * static_cast<std::size_t>(terrain.height);
  return static_cast<std::uint32_t>(std::clamp(most_bytes / bytes, shortest, longest));
}

}  // namespace

Topic& Topics::add(const double& rate, std::function<std::vector<Layer>()> layers) {
  topics_.push_back(std::make_unique<Topic>());
  topics_.back()->rate = &rate;
  topics_.back()->layers = std::move(layers);
  return *topics_.back();
}

Topic& Topics::add(const double& rate, const std::vector<Layer>& layers) {
  return add(rate, [layers] { return layers; });
}

void Topics::add_elevation() {
  // Updates stand first: where both are due, the last update of the old keyframe goes out before the new one.
  Topic& updates = add(parameters_.topics.update_rate, std::vector<Layer>());
  Topic& keyframes = add(parameters_.topics.keyframe_rate, {Layer::elevation});
  keyframes.publisher = advertise_named<ElevationGrid>("elevation", 1, keyframes, keyframes);
  // Whoever begins to listen to updates needs a keyframe to write them over.
  updates.publisher = advertise_named<ElevationUpdate>(
      "elevation_updates", update_queue(*simulation_.terrain({}).get().snapshot), updates, keyframes);
  elevation_ = std::make_unique<ElevationStream>(keyframes.publisher, updates.publisher, frame_);
  keyframes.covered = [&updates, &keyframes] { return keyframes.names.are_among(updates.names); };
  // roscpp has one connection a topic and process: those who share one are no new subscribers, and ask.
  keyframe_requests_ = node_.subscribe<std_msgs::Empty>(
      "request_keyframe", 1, [this, &keyframes](const std_msgs::Empty::ConstPtr&) { want(keyframes); });
  updates.besides = [this](StateQuery& held) { elevation_->ask_for_update(held); };
  keyframes.besides = [this](StateQuery& held) { elevation_->ask_for_keyframe(held); };
  updates.publish = [this](const TerrainState& state) { return elevation_->publish_update(state); };
  keyframes.publish = [this](const TerrainState& state) {
    elevation_->publish_keyframe(state);
    return true;
  };
}

void Topics::add_wind() {
  Topic& wind = add(parameters_.topics.wind_rate, {Layer::wind_x, Layer::wind_y});
  wind.publisher = advertise_terrain<WindField>("wind", 1, wind);
  wind.publish = [this, &wind](const TerrainState& state) {
    wind.publisher.publish(wind_message(state, frame_, parameters_.topics.wind_decimation));
    return true;
  };
  Topic& markers = add(parameters_.topics.wind_markers_rate, wind_marker_layers());
  markers_ = std::make_unique<WindMarkers>(frame_);
  markers.publisher = advertise_terrain<visualization_msgs::MarkerArray>("wind_markers", 1, markers);
  markers.publish = [this, &markers](const TerrainState& state) {
    markers.publisher.publish(markers_->markers(state, parameters_.topics.wind_markers_count));
    return true;
  };
}

void Topics::add_points() {
  Topic& points = add(parameters_.topics.points_rate, point_layers());
  points.publisher = advertise_terrain<sensor_msgs::PointCloud2>("points", 1, points);
  points.publish = [this, &points](const TerrainState& state) {
    points.publisher.publish(point_cloud(state, frame_, parameters_.topics.points_count));
    return true;
  };
  Topic& water = add(parameters_.topics.water_points_rate, water_point_layers());
  water.publisher = advertise_terrain<sensor_msgs::PointCloud2>("water_points", 1, water);
  water.publish = [this, &water](const TerrainState& state) {
    water.publisher.publish(water_cloud(state, frame_, parameters_.topics.points_count));
    return true;
  };
}

void Topics::add_plants() {
  const auto ask = [](StateQuery& besides) { besides.plants = true; };
  Topic& plants = add(parameters_.topics.plants_rate, std::vector<Layer>());
  plants.publisher = advertise_terrain<Plants>("plants", 1, plants);
  plants.besides = ask;
  plants.publish = [this, &plants](const TerrainState& state) {
    plants.publisher.publish(plants_message(state, frame_, parameters_.topics.plants_count));
    return true;
  };
  Topic& markers = add(parameters_.topics.plant_markers_rate, std::vector<Layer>());
  plant_markers_ = std::make_unique<PlantMarkers>(frame_);
  markers.publisher = advertise_terrain<visualization_msgs::MarkerArray>("plant_markers", 1, markers);
  markers.besides = ask;
  markers.publish = [this, &markers](const TerrainState& state) {
    markers.publisher.publish(plant_markers_->markers(state, parameters_.topics.plant_markers_count));
    return true;
  };
}

}  // namespace desert_sim
