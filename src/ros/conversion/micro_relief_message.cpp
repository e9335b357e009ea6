#include "src/ros/conversion/micro_relief_message.hpp"

#include <yaml-cpp/yaml.h>

#include <boost/make_shared.hpp>
#include <cmath>

#include "kernels/micro_relief/ripple_size.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/scenario/yaml_document.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

std::string text_of(const MicroReliefParameters& parameters) {
  YAML::Emitter out;
  yaml::set_full_precision(out);
  out << YAML::BeginMap;
  yaml::emit_parameters(out, parameters);
  out << YAML::EndMap;
  return out.c_str();
}

void read_section(const std::string& text, MicroReliefParameters& parameters, ValidationErrors& errors) {
  try {
    yaml::read_section(yaml::load_document(text), "parameters", errors, parameters);
  } catch (const YAML::Exception& e) {
    errors.add("parameters", e.what());
  }
}

void check_number(double value, double lowest, double highest, const char* key, ValidationErrors& errors) {
  if (value >= lowest && value <= highest) return;
  errors.add(key, std::to_string(value) + " is not in [" + limit_text<double>(lowest) + ", " +
                      limit_text<double>(highest) + "]");
}

}  // namespace

MicroReliefStatePtr micro_relief_message(const TerrainState& state, const std::string& frame) {
  const Snapshot& s = *state.snapshot;
  MicroReliefStatePtr message = boost::make_shared<MicroReliefState>();
  message->header = header_of(state.moment, frame);
  message->step = s.step;
  message->sim_time = s.time;
  message->parameters = text_of(s.micro_relief.parameters);
  message->seed = s.micro_relief.seed;
  message->mean_wind_x = s.micro_relief.wind.x;
  message->mean_wind_y = s.micro_relief.wind.y;
  message->mean_speed = s.micro_relief.wind.speed;
  message->ripples_passed = s.micro_relief.wind.passed;
  const micro_relief::RippleSize size(s.micro_relief.parameters);
  const auto speed = static_cast<float>(s.micro_relief.wind.speed);
  message->ripple_height = size.height(speed);
  message->ripple_wavelength = message->ripple_height > 0 ? size.wavelength(speed) : 0;
  message->wind_above = vector_of(s.wind_above);
  message->repose_tangent = s.micro_relief.repose_tangent;
  message->moisture_capacity = s.micro_relief.moisture_capacity;
  message->moisture_depth = s.micro_relief.moisture_depth;
  message->moisture_cutoff = s.micro_relief.moisture_cutoff;
  message->periodic_x = s.periodic_x;
  message->periodic_y = s.micro_relief.periodic_y;
  message->plants_live = s.micro_relief.plants_live;
  return message;
}

Snapshot snapshot_of(const MicroReliefState& m) {
  constexpr double fastest = 1e3, least = 1e-6, most = 1e6;
  Snapshot s;
  ValidationErrors errors("micro_relief");
  read_section(m.parameters, s.micro_relief.parameters, errors);
  s.micro_relief.wind = {m.mean_wind_x, m.mean_wind_y, m.mean_speed, m.ripples_passed};
  for_each_parameter(s.micro_relief.wind, [&errors](const auto& row, double value) {
    check_number(value, row.lowest, row.highest, row.name, errors);
  });
  check_number(m.wind_above.x, -fastest, fastest, "wind_above.x", errors);
  check_number(m.wind_above.y, -fastest, fastest, "wind_above.y", errors);
  check_number(double{m.repose_tangent}, least, most, "repose_tangent", errors);
  check_number(double{m.moisture_capacity}, least, most, "moisture_capacity", errors);
  check_number(double{m.moisture_depth}, least, most, "moisture_depth", errors);
  check_number(double{m.moisture_cutoff}, least, most, "moisture_cutoff", errors);
  errors.throw_if_any();
  s.step = m.step;
  s.time = m.sim_time;
  s.wind_above = {static_cast<float>(m.wind_above.x), static_cast<float>(m.wind_above.y)};
  s.micro_relief.seed = m.seed;
  s.micro_relief.repose_tangent = m.repose_tangent;
  s.micro_relief.moisture_capacity = m.moisture_capacity;
  s.micro_relief.moisture_depth = m.moisture_depth;
  s.micro_relief.moisture_cutoff = m.moisture_cutoff;
  s.periodic_x = m.periodic_x;
  s.periodic_y = s.micro_relief.periodic_y = m.periodic_y;
  s.micro_relief.plants_live = m.plants_live;
  return s;
}

}  // namespace desert_sim
