#pragma once
/// The fields of requests by their names, for tests of which of them a request may set.

#include <functional>
#include <string>
#include <vector>

#include "src/core/error.hpp"
#include "src/ros/services/requests.hpp"

namespace node_test {

template <class Request>
struct RequestField {
  std::string name;
  std::function<void(Request&)> set;    ///< to a value that is not 0 or empty
  std::function<void(Request&)> clear;  ///< leaves it out
};

template <class Request, class Value>
RequestField<Request> request_field(const char* name, Value Request::*member, const Value& value) {
  return {name, [=](Request& request) { request.*member = value; },
          [=](Request& request) { request.*member = Value(); }};
}

inline geometry_msgs::Point point_at(double x, double y) {
  geometry_msgs::Point point;
  point.x = x;
  point.y = y;
  return point;
}
inline geometry_msgs::Vector3 vector_of(double x, double y) {
  geometry_msgs::Vector3 vector;
  vector.x = x;
  vector.y = y;
  return vector;
}
inline desert_sim::WindFeaturePoint path_point(double time, double x, double y) {
  desert_sim::WindFeaturePoint point;
  point.time = time;
  point.x = x;
  point.y = y;
  return point;
}
inline sensor_msgs::Image white_pixel() {
  sensor_msgs::Image image;
  image.width = image.height = image.step = 1;
  image.encoding = "mono8";
  image.data = {255};
  return image;
}

// Of shape, merge, operation, kind and what else says which of the others are used, there is nothing here.

inline std::vector<RequestField<desert_sim::EditTerrainRequest>> fields_of(
    const desert_sim::EditTerrainRequest&) {
  using R = desert_sim::EditTerrainRequest;
  return {request_field("center", &R::center, point_at(5, 4)),
          request_field("radius", &R::radius, 3.0),
          request_field("radius_y", &R::radius_y, 2.0),
          request_field("angle_deg", &R::angle_deg, 30.0),
          request_field("points", &R::points, {point_at(1, 1), point_at(6, 2), point_at(3, 7)}),
          request_field("inner", &R::inner, 0.5),
          request_field("falloff", &R::falloff, 1.0),
          request_field("value", &R::value, 0.25),
          request_field("smooth_radius", &R::smooth_radius, 1.0),
          request_field("smooth_passes", &R::smooth_passes, 2),
          request_field("ring_width", &R::ring_width, 2.0),
          request_field("image", &R::image, white_pixel()),
          request_field("image_file", &R::image_file, std::string("stamp.asc")),
          request_field("image_use", &R::image_use, std::string("heights")),
          request_field("image_scale", &R::image_scale, 1.0)};
}

inline std::vector<RequestField<desert_sim::EditPlantsRequest>> fields_of(
    const desert_sim::EditPlantsRequest&) {
  using R = desert_sim::EditPlantsRequest;
  return {request_field("center", &R::center, point_at(5, 4)),
          request_field("radius", &R::radius, 3.0),
          request_field("radius_y", &R::radius_y, 2.0),
          request_field("angle_deg", &R::angle_deg, 30.0),
          request_field("points", &R::points, {point_at(1, 1), point_at(6, 2), point_at(3, 7)}),
          request_field("density", &R::density, 0.1),
          request_field("size", &R::size, 0.5),
          request_field("seed", &R::seed, std::uint64_t{9})};
}

inline std::vector<RequestField<desert_sim::EditWindRequest>> fields_of(const desert_sim::EditWindRequest&) {
  using R = desert_sim::EditWindRequest;
  return {request_field("id", &R::id, 4),
          request_field("kind", &R::kind, std::string("vortex")),
          request_field("center", &R::center, point_at(5, 4)),
          request_field("direction_deg", &R::direction_deg, 30.0),
          request_field("radius", &R::radius, 3.0),
          request_field("speed", &R::speed, 2.0),
          request_field("length", &R::length, 8.0),
          request_field("scale", &R::scale, 2.0),
          request_field("life_time", &R::life_time, 5.0),
          request_field("seed", &R::seed, 7),
          request_field("begin", &R::begin, 3.0),
          request_field("end", &R::end, 9.0),
          request_field("velocity", &R::velocity, vector_of(3, 4)),
          request_field("path", &R::path, {path_point(3, 5, 4), path_point(7, 6, 1)})};
}

inline std::vector<RequestField<desert_sim::SetWindRequest>> fields_of(const desert_sim::SetWindRequest&) {
  using R = desert_sim::SetWindRequest;
  return {request_field("speed", &R::speed, 7.0), request_field("direction_deg", &R::direction_deg, 90.0),
          request_field("vector", &R::vector, vector_of(3, 4))};
}

inline std::vector<RequestField<desert_sim::SetWindScheduleRequest>> fields_of(
    const desert_sim::SetWindScheduleRequest&) {
  using R = desert_sim::SetWindScheduleRequest;
  return {request_field("repeat", &R::repeat, std::uint8_t{1}),
          request_field("hold_time", &R::hold_time, 5.0), request_field("seed", &R::seed, std::uint64_t{9})};
}

inline std::vector<RequestField<desert_sim::SetWeatherRequest>> fields_of(
    const desert_sim::SetWeatherRequest&) {
  using R = desert_sim::SetWeatherRequest;
  return {request_field("rain_rate", &R::rain_rate, 1e-4),
          request_field("rain_share", &R::rain_share, 0.5),
          request_field("evaporation", &R::evaporation, 0.01),
          request_field("ground_evaporation", &R::ground_evaporation, 0.5),
          request_field("sea", &R::sea, std::string("border")),
          request_field("sea_level", &R::sea_level, 2.0),
          request_field("wave_strength", &R::wave_strength, 0.1),
          request_field("wave_period", &R::wave_period, 5.0),
          request_field("springs", &R::springs, {desert_sim::WaterSpring()})};
}

/// What `make` makes of the request after all fields are left out that it refuses because nothing uses them.
template <class Request, class Make>
auto without_unused_fields(Request request, const Make& make) {
  for (;;) try {
      return make(request);
    } catch (const desert_sim::ConfigError& refusal) {
      const std::string text = refusal.what();
      const std::string name = text.substr(0, text.find(':'));
      if (text.find(": is set, but ") == std::string::npos) throw;
      bool known = false;
      for (const RequestField<Request>& field : fields_of(request))
        if (field.name == name) field.clear(request), known = true;
      if (!known) throw;
    }
}

}  // namespace node_test
