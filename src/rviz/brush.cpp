#include "src/rviz/brush.hpp"

namespace desert_sim {

namespace {

using Material = Brush::Material;
using Operation = Brush::Operation;

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

const char* layer_of(Material material) {
  constexpr const char* names[] = {"sand", "bedrock", "soil", "water", "plants", "obstacle"};
  return names[static_cast<int>(material)];
}

std::string problem_of(const Brush& brush) {
  const bool shapes = brush.operation == Operation::flatten || brush.operation == Operation::smooth;
  if (shapes && (brush.material == Material::plants || brush.material == Material::obstacle))
    return std::string("A brush adds or removes ") + layer_of(brush.material) +
           ": choose the Operation Add or Remove.";
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
      request.value = brush.strength * share_of_depth(capsule, brush.radius, brush.inner);
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
