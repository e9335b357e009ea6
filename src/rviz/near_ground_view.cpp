#include "src/rviz/near_ground_view.hpp"

#include <OgreCamera.h>

#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "src/render/ray_cast.hpp"
#include "src/render/rebuild_queue.hpp"

namespace desert_sim {

namespace {

constexpr double soonest = 0.1,
                 usual = 0.5;  // between questions, for another window and for a later step [s]

/// The heights of a map as they are drawn.
render::HeightField field_of(const LayerMap& map, double exaggeration) {
  const LayerMap::Info& info = map.info();
  return {static_cast<int>(info.width), static_cast<int>(info.height), info.cell_size,
          [&map, exaggeration](int x, int y) {
            return static_cast<float>(exaggeration) *
                   map.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
          }};
}

render::NearGround fine_ground(const render::NearWindow& window, const TerrainSubmap& map) {
  render::NearGround near{window.cells, window.divisions, window.ripples, {}};
  const bool fits = map.width == static_cast<std::uint32_t>(near.columns()) &&
                    map.height == static_cast<std::uint32_t>(near.rows()) && map.layers.size() == 1 &&
                    map.layers[0].data.size() == static_cast<std::size_t>(map.width) * map.height;
  if (fits) near.heights = map.layers[0].data;
  return near;
}

}  // namespace

void NearGroundView::follow(const std::string& node) {
  node_ = node;
  forget();
}

void NearGroundView::forget() {
  caller_.cancel();
  answer_ = {};  // waits for a mesh that is being built
  under_way_ = false;
  asked_ = {};
  hide();
}

void NearGroundView::hide() {
  status_.clear();
  failed_ = false;
  if (shown_) scene_.set_near_ground({}, {});
  shown_ = false;
}

void NearGroundView::show_answer() {
  if (!answer_.valid() || answer_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  Answer answer = answer_.get();
  under_way_ = false;
  if (asked_.window.empty() || answer.mesh.empty()) return hide();
  status_ = std::to_string(answer.mesh.indices.size() / 3) + " triangles";
  failed_ = false;
  shown_ = true;
  scene_.set_near_ground(answer.window.cells, std::move(answer.mesh));
}

void NearGroundView::update(const Ogre::Camera& camera, int viewport_height, const LayerMaps& maps,
                            double pixels, double ripple_wavelength) {
  show_answer();
  const auto elevation = maps.find("elevation");
  if (node_.empty() || elevation == maps.end()) return;
  const LayerMap& map = *elevation->second;
  const render::View view = scene_.view_of(camera, viewport_height);
  const bool near = pixels <= render::coarsest_near_ground * scene_.most_pixels_per_metre(view);
  const std::optional<render::Point> seen =
      near ? render::first_hit(field_of(map, scene_.look().vertical_exaggeration), view.middle())
           : std::nullopt;
  Question question;
  question.step = map.info().step;
  if (seen)
    question.window =
        render::near_window(scene_.grid().layout, map.info().cell_size, seen->x(), seen->y(),
                            pixels / view.pixels_per_metre(render::Box(*seen, *seen)), ripple_wavelength);
  if (question.window.empty()) {
    asked_ = {};
    if (!under_way_) hide();
  } else if (worth_asking(question)) {
    ask(question, map);
  }
}

bool NearGroundView::worth_asking(const Question& question) const {
  if (under_way_) return false;
  const double since = render::RebuildQueue::steady_seconds() - time_;
  if (failed_) return since > usual;
  if (!(question.window == asked_.window)) return since > soonest;
  return question.step != asked_.step && since > usual;
}

void NearGroundView::ask(const Question& question, const LayerMap& elevation) {
  asked_ = question;
  time_ = render::RebuildQueue::steady_seconds();
  under_way_ = true;
  const LayerMap::Info& info = elevation.info();
  const render::NearWindow& window = question.window;
  const render::NearGround size{window.cells, window.divisions, window.ripples, {}};
  GetSubmapRequest request;
  request.resolution = info.cell_size / window.divisions;
  request.length_x = size.columns() * request.resolution;
  request.length_y = size.rows() * request.resolution;
  request.center.x = info.origin_x + (window.cells.x + 0.5 * window.cells.width) * info.cell_size;
  request.center.y = info.origin_y + (window.cells.y + 0.5 * window.cells.height) * info.cell_size;
  request.layers = {"elevation"};
  caller_.call<GetSubmap>(node_ + "/get_submap", request,
                          [this, window](const CallOutcome& outcome, const GetSubmapResponse& response) {
                            take(window, outcome, response);
                          });
}

void NearGroundView::take(const render::NearWindow& window, const CallOutcome& outcome,
                          const GetSubmapResponse& response) {
  render::NearGround near = fine_ground(window, response.map);
  if (!outcome.success || near.empty()) {
    hide();
    under_way_ = false;
    failed_ = true;
    status_ =
        outcome.success ? "the node's map of fine ground has another size than asked for" : outcome.message;
    return;
  }
  answer_ = std::async(std::launch::async, [window, near = std::move(near), grid = scene_.grid(),
                                            windows = scene_.window(), look = scene_.look()] {
    return Answer{window, render::near_ground_mesh(near, grid, windows, look)};
  });
}

}  // namespace desert_sim
