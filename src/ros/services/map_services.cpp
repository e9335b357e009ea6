/// Services that read the terrain: ~query_terrain at points, ~get_submap and ~get_grid_map in rectangles of
/// cells.

#include <desert_sim/GetSubmap.h>
#include <desert_sim/QueryTerrain.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <sstream>

#include "src/core/error.hpp"
#include "src/grid_map/grid_map_msg.hpp"
#include "src/ros/conversion/grid_map_message.hpp"
#include "src/ros/conversion/map_window.hpp"
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

// ---- Points.

/// A copy of the terrain that is new enough for a query: the last one, if it still is.
class RecentTerrain {
 public:
  explicit RecentTerrain(SimulationThread& simulation) : simulation_(simulation) {}

  TerrainState get() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      const bool unchanged = recent_.moment.change == simulation_.changes();
      const bool uncommanded = recent_.moment.command == simulation_.commands();
      const bool recent = simulation_.clock().now() - time_ < max_snapshot_age;
      if (recent_.snapshot && (unchanged || (uncommanded && recent))) return recent_;
    }
    const TerrainState state = simulation_.terrain(sampled_layers()).get();
    const std::lock_guard<std::mutex> lock(mutex_);
    recent_ = state;
    time_ = simulation_.clock().now();
    return state;
  }

 private:
  SimulationThread& simulation_;
  std::mutex mutex_;  ///< guards the next two
  TerrainState recent_;
  MonotonicClock::TimePoint time_;
};

void query_terrain(const ServiceContext& c, RecentTerrain& terrain, const QueryTerrainRequest& request,
                   QueryTerrainResponse& response) {
  if (request.points.size() > max_points)
    throw ConfigError("points: " + std::to_string(request.points.size()) + " are given (allowed: at most " +
                      std::to_string(max_points) + ")");
  for (std::size_t n = 0; n < request.points.size(); ++n)
    require_finite(request.points[n], "points[" + std::to_string(n) + "]");
  const tf2::Transform transform = c.frames.to_terrain(request.header);
  const TerrainState state = terrain.get();
  const TerrainSampler sampler(*state.snapshot);
  response.samples.reserve(request.points.size());
  for (const geometry_msgs::Point& point : request.points) {
    const tf2::Vector3 p = transform * tf2::Vector3(point.x, point.y, point.z);
    response.samples.push_back(sampler.at(p.x(), p.y()));
  }
  response.header = header_of(state.moment, c.frames.terrain_frame());
  response.step = state.moment.step;
  response.sim_time = state.moment.time;
}

// ---- Rectangles.

/// The layers in a rectangle around `center`, in the frame of `header` [m]. Throws ConfigError that names
/// the field, its value and what is allowed.
MapCut cut_region(const ServiceContext& c, const std::vector<MapLayer>& layers,
                  const std_msgs::Header& header, const geometry_msgs::Point& center, double length_x,
                  double length_y) {
  require_finite(center, "center");
  const tf2::Vector3 p = c.frames.to_terrain(header) * tf2::Vector3(center.x, center.y, center.z);
  const MapRegion region{p.x(), p.y(), length_x, length_y};
  return cut_terrain(c.simulation, layers, "region", [&](const Snapshot& s) {
    const MapWindow window = window_of(region, s);
    require_inside(window, region, s);
    return window;
  });
}

/// Throws ConfigError unless squares of that size are finer than the terrain's cells, and can be told apart.
void require_resolution(const ServiceContext& c, double resolution) {
  const double cell = c.simulation.terrain({}).get().snapshot->cell_size;
  if (resolution >= finest_detail && resolution <= cell) return;
  std::ostringstream text;
  text << "resolution: " << resolution << " m is neither 0 nor in [" << finest_detail << ", " << cell
       << "], up to the width of the terrain's cells";
  throw ConfigError(text.str());
}

void get_submap(const ServiceContext& c, const GetSubmapRequest& r, GetSubmapResponse& response) {
  const std::vector<MapLayer> layers = requested_layers(r.layers);
  if (r.resolution != 0) {
    require_finite(r.center, "center");
    require_resolution(c, r.resolution);
    const tf2::Vector3 p = c.frames.to_terrain(r.header) * tf2::Vector3(r.center.x, r.center.y, r.center.z);
    const MicroReliefCut cut = cut_micro_relief(c.simulation, layers, "region",
                                                {p.x(), p.y(), r.length_x, r.length_y}, r.resolution);
    response.map = terrain_submap(cut.state, c.frames.terrain_frame(), layers, cut.window);
    return;
  }
  const MapCut cut = cut_region(c, layers, r.header, r.center, r.length_x, r.length_y);
  response.map = terrain_submap(cut.state, c.frames.terrain_frame(), layers, cut.window);
}

GridMap get_grid_map(const ServiceContext& c, const GetGridMapRequest& r) {
  const std::vector<MapLayer> layers = requested_layers(r.layers);
  std_msgs::Header header;
  header.frame_id = r.frame_id;
  geometry_msgs::Point center;
  center.x = r.position_x;
  center.y = r.position_y;
  const MapCut cut = cut_region(c, layers, header, center, r.length_x, r.length_y);
  return grid_map(cut.state, c.frames.terrain_frame(), layers, cut.window);
}

}  // namespace

void add_map_services(Services& services) {
  const ServiceContext& c = services.context();
  const auto recent = std::make_shared<RecentTerrain>(c.simulation);

  services.add<QueryTerrain>(
      "query_terrain", [&c, recent](const QueryTerrainRequest& request, QueryTerrainResponse& response) {
        query_terrain(c, *recent, request, response);
      });
  services.add<GetSubmap>("get_submap", [&c](const GetSubmapRequest& request, GetSubmapResponse& response) {
    get_submap(c, request, response);
  });
  // GetGridMap has no field `success`.
  services.advertise(service_with_reason<GetGridMap>(
      "get_grid_map", [&c](const GetGridMapRequest& request, GetGridMapResponse& response) {
        const SimulationThread::Patience patience(c.answer_timeout);
        response.map = get_grid_map(c, request);
      }));
}

}  // namespace desert_sim
