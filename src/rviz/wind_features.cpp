#include "src/rviz/wind_features.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

#include "src/core/constants.hpp"
#include "src/render/draped_line.hpp"

namespace desert_sim {

namespace {

using Line = std::vector<render::Place>;
using Lines = std::vector<Line>;

/// The point at so much along a direction [rad] from another one, and across it, to its left.
render::Place beside(const render::Place& from, double angle, double along, double across) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {from.x + along * c - across * s, from.y + along * s + across * c};
}

/// The head of an arrow that points along `angle` [rad].
Line head(const render::Place& tip, double angle, double size) {
  return {beside(tip, angle, -size, 0.5 * size), tip, beside(tip, angle, -size, -0.5 * size)};
}

void add_vortex(Lines& lines, const render::Place& centre, double radius, bool clockwise) {
  lines.push_back(render::circle(centre, radius));
  for (int n = 0; n < 4; ++n) {
    const double angle = n * pi / 2, turned = clockwise ? -pi / 2 : pi / 2;
    lines.push_back(head(beside(centre, angle, radius, 0), angle + turned, 0.25 * radius));
  }
}

void add_sink(Lines& lines, const render::Place& centre, double radius, bool outward) {
  lines.push_back(render::circle(centre, radius));
  for (int n = 0; n < 4; ++n) {
    const double angle = n * pi / 2, from = (outward ? 0.3 : 1) * radius, to = (outward ? 1 : 0.3) * radius;
    lines.push_back({beside(centre, angle, from, 0), beside(centre, angle, to, 0)});
    lines.push_back(head(beside(centre, angle, to, 0), outward ? angle : angle + pi, 0.25 * radius));
  }
}

void add_jet(Lines& lines, const render::Place& centre, const WindFeatureItem& f) {
  const double angle = f.direction_deg * pi / 180;
  const Line circle = render::circle({0, 0}, 1);
  Line ellipse;
  for (const render::Place& p : circle)
    ellipse.push_back(beside(centre, angle, f.length * p.x, f.radius * p.y));
  lines.push_back(ellipse);
  const double sense = f.speed < 0 ? -1 : 1;
  const render::Place begin = beside(centre, angle, -sense * f.length, 0),
                      end = beside(centre, angle, sense * f.length, 0);
  lines.push_back({begin, end});
  lines.push_back(head(end, sense < 0 ? angle + pi : angle, 0.25 * f.length));
}

void add_turbulence(Lines& lines, const render::Place& centre, const WindFeatureItem& f) {
  const Line circle = render::circle(centre, f.radius);
  constexpr std::size_t dash = 4;
  for (std::size_t n = 0; n + dash < circle.size(); n += 2 * dash)
    lines.emplace_back(circle.begin() + static_cast<std::ptrdiff_t>(n),
                       circle.begin() + static_cast<std::ptrdiff_t>(n + dash + 1));
  const double eddy = 0.5 * std::min(f.scale, f.radius);  // as wide as an eddy, or the patch
  for (int n = 0; n < 3; ++n)
    lines.push_back(render::circle(beside(centre, pi / 2 + 2 * pi / 3 * n, 0.5 * f.radius, 0), 0.5 * eddy));
}

}  // namespace

bool is_there(const WindFeatureItem& f, double time) {
  return time >= f.begin && (f.end == 0 || time < f.end);
}

render::Place centre_at(const WindFeatureItem& f, double time) {
  if (!f.path.empty()) {
    const auto next =
        std::upper_bound(f.path.begin(), f.path.end(), time,
                         [](double t, const WindFeaturePoint& point) { return t < point.time; });
    const WindFeaturePoint& from = next == f.path.begin() ? *next : *(next - 1);
    const WindFeaturePoint& to = next == f.path.end() ? from : *next;
    const double share = to.time > from.time ? (time - from.time) / (to.time - from.time) : 0;
    return {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)};
  }
  return {f.center.x + f.velocity.x * (time - f.begin), f.center.y + f.velocity.y * (time - f.begin)};
}

void put_at(WindFeatureItem& f, const render::Place& place, double time) {
  if (!f.path.empty()) {
    const render::Place now = centre_at(f, time);
    for (WindFeaturePoint& point : f.path) {
      point.x += place.x - now.x;
      point.y += place.y - now.y;
    }
    return;
  }
  f.center.x = place.x - f.velocity.x * (time - f.begin);
  f.center.y = place.y - f.velocity.y * (time - f.begin);
}

EditWind::Request wind_request(const std::string& operation, const WindFeatureItem& feature) {
  EditWind::Request request;
  request.operation = operation;
  request.id = feature.id;
  request.kind = feature.kind;
  if (feature.path.empty()) {
    request.center = feature.center;
    request.velocity = feature.velocity;
  }
  request.path = feature.path;
  request.radius = feature.radius;
  request.speed = feature.speed;
  if (has_direction(feature)) {
    request.direction_deg = feature.direction_deg;
    request.length = feature.length;
  }
  if (has_eddies(feature)) {
    request.scale = feature.scale;
    request.life_time = feature.life_time;
    request.seed = feature.seed;
  }
  request.begin = feature.begin;
  request.end = feature.end;
  return request;
}

EditWind::Request wind_removal(int id) {
  EditWind::Request request;
  request.operation = EditWind::Request::REMOVE;
  request.id = id;
  return request;
}

int free_id(const WindFeatures& features, int after) {
  const auto next = [](int id) { return id < std::numeric_limits<int>::max() ? id + 1 : 1; };
  int id = next(std::max(after, 0));
  while (std::any_of(features.begin(), features.end(), [&](const WindFeatureItem& f) { return f.id == id; }))
    id = next(id);
  return id;
}

void apply_to(WindFeatures& features, const EditWind::Request& done) {
  if (done.operation == EditWind::Request::CLEAR) return features.clear();
  const auto same = std::find_if(features.begin(), features.end(),
                                 [&](const WindFeatureItem& f) { return f.id == done.id; });
  if (done.operation == EditWind::Request::REMOVE) {
    if (same != features.end()) features.erase(same);
    return;
  }
  WindFeatureItem item;
  item.id = done.id;
  item.kind = done.kind;
  item.center = done.center;
  item.direction_deg = done.direction_deg;
  item.radius = done.radius;
  item.speed = done.speed;
  item.length = done.length;
  item.scale = done.scale;
  item.life_time = done.life_time;
  item.seed = done.seed;
  item.begin = done.begin;
  item.end = done.end;
  item.velocity = done.velocity;
  item.path = done.path;
  if (same != features.end())
    *same = item;
  else
    features.push_back(item);
}

std::string path_text(const WindFeatureItem& f) {
  std::string all;
  for (const WindFeaturePoint& point : f.path) {
    char text[100];
    std::snprintf(text, sizeof text, "%s%.10g %.10g %.10g", all.empty() ? "" : "; ", point.time, point.x,
                  point.y);
    all += text;
  }
  return all;
}

std::optional<std::vector<WindFeaturePoint>> path_of(const std::string& text) {
  std::vector<WindFeaturePoint> path;
  if (text.find_first_not_of(" ;") == std::string::npos) return path;
  std::istringstream points(text);
  for (std::string one; std::getline(points, one, ';');) {
    std::istringstream numbers(one);
    WindFeaturePoint point;
    if (!(numbers >> point.time >> point.x >> point.y) || !(numbers >> std::ws).eof()) return {};
    path.push_back(point);
  }
  return path;
}

std::string words_of(const WindFeatureItem& f) {
  char text[160];
  if (has_direction(f))
    std::snprintf(text, sizeof text, ": %.3g m/s to %.0f deg, half length %.3g m, half width %.3g m", f.speed,
                  f.direction_deg, f.length, f.radius);
  else
    std::snprintf(text, sizeof text, ": %.3g m/s, radius %.3g m", f.speed, f.radius);
  std::string words = f.kind + (f.id == 0 ? "" : " " + std::to_string(f.id)) + text;
  std::snprintf(text, sizeof text, ", from %.6g s", f.begin);
  if (f.begin > 0) words += text;
  if (!f.path.empty()) words += ", on a path of " + std::to_string(f.path.size()) + " points";
  std::snprintf(text, sizeof text, ", until %.6g s", f.end);
  return words + (f.end > 0 ? text : "");
}

std::vector<std::vector<render::Place>> outline(const WindFeatureItem& f, double time) {
  const render::Place centre = centre_at(f, time);
  Lines lines;
  if (has_direction(f))
    add_jet(lines, centre, f);
  else if (has_eddies(f))
    add_turbulence(lines, centre, f);
  else if (f.kind == EditWind::Request::SINK)
    add_sink(lines, centre, f.radius, f.speed < 0);
  else
    add_vortex(lines, centre, f.radius, f.speed < 0);
  if (!f.path.empty()) {
    Line& path = lines.emplace_back();
    for (const WindFeaturePoint& point : f.path) path.push_back({point.x, point.y});
  }
  const double arm = cross_of(f);
  lines.push_back({{centre.x - arm, centre.y}, {centre.x + arm, centre.y}});
  lines.push_back({{centre.x, centre.y - arm}, {centre.x, centre.y + arm}});
  return lines;
}

double cross_of(const WindFeatureItem& f) { return 0.1 * f.radius; }

render::PackedColour feature_colour(const WindFeatureItem& f) {
  if (has_direction(f)) return render::pack({0.5f, 0.05f, 0.75f});
  if (has_eddies(f)) return render::pack({1, 1, 1});
  if (f.kind == EditWind::Request::SINK) return render::pack({0.8f, 0.05f, 0.1f});
  return render::pack({0.05f, 0.3f, 1});
}

}  // namespace desert_sim
