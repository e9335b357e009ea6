/// ~plants and ~plant_markers: the plants one by one, as data and as triangles for rviz.

#include <desert_sim/Plants.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <array>
#include <boost/make_shared.hpp>
#include <cmath>

#include "src/render/colour.hpp"
#include "src/render/plant_shapes.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

using plants::PlantRecord;
using visualization_msgs::Marker;

std::vector<std::size_t> widest_plants(const std::vector<PlantRecord>& plants, int count) {
  std::vector<float> radii;
  radii.reserve(plants.size());
  for (const PlantRecord& plant : plants) radii.push_back(plant.radius);
  return render::widest_plants(radii, static_cast<std::size_t>(count));
}

/// Adds the triangles of a plant to a marker.
void draw(const PlantRecord& plant, const PlantList& list, const ViewFrame& frame, bool detailed,
          Marker& marker) {
  std::vector<render::Point> corners;
  render::add_plant({list.origin_x + plant.x - frame.x, list.origin_y + plant.y - frame.y, plant.z - frame.z,
                     plant.radius, list.species[plant.species].traits.stem, plant.health / 255.0},
                    detailed, corners);
  for (const render::Point& corner : corners) {
    geometry_msgs::Point p;
    p.x = corner.x();
    p.y = corner.y();
    p.z = corner.z();
    marker.points.push_back(p);
  }
}

Marker base_marker(const TerrainState& state, const std::string& frame, const std::string& species, int id) {
  Marker m;
  m.header = header_of(state.moment, frame);
  m.ns = species;
  m.id = id;
  m.type = Marker::TRIANGLE_LIST;
  m.action = Marker::ADD;
  m.pose.orientation.w = 1;
  m.scale.x = m.scale.y = m.scale.z = 1;
  m.color.a = 1;
  return m;
}

std_msgs::ColorRGBA crown_colour_of(const Species& species) {
  const render::Colour crown = render::crown_colour(species.appearance.hue);
  std_msgs::ColorRGBA colour;
  colour.r = crown.r;
  colour.g = crown.g;
  colour.b = crown.b;
  colour.a = 1;
  return colour;
}

/// At most `count` plants, the widest ones, in the order of the list.
PlantsPtr plants_message(const TerrainState& state, const std::string& frame, int count) {
  const PlantList& list = *state.plants;
  const auto message = boost::make_shared<Plants>();
  message->header = header_of(state.moment, frame);
  message->step = list.step;
  message->sim_time = list.time;
  message->origin.position.x = list.origin_x;
  message->origin.position.y = list.origin_y;
  message->origin.orientation.w = 1;
  for (const Species& species : list.species) {
    PlantSpecies row;
    row.name = species.name;
    row.stem = species.traits.stem;
    row.root = species.traits.root;
    row.max_radius = species.traits.max_radius;
    row.mature_radius = species.traits.maturity_share * species.traits.max_radius;
    row.hue = species.appearance.hue;
    message->species.push_back(row);
  }
  message->total = list.plants.size();
  const bool all = list.plants.size() <= static_cast<std::size_t>(count);
  const std::vector<std::size_t> chosen =
      all ? std::vector<std::size_t>() : widest_plants(list.plants, count);
  const std::size_t sent = all ? list.plants.size() : chosen.size();
  for (auto* column : {&message->x, &message->y, &message->z, &message->radius}) column->resize(sent);
  for (auto* column : {&message->species_index, &message->health}) column->resize(sent);
  for (std::size_t n = 0; n < sent; ++n) {
    const PlantRecord& plant = list.plants[all ? n : chosen[n]];
    message->x[n] = plant.x;
    message->y[n] = plant.y;
    message->z[n] = plant.z;
    message->radius[n] = plant.radius;
    message->species_index[n] = static_cast<std::uint8_t>(plant.species);
    message->health[n] = static_cast<std::uint8_t>(plant.health);
  }
  return message;
}

class PlantsTopic : public MessageTopic<Plants> {
 public:
  explicit PlantsTopic(const TopicContext& context) : MessageTopic(context, "plants") {}
  double rate() const override { return parameters().topics.plants_rate; }
  void add_to(StateQuery& query) override { query.plants = true; }

  bool publish(const TerrainState& state) override {
    publisher_.publish(plants_message(state, frame(), parameters().topics.plants_count));
    return true;
  }
};

/// A marker for each species and level of detail, in the namespace of the species: id 0 has the widest tenth
/// of the plants, with trunk and crown, id 1 the others, as pyramids. Markers that are no longer needed are
/// deleted.
class PlantMarkersTopic : public MessageTopic<visualization_msgs::MarkerArray> {
 public:
  explicit PlantMarkersTopic(const TopicContext& context) : MessageTopic(context, "plant_markers") {}
  double rate() const override { return parameters().topics.plant_markers_rate; }
  void add_to(StateQuery& query) override { query.plants = true; }

  bool publish(const TerrainState& state) override {
    publisher_.publish(markers(state, parameters().topics.plant_markers_count));
    return true;
  }

 private:
  visualization_msgs::MarkerArrayPtr markers(const TerrainState& state, int count);

  std::vector<std::string> shown_;  ///< the namespaces that were published last
};

visualization_msgs::MarkerArrayPtr PlantMarkersTopic::markers(const TerrainState& state, int count) {
  const PlantList& list = *state.plants;
  const ViewFrame frame = view_frame();
  auto array = boost::make_shared<visualization_msgs::MarkerArray>();
  std::vector<std::string> names;
  for (const Species& species : list.species) names.push_back(species.name);
  if (names != shown_) {
    Marker all = base_marker(state, frame.name, "", 0);
    all.action = Marker::DELETEALL;
    array->markers.push_back(all);
    shown_ = names;
  }
  std::vector<std::array<Marker, 2>> levels;
  for (const Species& species : list.species) {
    levels.push_back(
        {base_marker(state, frame.name, species.name, 0), base_marker(state, frame.name, species.name, 1)});
    for (Marker& marker : levels.back()) marker.color = crown_colour_of(species);
  }
  const std::vector<std::size_t> drawn = widest_plants(list.plants, count),
                                 full = widest_plants(list.plants, (count + 9) / 10);
  for (std::size_t n : drawn) {
    const PlantRecord& plant = list.plants[n];
    const bool detailed = std::binary_search(full.begin(), full.end(), n);
    draw(plant, list, frame, detailed, levels[plant.species][detailed ? 0 : 1]);
  }
  for (auto& of_species : levels)
    for (Marker& marker : of_species) {
      if (marker.points.empty()) marker.action = Marker::DELETE;
      array->markers.push_back(std::move(marker));
    }
  return array;
}

}  // namespace

void add_plants_topics(const TopicContext& context, TopicList& topics) {
  topics.push_back(std::make_unique<PlantsTopic>(context));
  topics.push_back(std::make_unique<PlantMarkersTopic>(context));
}

}  // namespace desert_sim
