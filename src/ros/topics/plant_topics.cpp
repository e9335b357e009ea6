#include "src/ros/topics/plant_topics.hpp"

#include <algorithm>
#include <array>
#include <boost/make_shared.hpp>
#include <cmath>
#include <numeric>

#include "src/ros/conversion/messages.hpp"

namespace desert_sim {

namespace {

using plants::Listed;
using visualization_msgs::Marker;

/// Numbers of the `count` widest plants, of equal ones the first; in ascending order.
std::vector<std::size_t> widest(const std::vector<Listed>& plants, std::size_t count) {
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

/// Triangles of one marker. Corners turn counter-clockwise seen from outside.
class Mesh {
 public:
  explicit Mesh(std::vector<geometry_msgs::Point>& corners) : corners_(corners) {}

  /// Sides from a ring of `sides` corners around (x, y) up, or down, to a tip.
  void cone(int sides, double x, double y, double ring_z, double radius, double tip_z) {
    const geometry_msgs::Point tip = point(x, y, tip_z);
    for (int n = 0; n < sides; ++n) {
      const geometry_msgs::Point a = of_ring(sides, n, x, y, ring_z, radius),
                                 b = of_ring(sides, n + 1, x, y, ring_z, radius);
      const bool up = tip_z > ring_z;
      for (const geometry_msgs::Point& corner : {up ? a : b, up ? b : a, tip}) corners_.push_back(corner);
    }
  }

 private:
  static geometry_msgs::Point of_ring(int sides, int n, double x, double y, double z, double radius) {
    const double angle = 2 * 3.14159265358979 * n / sides;
    return point(x + radius * std::cos(angle), y + radius * std::sin(angle), z);
  }
  std::vector<geometry_msgs::Point>& corners_;
};

/// A plant at its place in the frame.
struct Shape {
  double x, y, foot, top, radius;

  Shape(const Listed& plant, const PlantList& list)
      : x(list.origin_x + plant.x), y(list.origin_y + plant.y), foot(plant.z), radius(plant.radius) {
    const double health = plant.health / 255.0, stem = list.species[plant.species].traits.stem;
    top = foot + radius * stem * (0.5 + 0.5 * health);
  }
  double at(double share) const { return foot + share * (top - foot); }

  void draw_in_full(Mesh mesh) const {
    mesh.cone(3, x, y, foot, 0.12 * radius, at(0.7));
    mesh.cone(6, x, y, at(0.55), 0.9 * radius, top);
    mesh.cone(6, x, y, at(0.55), 0.9 * radius, at(0.3));
  }
  void draw_simply(Mesh mesh) const { mesh.cone(4, x, y, foot, 0.8 * radius, top); }
};

Marker base(const TerrainState& state, const std::string& frame, const std::string& species, int id) {
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

std_msgs::ColorRGBA crowns(const Species& species) {
  const auto [r, g, b] = crown_colour(species.look);
  std_msgs::ColorRGBA colour;
  colour.r = r;
  colour.g = g;
  colour.b = b;
  colour.a = 1;
  return colour;
}

}  // namespace

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
    row.hue = species.look.hue;
    message->species.push_back(row);
  }
  message->total = list.plants.size();
  const std::vector<std::size_t> numbers = widest(list.plants, static_cast<std::size_t>(count));
  for (auto* column : {&message->x, &message->y, &message->z, &message->radius})
    column->reserve(numbers.size());
  for (auto* column : {&message->species_index, &message->health}) column->reserve(numbers.size());
  for (std::size_t n : numbers) {
    const Listed& plant = list.plants[n];
    message->x.push_back(plant.x);
    message->y.push_back(plant.y);
    message->z.push_back(plant.z);
    message->radius.push_back(plant.radius);
    message->species_index.push_back(plant.species);
    message->health.push_back(plant.health);
  }
  return message;
}

visualization_msgs::MarkerArrayPtr PlantMarkers::markers(const TerrainState& state, int count) {
  const PlantList& list = *state.plants;
  auto array = boost::make_shared<visualization_msgs::MarkerArray>();
  std::vector<std::string> names;
  for (const Species& species : list.species) names.push_back(species.name);
  if (names != shown_) {
    Marker all = base(state, frame_, "", 0);
    all.action = Marker::DELETEALL;
    array->markers.push_back(all);
    shown_ = names;
  }
  std::vector<std::array<Marker, 2>> levels;
  for (const Species& species : list.species) {
    levels.push_back({base(state, frame_, species.name, 0), base(state, frame_, species.name, 1)});
    for (Marker& marker : levels.back()) marker.color = crowns(species);
  }
  const std::vector<std::size_t> drawn = widest(list.plants, static_cast<std::size_t>(count)),
                                 full = widest(list.plants, (static_cast<std::size_t>(count) + 9) / 10);
  for (std::size_t n : drawn) {
    const Listed& plant = list.plants[n];
    const bool in_full = std::binary_search(full.begin(), full.end(), n);
    Mesh mesh(levels[plant.species][in_full ? 0 : 1].points);
    const Shape shape(plant, list);
    in_full ? shape.draw_in_full(mesh) : shape.draw_simply(mesh);
  }
  for (auto& of_species : levels)
    for (Marker& marker : of_species) {
      if (marker.points.empty()) marker.action = Marker::DELETE;
      array->markers.push_back(std::move(marker));
    }
  return array;
}

}  // namespace desert_sim
