#include "src/scenario/wind_feature_lists.hpp"

#include <utility>

#include "src/core/number_text.hpp"
#include "src/scenario/scenario.hpp"
#include "src/scenario/yaml_lists.hpp"

namespace desert_sim {

namespace {

constexpr const char* path_key = "path";

}  // namespace

void read_wind_path(const YAML::Node& list, const std::string& key, ValidationErrors& errors,
                    std::vector<WindPathPoint>& path) {
  yaml::read_items(list, key, max_wind_path, errors, path);
}

void read_wind_features(const YAML::Node& list, const std::string& key, ValidationErrors& errors,
                        std::vector<WindFeature>& features) {
  if (!yaml::is_list(list, key, max_wind_features, errors)) return;
  for (std::size_t n = 0; n < list.size(); ++n) {
    const std::string item = key + "." + std::to_string(n) + ".";
    WindFeature& feature = features.emplace_back();
    std::set<std::string> known{path_key};
    yaml::read_parameters(list[n], item, errors, static_cast<WindFeatureParameters&>(feature), known);
    yaml::reject_unknown_keys(list[n], item, known, errors);
    if (list[n].IsMap()) read_wind_path(list[n][path_key], item + path_key, errors, feature.path);
  }
}

void emit_wind_feature(YAML::Emitter& out, const WindFeature& feature) {
  yaml::emit_parameters(out, static_cast<const WindFeatureParameters&>(feature));
  if (!feature.path.empty()) yaml::emit_items(out, path_key, feature.path);
}

void emit_wind_features(YAML::Emitter& out, const std::vector<WindFeature>& features) {
  out << YAML::Key << "features" << YAML::Value << YAML::BeginSeq;
  for (const WindFeature& feature : features) {
    out << YAML::Flow << YAML::BeginMap;
    emit_wind_feature(out, feature);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

void check_wind_feature(const WindFeature& f, const std::string& prefix, ValidationErrors& errors) {
  if (!ends_after_begin(f)) errors.add(prefix + "end", end_before_begin);
  if (f.path.empty()) return;
  const std::string path = prefix + path_key;
  if (f.path.size() < 2 || f.path.size() > max_wind_path)
    errors.add(path, std::to_string(f.path.size()) + " points are given (allowed: 2 to " +
                         std::to_string(max_wind_path) + ")");
  for (std::size_t n = 1; n < f.path.size(); ++n)
    if (!(f.path[n].time > f.path[n - 1].time))
      errors.add(path + "." + std::to_string(n) + ".time",
                 number_text(f.path[n].time, 6) + " s is not after the " +
                     number_text(f.path[n - 1].time, 6) + " s of the point before");
  const std::pair<const char*, double> places[] = {
      {"x", f.x}, {"y", f.y}, {"velocity_x", f.velocity_x}, {"velocity_y", f.velocity_y}};
  for (const auto& [key, value] : places)
    if (value != 0)
      errors.add(prefix + key,
                 "is given beside `path`, which says where the feature is (allowed: one of both)");
}

}  // namespace desert_sim
