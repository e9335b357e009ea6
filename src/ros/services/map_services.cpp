/// Services that read the terrain: ~query_terrain at points, ~get_submap and ~get_grid_map in rectangles of
/// cells.

#include "src/core/error.hpp"
#include "src/ros/conversion/grid_map_message.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/ros/services/request_fields.hpp"
#include "src/ros/services/services.hpp"
#include "src/ros/services/terrain_sampler.hpp"
#include "src/ros/support/service_with_reason.hpp"

namespace desert_sim {

namespace {

constexpr std::size_t max_points = 1000000;
constexpr auto max_snapshot_age = std::chrono::milliseconds(100);

/// All layers, if none is named.
std::vector<MapLayer> requested_layers(const std::vector<std::string>& names) {
  if (names.empty()) return {map_layers.begin(), map_layers.end()};
  return map_layers_named(names, "layers");
}

}  // namespace

// ---- Points.

TerrainState Services::recent_terrain() {
  {
    const std::lock_guard<std::mutex> lock(recent_mutex_);
    const bool unchanged = recent_.moment.change == simulation_.changes();
    const bool uncommanded = recent_.moment.command == simulation_.commands();
    const bool recent = simulation_.clock().now() - recent_time_ < max_snapshot_age;
    if (recent_.snapshot && (unchanged || (uncommanded && recent))) return recent_;
  }
  const TerrainState state = simulation_.terrain(sampled_layers()).get();
  const std::lock_guard<std::mutex> lock(recent_mutex_);
  recent_ = state;
  recent_time_ = simulation_.clock().now();
  return state;
}

void Services::query_terrain(const QueryTerrainRequest& request, QueryTerrainResponse& response) {
  if (request.points.size() > max_points)
    throw ConfigError("points: " + std::to_string(request.points.size()) + " are given (allowed: at most " +
                      std::to_string(max_points) + ")");
  for (std::size_t n = 0; n < request.points.size(); ++n)
    require_finite(request.points[n], "points[" + std::to_string(n) + "]");
  const tf2::Transform transform = frames_.to_terrain(request.header);
  const TerrainState state = recent_terrain();
  const TerrainSampler sampler(*state.snapshot);
  response.samples.reserve(request.points.size());
  for (const geometry_msgs::Point& point : request.points) {
    const tf2::Vector3 p = transform * tf2::Vector3(point.x, point.y, point.z);
    response.samples.push_back(sampler.at(p.x(), p.y()));
  }
  response.header = header_of(state.moment, frames_.terrain_frame());
  response.step = state.moment.step;
  response.sim_time = state.moment.time;
}

// ---- Rectangles.

MapCut Services::cut_region(const std::vector<MapLayer>& layers, const std_msgs::Header& header,
                            const geometry_msgs::Point& center, double length_x, double length_y) const {
  require_finite(center, "center");
  const tf2::Vector3 c = frames_.to_terrain(header) * tf2::Vector3(center.x, center.y, center.z);
  const MapRegion region{c.x(), c.y(), length_x, length_y};
  return cut_terrain(simulation_, layers, "region", [&](const Snapshot& s) {
    const MapWindow window = window_of(region, s);
    require_inside(window, region, s);
    return window;
  });
}

void Services::get_submap(const GetSubmapRequest& r, GetSubmapResponse& response) {
  const std::vector<MapLayer> layers = requested_layers(r.layers);
  const MapCut c = cut_region(layers, r.header, r.center, r.length_x, r.length_y);
  response.map = terrain_submap(c.state, frames_.terrain_frame(), layers, c.window);
}

GridMap Services::get_grid_map(const GetGridMapRequest& r) const {
  const std::vector<MapLayer> layers = requested_layers(r.layers);
  std_msgs::Header header;
  header.frame_id = r.frame_id;
  geometry_msgs::Point center;
  center.x = r.position_x;
  center.y = r.position_y;
  const MapCut c = cut_region(layers, header, center, r.length_x, r.length_y);
  return grid_map(c.state, frames_.terrain_frame(), layers, c.window);
}

void Services::advertise_get_grid_map() {
  auto options = service_with_reason<GetGridMap>(
      "get_grid_map", [this](const GetGridMapRequest& request, GetGridMapResponse& response) {
        const SimulationThread::Patience patience(answer_timeout_);
        response.map = get_grid_map(request);
      });
  servers_.push_back(node_.advertiseService(options));
}

}  // namespace desert_sim
