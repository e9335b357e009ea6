#include "src/rviz/brush.hpp"

#include <algorithm>

namespace desert_sim {

namespace {

using Material = Brush::Material;
using Operation = Brush::Operation;

struct MaterialRow {
  const char* label;  ///< in the tool's property
  const char* layer;  ///< of ~edit_terrain, which these rows are in the order of Brush::Material for
  bool share;
  bool flattens;  ///< ~query_terrain knows the layer where a stroke begins
  bool smooths;
};
constexpr MaterialRow materials[] = {
    {"Sand", "sand", false, true, true},
    {"Rock", "bedrock", false, true, true},
    {"Soil", "soil", false, true, true},
    {"Water", "water", false, true, true},
    {"Moisture", "moisture", false, true, true},
    {"Plants", "plants", false, false, false},
    {"Vegetation", "vegetation", true, true, true},
    {"Erosion Resistance", "erosion_resistance", true, false, true},
    {"Looseness", "looseness", true, false, true},
    {"Obstacle", "obstacle", true, false, false},
};
const MaterialRow& row(Material material) { return materials[static_cast<int>(material)]; }

template <class Request>
void set_shape(Request& request, const render::Capsule& capsule, double radius) {
  const auto point = [](const render::Place& place) {
    geometry_msgs::Point result;
    result.x = place.x;
    result.y = place.y;
    return result;
  };
  const bool circle = capsule.length() == 0;
  request.shape = circle ? "circle" : "capsule";
  request.radius = radius;
  if (circle)
    request.center = point(capsule.from);
  else
    request.points = {point(capsule.from), point(capsule.to)};
}

}  // namespace

std::vector<const char*> brush_materials() {
  std::vector<const char*> labels;
  for (const MaterialRow& material : materials) labels.push_back(material.label);
  return labels;
}

const char* layer_of(Material material) { return row(material).layer; }

bool is_share(Material material) { return row(material).share; }

std::string problem_of(const Brush& brush) {
  const bool can = brush.operation == Operation::flatten  ? row(brush.material).flattens
                   : brush.operation == Operation::smooth ? row(brush.material).smooths
                                                          : true;
  if (!can)
    return std::string("A brush adds ") +
           (row(brush.material).smooths ? "and removes, or smooths, " : "or removes ") +
           layer_of(brush.material) + ": choose " +
           (row(brush.material).smooths ? "another Operation." : "the Operation Add or Remove.");
  if (brush.material == Material::plants && brush.operation == Operation::add && brush.species.empty())
    return "Planting needs a Species, one of the scenario's (rostopic echo -n 1 <node>/plants lists them).";
  return "";
}

EditTerrain::Request terrain_request(const Brush& brush, const render::Capsule& capsule,
                                     const std::string& stroke, double level) {
  EditTerrain::Request request;
  request.layer = layer_of(brush.material);
  request.stroke = stroke;
  request.inner = brush.inner;
  set_shape(request, capsule, brush.radius);
  const bool adds = brush.operation == Operation::add;
  if (brush.material == Material::obstacle) {  // any value above 0 is solid
    request.merge = "replace";
    request.inner = 1;
    request.value = adds ? 1 : 0;
    return request;
  }
  switch (brush.operation) {
    case Operation::add:
    case Operation::remove:
      request.merge = adds ? "add" : "sub";
      request.value = (is_share(brush.material) ? std::min(brush.strength, 1.0) : brush.strength) *
                      share_of_depth(capsule, brush.radius, brush.inner);
      break;
    case Operation::flatten:
      request.merge = "replace";
      request.value = level;
      break;
    case Operation::smooth:
      request.merge = "smooth";
      request.smooth_radius = 0.25 * brush.radius;
      request.smooth_passes = 1;
      break;
  }
  return request;
}

EditPlants::Request plants_request(const Brush& brush, const render::Capsule& capsule,
                                   const std::string& stroke, std::uint64_t seed) {
  EditPlants::Request request;
  const bool adds = brush.operation == Operation::add;
  request.operation = adds ? EditPlants::Request::PLANT : EditPlants::Request::CLEAR;
  request.species = brush.species;
  request.stroke = stroke;
  set_shape(request, capsule, brush.radius);
  if (adds) {
    request.density = brush.density * share_of_area(capsule, brush.radius);
    request.size = brush.size;
    request.seed = seed;
  }
  return request;
}

}  // namespace desert_sim
