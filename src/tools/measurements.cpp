#include "src/tools/measurements.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/sand/saltation.hpp"
#include "src/core/error.hpp"
#include "src/core/number_text.hpp"
#include "src/core/time_units.hpp"
#include "src/tools/points.hpp"

namespace desert_sim {

namespace {

int cell_of(double coordinate, double origin, double cell, int count) {
  return std::clamp(static_cast<int>(std::floor((coordinate - origin) / cell)), 0, count - 1);
}

/// Adds the shares of the way from a to b at which it crosses a border between cells, along one axis.
void add_crossings(double a, double b, double origin, double cell, std::vector<double>& shares) {
  const double first = (std::min(a, b) - origin) / cell, last = (std::max(a, b) - origin) / cell;
  for (double border = std::ceil(first); border <= last && a != b; ++border)
    shares.push_back(std::clamp((border * cell + origin - a) / (b - a), 0.0, 1.0));
}

/// Of a snapshot that may be a band of rows: the value of a cell of the whole terrain.
double value_of(const Snapshot& s, Layer layer, int x, int y, double origin_y) {
  const auto first = std::lround((s.origin_y - origin_y) / s.cell_size);
  return static_cast<double>(s.layers.at(layer).at(static_cast<std::size_t>((y - first) * s.width + x)));
}

}  // namespace

CrossSection::CrossSection(const std::string& text, const GridParameters& grid) {
  const std::string what = "--cross-section " + text;
  const std::size_t equals = text.find('=');
  const std::vector<double> ends =
      equals == std::string::npos ? std::vector<double>() : numbers_of(text.substr(equals + 1), 4);
  if (equals == 0 || ends.empty()) throw ConfigError(what + ": must be NAME=x1,y1,x2,y2");
  name_ = text.substr(0, equals);
  from_ = {ends[0], ends[1]};
  to_ = {ends[2], ends[3]};
  for (Point p : {from_, to_}) require_on_grid(p.x, p.y, grid, what);
  if (!(length() > 0)) throw ConfigError(what + ": both of its ends are the same point");
  origin_y_ = grid.origin_y;
  std::vector<double> shares{0, 1};
  add_crossings(from_.x, to_.x, grid.origin_x, grid.cell_size, shares);
  add_crossings(from_.y, to_.y, grid.origin_y, grid.cell_size, shares);
  std::sort(shares.begin(), shares.end());
  for (std::size_t n = 0; n + 1 < shares.size(); ++n) {
    const double middle = 0.5 * (shares[n] + shares[n + 1]);
    const double x = from_.x + middle * (to_.x - from_.x), y = from_.y + middle * (to_.y - from_.y);
    if (shares[n + 1] > shares[n])
      pieces_.push_back({cell_of(x, grid.origin_x, grid.cell_size, grid.width),
                         cell_of(y, grid.origin_y, grid.cell_size, grid.height),
                         (shares[n + 1] - shares[n]) * length()});
  }
}

double CrossSection::length() const { return std::hypot(to_.x - from_.x, to_.y - from_.y); }

void CrossSection::add(const Snapshot& flux, double duration) {
  const double left_x = -(to_.y - from_.y) / length(), left_y = (to_.x - from_.x) / length();
  double across = 0;
  for (const Piece& p : pieces_)
    across += p.length * (value_of(flux, Layer::flux_x, p.x, p.y, origin_y_) * left_x +
                          value_of(flux, Layer::flux_y, p.x, p.y, origin_y_) * left_y);
  volume_ += across * duration;
  duration_ += duration;
}

double CrossSection::per_metre_and_year() const {
  return duration_ > 0 ? volume_ / length() / duration_ * seconds_per_year : 0;
}

std::pair<int, int> CrossSection::rows() const {
  const auto [first, last] = std::minmax_element(pieces_.begin(), pieces_.end(),
                                                 [](const Piece& a, const Piece& b) { return a.y < b.y; });
  return {first->y, last->y};
}

Probes::Probes(const std::vector<std::string>& points, const GridParameters& grid) {
  origin_y_ = grid.origin_y;
  for (const std::string& text : points) {
    const std::vector<double> at = numbers_of(text, 2);
    if (at.empty()) throw ConfigError("--probe " + text + ": must be x,y");
    require_on_grid(at[0], at[1], grid, "--probe " + text);
    points_.push_back({{at[0], at[1]},
                       cell_of(at[0], grid.origin_x, grid.cell_size, grid.width),
                       cell_of(at[1], grid.origin_y, grid.cell_size, grid.height)});
  }
}

void Probes::add(const Snapshot& s, const std::vector<Layer>& layers) {
  if (csv_.empty()) {
    csv_ = "step,time,x,y,wind_above_speed,wind_above_direction";
    for (Layer layer : layers) csv_ += "," + std::string(info(layer).name);
    csv_ += "\n";
  }
  double speed = 0, direction = 0;
  speed_and_direction(s.wind_above, speed, direction);
  for (const Cell& cell : points_) {
    csv_ += std::to_string(s.step);
    for (double value : {s.time, cell.point.x, cell.point.y}) csv_ += "," + number_text(value, 15);
    for (double value : {speed, direction}) csv_ += "," + number_text(value, 7);
    for (Layer layer : layers) csv_ += "," + number_text(value_of(s, layer, cell.x, cell.y, origin_y_), 9);
    csv_ += "\n";
  }
}

std::pair<int, int> Probes::rows() const {
  const auto [first, last] = std::minmax_element(points_.begin(), points_.end(),
                                                 [](const Cell& a, const Cell& b) { return a.y < b.y; });
  return {first->y, last->y};
}

namespace {

/// What a probe shows of the layers in use.
std::vector<Layer> probed_layers(const Simulation& simulation) {
  std::vector<Layer> layers;
  for (Layer layer : simulation.state().layers_in_use())
    for (Layer shown :
         {Layer::elevation, Layer::sand, Layer::wind_x, Layer::wind_y, Layer::flux_x, Layer::flux_y})
      if (layer == shown) layers.push_back(layer);
  return layers;
}

RowBand band_of(std::pair<int, int> rows) { return {rows.first, rows.second - rows.first + 1}; }

}  // namespace

Measurements::Measurements(const std::vector<std::string>& cross_sections,
                           const std::vector<std::string>& probes, std::uint64_t probe_every,
                           const Scenario& scenario)
    : probes_(probes, scenario.grid), probe_every_(probe_every) {
  for (const std::string& section : cross_sections) cross_sections_.emplace_back(section, scenario.grid);
  if (!scenario.get<SaltationParameters>().enabled && !cross_sections.empty())
    throw ConfigError("--cross-section: saltation.enabled is false, so that the wind carries no sand");
}

void Measurements::keep_flux(Session& session) const {
  if (cross_sections_.empty() && probes_.empty()) return;
  const SaltationParameters& saltation = session.simulation().scenario().get<SaltationParameters>();
  if (saltation.enabled && !saltation.flux) session.apply(command::SetParameters{{"saltation.flux=true"}, 0});
}

void Measurements::add(Simulation& simulation, double duration) {
  for (CrossSection& section : cross_sections_)
    section.add(*simulation.views().snapshot({Layer::flux_x, Layer::flux_y}, band_of(section.rows())),
                duration);
  if (probes_.empty() || simulation.steps() % probe_every_ != 0) return;
  const std::vector<Layer> layers = probed_layers(simulation);
  probes_.add(*simulation.views().snapshot(layers, band_of(probes_.rows())), layers);
}

}  // namespace desert_sim
