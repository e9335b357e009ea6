#include "src/scenario/growth_curves.hpp"

#include "src/scenario/presets.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

constexpr Presets::Row curve_preset_rows[] = {
#include "desert_sim/growth_curves_presets.inc"
};
constexpr Presets curve_presets(curve_preset_rows);

constexpr ParameterRow burial_range{"burial", -most_burial, most_burial, "m/year", "", nullptr, 0};
constexpr ParameterRow growth_range{"growth", -most_growth, most_growth, "1/year", "", nullptr, 0};

/// Whether both numbers of a point are read; adds an error for each that is not.
bool read_point(const YAML::Node& point, const std::string& key, ValidationErrors& errors,
                GrowthCurve& curve) {
  if (!point.IsSequence() || point.size() != 2) {
    errors.add(key, yaml::node_text(point) + " is given where a point [burial, growth] is expected");
    return false;
  }
  float buried = 0, growth = 0;
  const bool has_burial = yaml::read_float(point[0], burial_range, key + ".0", errors, buried);
  const bool has_growth = yaml::read_float(point[1], growth_range, key + ".1", errors, growth);
  if (!has_burial || !has_growth) return false;
  if (curve.count > 0 && !(buried > curve.burial[curve.count - 1])) {
    errors.add(key + ".0",
               yaml::node_text(point[0]) +
                   " must be above the burial of the point before: points are in ascending order");
    return false;
  }
  curve.burial[curve.count] = buried;
  curve.growth[curve.count++] = growth;
  return true;
}

void read_curve(const YAML::Node& list, const std::string& key, ValidationErrors& errors,
                GrowthCurve& curve) {
  if (!list.IsSequence() || list.size() < 2 || list.size() > GrowthCurve::capacity)
    return errors.add(
        key, (list.IsSequence() ? "has " + std::to_string(list.size()) + " points" : yaml::node_text(list)) +
                 " where a list of 2 to " + std::to_string(GrowthCurve::capacity) +
                 " points [burial, growth] is expected");
  GrowthCurve read;
  for (std::size_t n = 0; n < list.size(); ++n)
    if (!read_point(list[n], key + "." + std::to_string(n), errors, read)) return;
  curve = read;
}

void read_curves(const YAML::Node& map, const std::string& path, ValidationErrors& errors,
                 GrowthCurves& curves) {
  std::set<std::string> known;
  for (int k = 0; k < GrowthCurves::kinds; ++k) {
    const std::string kind = growth_curve_names[k];
    known.insert(kind);
    if (map.IsMap() && map[kind].IsDefined()) read_curve(map[kind], path + kind, errors, curves.of[k]);
  }
  yaml::reject_unknown_keys(map, path, known, errors);
}

}  // namespace

GrowthCurves read_growth_curves(const YAML::Node& root, ValidationErrors& errors) {
  GrowthCurves curves;
  ValidationErrors errors_of_preset("config/growth_curves/nield_baas.yaml");
  read_curves(YAML::Load(curve_presets.text("nield_baas")), "", errors_of_preset, curves);
  errors_of_preset.throw_if_any();
  const YAML::Node given = root["growth_curves"];
  if (given.IsDefined() && !given.IsNull()) read_curves(given, "growth_curves.", errors, curves);
  return curves;
}

void emit_growth_curves(YAML::Emitter& out, const GrowthCurves& curves) {
  out << YAML::Key << "growth_curves" << YAML::Value << YAML::BeginMap;
  for (int k = 0; k < GrowthCurves::kinds; ++k) {
    const GrowthCurve& curve = curves.of[k];
    out << YAML::Key << growth_curve_names[k] << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (int n = 0; n < curve.count; ++n)
      out << YAML::Flow << YAML::BeginSeq << curve.burial[n] << curve.growth[n] << YAML::EndSeq;
    out << YAML::EndSeq;
  }
  out << YAML::EndMap;
}

}  // namespace desert_sim
