#pragma once
/// The list of the topics that show the terrain. A new topic takes a class in a file of its own, its line in
/// the list below, and its parameters in publisher_parameters.hpp.

#include <memory>
#include <vector>

#include "src/ros/topics/topic.hpp"

namespace desert_sim {

using TopicList = std::vector<std::unique_ptr<Topic>>;

// Each is defined in the file of its name: add_wind_topics() in wind_topic.cpp.
void add_elevation_topics(const TopicContext& context, TopicList& topics);  // in layer_topics.cpp
void add_layer_topics(const TopicContext& context, TopicList& topics);
void add_wind_topics(const TopicContext& context, TopicList& topics);
void add_wind_features_topic(const TopicContext& context, TopicList& topics);
void add_wind_markers_topic(const TopicContext& context, TopicList& topics);
void add_points_topics(const TopicContext& context, TopicList& topics);
void add_plants_topics(const TopicContext& context, TopicList& topics);
void add_grid_map_topic(const TopicContext& context, TopicList& topics);
void add_local_map_topic(const TopicContext& context, TopicList& topics);
void add_costmap_topics(const TopicContext& context, TopicList& topics);
void add_image_topic(const TopicContext& context, TopicList& topics);
void add_micro_relief_topic(const TopicContext& context, TopicList& topics);
void add_appearance_topic(const TopicContext& context, TopicList& topics);
void add_particle_paths_topic(const TopicContext& context, TopicList& topics);

/// All topics, in the order in which those that are due at the same time are published.
inline TopicList make_topics(const TopicContext& context) {
  TopicList topics;
  add_elevation_topics(context, topics);      // ~elevation_updates, ~elevation
  add_layer_topics(context, topics);          // ~layers/<name>_updates, ~layers/<name>
  add_micro_relief_topic(context, topics);    // ~micro_relief
  add_wind_topics(context, topics);           // ~wind, ~wind_array
  add_wind_features_topic(context, topics);   // ~wind_features
  add_wind_markers_topic(context, topics);    // ~wind_markers
  add_points_topics(context, topics);         // ~points, ~water_points
  add_plants_topics(context, topics);         // ~plants, ~plant_markers
  add_grid_map_topic(context, topics);        // ~grid_map
  add_local_map_topic(context, topics);       // ~local_map
  add_costmap_topics(context, topics);        // ~costmap_updates, ~costmap
  add_image_topic(context, topics);           // ~image
  add_appearance_topic(context, topics);      // ~appearance
  add_particle_paths_topic(context, topics);  // ~particle_paths
  return topics;
}

}  // namespace desert_sim
