#include "src/tools/oblique_view.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "src/core/did_you_mean.hpp"
#include "src/core/parameter_page.hpp"
#include "src/export/snapshot_scene.hpp"
#include "src/render/level_of_detail.hpp"
#include "src/render/sky.hpp"
#include "src/render/sunlight.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/terrain/map_layers.hpp"

namespace desert_sim {

namespace {

constexpr double pi = 3.14159265358979323846, radians = pi / 180;
constexpr int samples = 2;                  // a side of a pixel
constexpr int drawn_triangles = 4'000'000;  // at most, of the ground

render::Overlay overlay_of(const std::string& layer, double low, double high) {
  render::Overlay overlay;
  if (layer.empty()) return overlay;
  const render::LayerStyle style = render::layer_style(layer);
  const bool usual = low == high;
  overlay.layer = layer;
  overlay.low = usual ? style.low : static_cast<float>(low);
  overlay.high = usual ? style.high : static_cast<float>(high);
  overlay.map = style.map;
  return overlay;
}

/// Relief becomes visible, but a mountain stays a mountain: heights span at least a twelfth of the terrain's
/// length.
double chosen_exaggeration(const Snapshot& s, double relief) {
  const double length = s.cell_size * std::max(s.width, s.height);
  return relief > 0 ? std::clamp(length / 12 / relief, 1.0, 20.0) : 1.0;
}

/// All cells of the ground lie in this box of a block, with true heights.
std::vector<render::Box> boxes_of(const render::BlockLayout& layout, double cell_size, double lowest,
                                  double highest) {
  std::vector<render::Box> boxes;
  for (int block = 0; block < layout.count(); ++block) {
    const render::CellRectangle cells = layout.vertices(block);
    boxes.emplace_back(render::Point(cells.x * cell_size, cells.y * cell_size, lowest),
                       render::Point(cells.right() * cell_size, cells.top() * cell_size, highest));
  }
  return boxes;
}

std::vector<render::TerrainBlock> blocks_of(const Snapshot& s, const std::vector<int>& levels,
                                            const render::TerrainGrid& grid,
                                            const render::TerrainLook& look) {
  const render::LayerWindow windows = layer_windows(s);
  std::vector<render::TerrainBlock> blocks(levels.size());
#pragma omp parallel for schedule(dynamic)
  for (int block = 0; block < grid.layout.count(); ++block)
    blocks[static_cast<std::size_t>(block)] =
        render::build_terrain_block(grid, block, levels[static_cast<std::size_t>(block)], windows, look);
  return blocks;
}

/// The sky behind each pixel. The camera looks down, so that the horizon is not in its picture: the terrain
/// stands before the sky as a block diagram does, from the horizon at the lower edge upwards.
std::vector<render::PackedColour> sky_behind(double camera_azimuth_deg, int width, int height) {
  constexpr double highest = 0.5;  // of the sky, at the upper edge [rad]
  const double azimuth = camera_azimuth_deg * radians + pi;
  std::vector<render::PackedColour> sky;
  sky.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int row = 0; row < height; ++row) {
    const double elevation = highest * (1 - (row + 0.5) / height);
    const render::Point direction(std::cos(elevation) * std::cos(azimuth),
                                  std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    sky.insert(sky.end(), static_cast<std::size_t>(width), render::pack(render::sky_colour(direction)));
  }
  return sky;
}

render::TerrainLook look_of(const ViewParameters& p) {
  render::TerrainLook look;
  look.overlay = overlay_of(p.overlay, p.overlay_low, p.overlay_high);
  look.second = overlay_of(p.second_overlay, p.second_low, p.second_high);
  if (p.divide > 0) look.divide = p.divide;
  look.shading = p.shading;
  look.water = p.water;
  look.contour_interval = p.contour_interval;
  return look;
}

}  // namespace

ViewParameters view_parameters(const std::vector<std::string>& settings) {
  YAML::Node given(YAML::NodeType::Map);
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) throw ConfigError("--view " + in_quotes(setting) + ": is not KEY=VALUE");
    given[setting.substr(0, equals)] = setting.substr(equals + 1);
  }
  ViewParameters p;
  ValidationErrors errors("--view");
  std::set<std::string> known;
  yaml::read_parameters(given, "", errors, p, known);
  yaml::reject_unknown_keys(given, "", known, errors);
  for (const auto& [key, layer] : {std::pair("overlay", p.overlay), {"second_overlay", p.second_overlay}})
    if (!layer.empty() && !find_map_layer(layer)) errors.add(key, not_one_of(layer, map_layer_names()));
  if (p.divide > 0 && p.second_overlay.empty())
    errors.add("divide", "is set, but there is no second_overlay to stand beside the first one");
  errors.throw_if_any();
  return p;
}

std::string describe_view() {
  std::ostringstream out;
  write_parameter_table(out, ViewParameters{});
  return out.str();
}

ObliqueView::ObliqueView(const ViewParameters& parameters)
    : parameters_(parameters), rasteriser_(parameters.width, parameters.height, samples) {}

void ObliqueView::set_up(const Snapshot& s, double lowest, double highest) {
  exaggeration_ =
      parameters_.exaggeration > 0 ? parameters_.exaggeration : chosen_exaggeration(s, highest - lowest);
  const double width = s.width * s.cell_size, height = s.height * s.cell_size;
  bounds_ =
      render::Box(render::Point(0, 0, lowest * exaggeration_ - render::wall_share * std::max(width, height)),
                  render::Point(width, height, highest * exaggeration_));
  sky_ = sky_behind(parameters_.azimuth_deg, rasteriser_.width(), rasteriser_.height());
}

render::Picture ObliqueView::draw(Simulation& simulation) {
  render::TerrainLook look = look_of(parameters_);
  const auto snapshot = simulation.views().snapshot(layers_of(look));
  const Snapshot& s = *snapshot;
  const std::vector<float>& elevation = *s.find(Layer::elevation);
  const auto range = std::minmax_element(elevation.begin(), elevation.end());
  const auto lowest = static_cast<double>(*range.first), highest = static_cast<double>(*range.second);
  if (exaggeration_ == 0) set_up(s, lowest, highest);
  look.vertical_exaggeration = exaggeration_;
  look.palette = s.palette;

  const render::Projection projection({parameters_.azimuth_deg, parameters_.elevation_deg, parameters_.zoom},
                                      bounds_, rasteriser_.width(), rasteriser_.height());
  const render::BlockLayout layout(s.width, s.height);
  const std::vector<render::Box> boxes = boxes_of(layout, s.cell_size, lowest, highest);
  const std::vector<int> levels =
      render::choose_levels(layout, s.cell_size, projection.view(exaggeration_), boxes,
                            std::vector<int>(boxes.size(), -1), {samples, drawn_triangles});
  const render::TerrainGrid grid{layout,
                                 s.cell_size,
                                 static_cast<float>(bounds_.min().z() / exaggeration_),
                                 render::shadow_reach(exaggeration_ * (highest - lowest), s.cell_size),
                                 {}};
  const std::vector<render::TerrainBlock> blocks = blocks_of(s, levels, grid, look);

  rasteriser_.clear(sky_);
  for (const render::TerrainBlock& block : blocks) rasteriser_.draw(block.ground, projection, exaggeration_);
  for (const render::TerrainBlock& block : blocks)
    rasteriser_.draw_lines(block.contours, projection, exaggeration_);
  if (parameters_.plants)  // their feet are exaggerated already
    rasteriser_.draw(plants_of(*simulation.views().begin_plants().get(), exaggeration_), projection, 1);
  for (const render::TerrainBlock& block : blocks) rasteriser_.blend(block.water, projection, exaggeration_);
  return rasteriser_.picture();
}

}  // namespace desert_sim
