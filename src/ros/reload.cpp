#include "desert_sim/ros/reload.hpp"

#include <ros/console.h>

#include "desert_sim/grid_map/grid_map_bag.hpp"
#include "desert_sim/scenario/live_parameters.hpp"
#include "desert_sim/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

template <class P>
std::vector<std::string> texts(const P& parameters) {
  std::vector<std::string> all;
  for_each_parameter(parameters, [&](const auto& row, const auto& value) {
    std::ostringstream text;
    text.precision(17);
    if constexpr (std::is_enum_v<std::decay_t<decltype(value)>>)
      text << row.choices[static_cast<int>(value)];
    else
      text << std::boolalpha << value;
    all.push_back(std::string(row.name) + "=" + text.str());
  });
  return all;
}

std::string shown(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

void add(std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; }

/// The node's own parameters are read at its start only.
template <class P>
void add_differences(const P& before, const P& now, std::string& list) {
  const std::vector<std::string> old = texts(before), fresh = texts(now);
  for (std::size_t n = 0; n < fresh.size(); ++n)
    if (old[n] != fresh[n]) add(list, fresh[n]);
}

}  // namespace

Reload::Reload(ros::NodeHandle node, NodeSetup setup, SimulationThread& simulation, Topics& topics,
               std::function<void(const Scenario&)> on_scenario)
    : node_(std::move(node)),
      last_(std::move(setup)),
      simulation_(simulation),
      topics_(topics),
      on_scenario_(std::move(on_scenario)) {
  service_ = node_.advertiseService("reload_parameters", &Reload::serve, this);
}

std::string Reload::reload() {
  const std::lock_guard<std::mutex> lock(mutex_);
  NodeSetup setup = read_node_setup(node_);
  resolve_grid(setup.scenario, raster_loader_with_bags());
  Settings settings;
  std::string applied, fixed;
  for (const auto& [path, value] : changed_parameters(last_.scenario, setup.scenario)) {
    const std::string setting = path + "=" + value;
    if (why_fixed(path)) {
      add(fixed, setting);
    } else {
      settings.push_back(setting);
      add(applied, setting);
    }
  }
  const double rate = setup.node.step_rate;
  if (rate != last_.node.step_rate) add(applied, "step_rate=" + shown(rate));
  NodeParameters others = setup.node;  // those that are read at the start only
  others.step_rate = last_.node.step_rate;
  add_differences(last_.node, others, fixed);
  add_differences(last_.publishers, setup.publishers, fixed);
  if (!settings.empty()) simulation_.apply(command::SetParameters{settings}).get();
  if (rate != last_.node.step_rate) simulation_.set_step_rate(rate).get();
  last_.node.step_rate = rate;
  on_scenario_(setup.scenario);
  last_.scenario = with_live_settings(last_.scenario, settings);  // what is fixed is told again next time
  return (applied.empty() ? "nothing to apply" : "applied: " + applied) +
         (fixed.empty() ? "" : "; needs a restart of the node: " + fixed);
}

bool Reload::serve(std_srvs::TriggerRequest&, std_srvs::TriggerResponse& response) {
  try {
    response.message = reload();
    response.success = true;
    ROS_INFO("reload_parameters: %s", response.message.c_str());
    topics_.status_changed();
  } catch (const std::exception& e) {
    response.message = e.what();
    response.success = false;
  }
  return true;
}

}  // namespace desert_sim
