#include "src/rover/sensors/height_field_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "kernels/base/grid.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

namespace {

void check(const SceneGeometry& g) {
  std::ostringstream fault;
  if (g.width < 1 || g.height < 1 || static_cast<long long>(g.width) * g.height > max_grid_cells)
    fault << "sensors: a grid of " << g.width << " x " << g.height << " cells, of which 1 to "
          << max_grid_cells << " are allowed";
  else if (!(g.cell_size > 0 && std::isfinite(g.cell_size)))
    fault << "sensors: cell_size = " << g.cell_size << " is not above 0 and finite";
  else if (!std::isfinite(g.origin_x) || !std::isfinite(g.origin_y))
    fault << "sensors: the origin (" << g.origin_x << ", " << g.origin_y << ") is not finite";
  if (!fault.str().empty()) throw ConfigError(fault.str());
}

Buffer<float> zeros(Exec& exec, std::size_t size) {
  Buffer<float> buffer(exec, size);
  buffer.set_zero();
  return buffer;
}

}  // namespace

bool operator==(const SceneGeometry& a, const SceneGeometry& b) {
  return a.width == b.width && a.height == b.height && a.cell_size == b.cell_size &&
         a.origin_x == b.origin_x && a.origin_y == b.origin_y;
}

HeightFieldScene::HeightFieldScene(Exec& exec, const SceneGeometry& geometry)
    : exec_(exec), geometry_((desert_sim::check(geometry), geometry)) {
  view_.width = geometry.width;
  view_.height = geometry.height;
  tops_ = Buffer<float>(exec, static_cast<std::size_t>(height_field::plan_levels(view_)));
  view_.tops = tops_.data();
  elevation_ = Buffer<float>(exec, static_cast<std::size_t>(geometry.width) * geometry.height);
  view_.elevation = elevation_.data();
  update(SceneLayer::elevation,
         std::vector<float>(elevation_.size(), std::numeric_limits<float>::quiet_NaN()));
}

void HeightFieldScene::check(const Rectangle& r, std::size_t values) const {
  std::ostringstream fault;
  const bool inside = r.x >= 0 && r.y >= 0 && r.width >= 0 && r.height >= 0 &&
                      r.width <= geometry_.width - r.x && r.height <= geometry_.height - r.y;
  if (!inside)
    fault << "sensors: the rectangle x = " << r.x << ", y = " << r.y << ", width = " << r.width
          << ", height = " << r.height << " exceeds the grid of " << geometry_.width << " x "
          << geometry_.height << " cells";
  else if (static_cast<std::size_t>(r.width) * static_cast<std::size_t>(r.height) != values)
    fault << "sensors: " << values << " values for a rectangle of " << r.width << " x " << r.height
          << " cells";
  if (!fault.str().empty()) throw ConfigError(fault.str());
}

Buffer<float>& HeightFieldScene::buffer_of(SceneLayer layer) {
  switch (layer) {
    case SceneLayer::canopy_height:
      return canopy_;
    case SceneLayer::vegetation:
      return density_;
    case SceneLayer::airborne_sand:
      return airborne_sand_;
    case SceneLayer::elevation:
      break;
  }
  return elevation_;
}

void HeightFieldScene::update(SceneLayer layer, const std::vector<float>& values) {
  update(layer, whole(), values);
}

void HeightFieldScene::update(SceneLayer layer, const Rectangle& cells, const std::vector<float>& values) {
  check(cells, values.size());
  if (values.empty()) return;
  Buffer<float>& buffer = buffer_of(layer);
  if (!buffer) {
    if (std::none_of(values.begin(), values.end(), [](float v) { return v > 0; })) return;
    buffer = zeros(exec_, elevation_.size());
  }
  write(layer, cells, values);
  if (layer == SceneLayer::airborne_sand) {
    refresh_dust(cells);
    return;
  }
  if (layer == SceneLayer::elevation) {
    refresh_tops(cells);
    if (view_.dust) refresh_dust(cells);
    return;
  }
  if (!canopy_ || !density_) return;  // plants are seen where they have both height and density
  const bool first = !view_.canopy;
  view_.canopy = canopy_.data();
  view_.density = density_.data();
  refresh_tops(first ? whole() : cells);
}

void HeightFieldScene::set_micro_relief(std::shared_ptr<const MicroReliefSource> source) {
  const Snapshot& s = source->grid();
  const SceneGeometry grid{s.width, s.height, s.cell_size, s.origin_x, s.origin_y};
  if (!(grid == geometry_))
    throw ConfigError("sensors: the micro_relief is of a grid of " + std::to_string(s.width) + " x " +
                      std::to_string(s.height) + " cells, or of another place (allowed: the " +
                      std::to_string(geometry_.width) + " x " + std::to_string(geometry_.height) +
                      " cells of the ground)");
  has_micro_relief_ = true;
  if (micro_relief_)
    micro_relief_->set(std::move(source));
  else
    micro_relief_ = std::make_unique<SceneMicroRelief>(exec_, std::move(source));
}

void HeightFieldScene::write(SceneLayer layer, const Rectangle& cells, const std::vector<float>& values) {
  const float* from = values.data();
  if (!exec_.shares_memory()) {
    if (staging_.size() < values.size()) staging_ = Buffer<float>(exec_, values.size());
    staging_.upload(values);
    from = staging_.data();
  }
  const height_field::Sane sane =
      layer == SceneLayer::elevation ? height_field::Sane::heights : height_field::Sane::amounts;
  with_backend(exec_, [&](auto& exec) {
    height_field::write_rectangle(exec, from, cells, sane, geometry_.width, buffer_of(layer).data());
  });
}

void HeightFieldScene::refresh_tops(const Rectangle& cells) {
  with_backend(exec_, [&](auto& exec) { height_field::refresh_tops(exec, view_, cells, tops_.data()); });
}

void HeightFieldScene::refresh_dust(const Rectangle& cells) {
  const bool first = !view_.dust;
  if (first) {
    const auto along = [](int n) {
      return static_cast<std::size_t>(height_field::blocks_along(n, height_field::dust_side));
    };
    const std::size_t blocks = along(geometry_.width) * along(geometry_.height);
    dust_ = Buffer<float>(exec_, blocks);
    dust_ground_ = Buffer<float>(exec_, blocks);
    view_.dust = dust_.data();
    view_.dust_ground = dust_ground_.data();
  }
  with_backend(exec_, [&](auto& exec) {
    height_field::refresh_dust(exec, view_, airborne_sand_.data(), first ? whole() : cells, dust_.data(),
                               dust_ground_.data());
  });
}

}  // namespace desert_sim
