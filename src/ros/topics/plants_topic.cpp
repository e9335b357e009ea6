/// ~plants and ~plant_markers: the plants one by one, as data and as triangles for rviz.

#include <desert_sim/Plants.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <array>
#include <boost/make_shared.hpp>
#include <cmath>
#include <numeric>

#include "src/ros/conversion/messages.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

using plants::PlantRecord;
using visualization_msgs::Marker;

/// The indices of the `count` widest plants, in ascending order; among plants of equal width the first ones
/// count.
std::vector<std::size_t> widest_plants(const std::vector<PlantRecord>& plants, std::size_t count) {
  std::vector<std::size_t> numbers(plants.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  if (count >= numbers.size()) return numbers;
  const auto wider = [&](std::size_t a, std::size_t b) {
    return plants[a].radius != plants[b].radius ? plants[a].radius > plants[b].radius : a < b;
  };
  std::nth_element(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(count), numbers.end(),
                   wider);
  numbers.resize(count);
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

geometry_msgs::Point point(double x, double y, double z) {
  geometry_msgs::Point p;
  p.x = x;
  p.y = y;
  p.z = z;
  return p;
}

/// Adds triangles to a marker. The corners of a triangle run counter-clockwise as seen from outside.
class Mesh {
 public:
  explicit Mesh(std::vector<geometry_msgs::Point>& corners) : corners_(corners) {}

  /// A cone of `sides` triangles: from a ring around (x, y) at height `ring_z` up, or down, to its tip.
  void cone(int sides, double x, double y, double ring_z, double radius, double tip_z) {
    const geometry_msgs::Point tip = point(x, y, tip_z);
    for (int n = 0; n < sides; ++n) {
      const geometry_msgs::Point a = ring_corner(sides, n, x, y, ring_z, radius),
                                 b = ring_corner(sides, n + 1, x, y, ring_z, radius);
      const bool up = tip_z > ring_z;
      for (const geometry_msgs::Point& corner : {up ? a : b, up ? b : a, tip}) corners_.push_back(corner);
    }
  }

 private:
  static geometry_msgs::Point ring_corner(int sides, int n, double x, double y, double z, double radius) {
    const double angle = 2 * 3.14159265358979 * n / sides;
    return point(x + radius * std::cos(angle), y + radius * std::sin(angle), z);
  }
  std::vector<geometry_msgs::Point>& corners_;
};

/// A plant in the terrain's frame [m]. In bad health it is drawn lower.
struct PlantShape {
  double x, y, foot, top, radius;

  PlantShape(const PlantRecord& plant, const PlantList& list)
      : x(list.origin_x + plant.x), y(list.origin_y + plant.y), foot(plant.z), radius(plant.radius) {
    const double health = plant.health / 255.0, stem = list.species[plant.species].traits.stem;
    top = foot + radius * stem * (0.5 + 0.5 * health);
  }
  double height_at(double share) const { return foot + share * (top - foot); }

  /// A trunk, and a crown of two cones with six sides.
  void draw_detailed(Mesh mesh) const {
    mesh.cone(3, x, y, foot, 0.12 * radius, height_at(0.7));
    mesh.cone(6, x, y, height_at(0.55), 0.9 * radius, top);
    mesh.cone(6, x, y, height_at(0.55), 0.9 * radius, height_at(0.3));
  }
  /// A pyramid.
  void draw_simple(Mesh mesh) const { mesh.cone(4, x, y, foot, 0.8 * radius, top); }
};

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
  const auto [r, g, b] = crown_colour(species.appearance);
  std_msgs::ColorRGBA colour;
  colour.r = r;
  colour.g = g;
  colour.b = b;
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
  const std::vector<std::size_t> numbers = widest_plants(list.plants, static_cast<std::size_t>(count));
  for (auto* column : {&message->x, &message->y, &message->z, &message->radius})
    column->reserve(numbers.size());
  for (auto* column : {&message->species_index, &message->health}) column->reserve(numbers.size());
  for (std::size_t n : numbers) {
    const PlantRecord& plant = list.plants[n];
    message->x.push_back(plant.x);
    message->y.push_back(plant.y);
    message->z.push_back(plant.z);
    message->radius.push_back(plant.radius);
    message->species_index.push_back(plant.species);
    message->health.push_back(plant.health);
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
  auto array = boost::make_shared<visualization_msgs::MarkerArray>();
  std::vector<std::string> names;
  for (const Species& species : list.species) names.push_back(species.name);
  if (names != shown_) {
    Marker all = base_marker(state, frame(), "", 0);
    all.action = Marker::DELETEALL;
    array->markers.push_back(all);
    shown_ = names;
  }
  std::vector<std::array<Marker, 2>> levels;
  for (const Species& species : list.species) {
    levels.push_back(
        {base_marker(state, frame(), species.name, 0), base_marker(state, frame(), species.name, 1)});
    for (Marker& marker : levels.back()) marker.color = crown_colour_of(species);
  }
  const std::vector<std::size_t> drawn = widest_plants(list.plants, static_cast<std::size_t>(count)),
                                 full =
                                     widest_plants(list.plants, (static_cast<std::size_t>(count) + 9) / 10);
  for (std::size_t n : drawn) {
    const PlantRecord& plant = list.plants[n];
    const bool detailed = std::binary_search(full.begin(), full.end(), n);
    Mesh mesh(levels[plant.species][detailed ? 0 : 1].points);
    const PlantShape shape(plant, list);
    detailed ? shape.draw_detailed(mesh) : shape.draw_simple(mesh);
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
