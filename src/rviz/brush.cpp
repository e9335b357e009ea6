#include "src/rviz/brush.hpp"

#include <algorithm>

#include "src/simulation/commands/edited_layers.hpp"

namespace desert_sim {

namespace {

struct MaterialRow {
  const char* label;  ///< in the tool's property
  const char* layer;  ///< of ~edit_terrain, which these rows are in the order of Brush::Material for
  bool flattens;      ///< ~query_terrain knows the layer where a stroke begins
  bool smooths;
};
constexpr MaterialRow materials[] = {
    {"Sand", "sand", true, true},
    {"Rock", "bedrock", true, true},
    {"Soil", "soil", true, true},
    {"Water", "water", true, true},
    {"Moisture", "moisture", true, true},
    {"Plants", "plants", false, false},
    {"Airborne Sand", "airborne_sand", false, true},
    {"Vegetation", "vegetation", true, true},
    {"Erosion Resistance", "erosion_resistance", false, true},
    {"Humus", "humus", false, true},
    {"Grass", "grass", false, true},
    {"Mesquite", "mesquite", false, true},
    {"Shrub", "shrub", false, true},
    {"Snow Density", "snow_density", false, true},
    {"Looseness", "looseness", false, true},
    {"Obstacle", "obstacle", false, false},
};
const MaterialRow& row(Brush::Material material) { return materials[static_cast<int>(material)]; }

/// How much a pass can change a layer that has no depth or elevation [unit of the layer]; 0: it has one.
double width_of_range(Brush::Material material) {
  const EditedLayer* const edited = find_edited_layer(layer_of(material));  // plants are none
  if (!edited || info(edited->layer).storage == Storage::quanta) return 0;
  return info(edited->layer).highest - info(edited->layer).lowest;
}

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

const char* layer_of(Brush::Material material) { return row(material).layer; }

bool is_material(Brush::Material material) { return width_of_range(material) == 0; }

std::string problem_of(const Brush& brush) {
  if (!brush.mask.empty() && brush.material == Brush::Material::plants)
    return "Plants take no Mask File: leave it empty.";
  if (!brush.mask.empty() && brush.later)
    return "A Mask File is stamped at once: leave it empty, or set When to Now.";
  const bool can = brush.operation == Brush::Operation::flatten  ? row(brush.material).flattens
                   : brush.operation == Brush::Operation::smooth ? row(brush.material).smooths
                                                                 : true;
  if (!can)
    return std::string("A brush adds ") +
           (row(brush.material).smooths ? "and removes, or smooths, " : "or removes ") +
           layer_of(brush.material) + ": choose " +
           (row(brush.material).smooths ? "another Operation." : "the Operation Add or Remove.");
  if (brush.material == Brush::Material::plants && brush.operation == Brush::Operation::add &&
      brush.species.empty())
    return "Planting needs a Species, one of the scenario's (rostopic echo -n 1 <node>/plants lists them).";
  return "";
}

EditTerrain::Request terrain_request(const Brush& brush, const render::Capsule& capsule,
                                     const std::string& stroke, double level, bool alone) {
  EditTerrain::Request request;
  request.layer = layer_of(brush.material);
  request.stroke = stroke;
  request.inner = brush.inner;
  set_shape(request, capsule, brush.radius);
  if (!brush.mask.empty()) {
    request.shape = "patch";
    request.radius_y = brush.radius;
    request.image_file = brush.mask;
    request.image_use = "mask";
    request.inner = 0;
  }
  const bool adds = brush.operation == Brush::Operation::add;
  if (brush.material == Brush::Material::obstacle) {  // any value above 0 is solid
    request.merge = "replace";
    request.inner = brush.mask.empty() ? 1 : 0;
    request.value = adds ? 1 : 0;
    return request;
  }
  switch (brush.operation) {
    case Brush::Operation::add:
    case Brush::Operation::remove:
      request.merge = adds ? "add" : "sub";
      request.value = brush.strength;
      if (!is_material(brush.material))
        request.value = std::min(request.value, width_of_range(brush.material));
      if (brush.mask.empty() && !alone) request.value *= share_of_depth(capsule, brush.radius, brush.inner);
      break;
    case Brush::Operation::flatten:
      request.merge = "replace";
      request.value = level;
      break;
    case Brush::Operation::smooth:
      request.merge = "smooth";
      request.smooth_radius = 0.25 * brush.radius;
      request.smooth_passes = 1;
      break;
  }
  return request;
}

EditPlants::Request plants_request(const Brush& brush, const render::Capsule& capsule,
                                   const std::string& stroke, std::uint64_t seed, bool alone) {
  EditPlants::Request request;
  const bool adds = brush.operation == Brush::Operation::add;
  request.operation = adds ? EditPlants::Request::PLANT : EditPlants::Request::CLEAR;
  request.species = brush.species;
  request.stroke = stroke;
  set_shape(request, capsule, brush.radius);
  if (adds) {
    request.density = brush.density * (alone ? 1 : share_of_area(capsule, brush.radius));
    request.size = brush.size;
    request.seed = seed;
  }
  return request;
}

}  // namespace desert_sim
