#include "src/ros/node/reload_parameters.hpp"

#include <ros/console.h>

#include "src/core/number_text.hpp"
#include "src/grid_map/grid_map_bag.hpp"
#include "src/ros/parameters/reconfigure_messages.hpp"
#include "src/scenario/live_parameters.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

/// Collects "name=value" of the parameters of tables.
struct Texts {
  std::vector<std::string> all;

  template <class Row, class T>
  void operator()(const Row& row, const T& value) {
    std::ostringstream text;
    text.precision(17);
    if constexpr (std::is_enum_v<T>)
      text << row.choices[static_cast<int>(value)];
    else
      text << std::boolalpha << value;
    all.push_back(std::string(row.name) + "=" + text.str());
  }
};

std::vector<std::string> texts(const NodeParameters& node) {
  Texts texts;
  for_each_parameter(node, texts);
  return texts.all;
}

std::vector<std::string> texts(const PublisherSetup& setup) {
  Texts texts;
  for_each_parameter(setup.topics, texts);
  for_each_parameter(setup.maps.parameters, texts);
  texts.all.push_back("layer_thresholds=" + yaml_map(setup.layer_thresholds));
  texts.all.push_back("grid_map_layers=" + yaml_list(setup.maps.grid_map_layers));
  texts.all.push_back("local_map_layers=" + yaml_list(setup.maps.local_map_layers));
  return texts.all;
}

void add(std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; }

template <class P>
void add_differences(const P& before, const P& now, std::string& list) {
  const std::vector<std::string> old = texts(before), current = texts(now);
  for (std::size_t n = 0; n < current.size(); ++n)
    if (old[n] != current[n]) add(list, current[n]);
}

template <class P>
void copy_differences(const P& before, const P& now, P& present) {
  const auto copy_if_changed = [&](const auto& row) {
    if (before.*(row.member) != now.*(row.member)) present.*(row.member) = now.*(row.member);
  };
  std::apply([&](const auto&... row) { (copy_if_changed(row), ...); }, table_of<P>());
}

/// `present` with the values that differ between two readings. What clients of ~set_parameters have changed
/// otherwise stays.
PublisherSetup with_differences(const PublisherSetup& before, const PublisherSetup& now,
                                PublisherSetup present) {
  copy_differences(before.topics, now.topics, present.topics);
  copy_differences(before.maps.parameters, now.maps.parameters, present.maps.parameters);
  if (before.layer_thresholds != now.layer_thresholds) present.layer_thresholds = now.layer_thresholds;
  if (yaml_list(before.maps.grid_map_layers) != yaml_list(now.maps.grid_map_layers))
    present.maps.grid_map_layers = now.maps.grid_map_layers;
  if (yaml_list(before.maps.local_map_layers) != yaml_list(now.maps.local_map_layers))
    present.maps.local_map_layers = now.maps.local_map_layers;
  return present;
}

}  // namespace

ParameterReload::ParameterReload(ros::NodeHandle node, NodeSetup setup, SimulationThread& simulation,
                                 TopicPublisher& publisher, std::function<void(const Scenario&)> on_scenario)
    : node_(node),
      last_(std::move(setup)),
      simulation_(simulation),
      publisher_(publisher),
      on_scenario_(std::move(on_scenario)) {
  service_ = node_.advertiseService("reload_parameters", &ParameterReload::serve, this);
}

std::string ParameterReload::reload() {
  const std::lock_guard<std::mutex> lock(mutex_);
  NodeSetup setup = read_node_setup(node_);
  resolve_grid(setup.scenario, raster_loader_with_bags({"", setup.node.all_raster_formats}));
  Settings settings;
  std::string applied, fixed;
  for (const auto& [path, value] : changed_parameters(last_.scenario, setup.scenario)) {
    const std::string setting = path + "=" + value;
    if (fixed_reason(path)) {
      add(fixed, setting);
    } else {
      settings.push_back(setting);
      add(applied, setting);
    }
  }
  const double rate = setup.node.step_rate;
  if (rate != last_.node.step_rate) {
    const std::string reason = ineffective_rate(rate, setup.scenario.run);
    add(applied, "step_rate=" + number_text(rate, 6) + (reason.empty() ? "" : " (" + reason + ")"));
  }
  NodeParameters others = setup.node;  // those that take effect at the start only
  others.step_rate = last_.node.step_rate;
  add_differences(last_.node, others, fixed);
  add_differences(last_.publishers, setup.publishers, applied);
  const PublisherSetup publishers =
      with_differences(last_.publishers, setup.publishers, publisher_.parameters());
  check_map_sizes(publishers.maps, simulation_.scenario().get().grid);
  if (!settings.empty()) simulation_.apply(command::SetParameters{settings}).get();
  if (rate != last_.node.step_rate) simulation_.set_step_rate(rate).get();
  last_.node.step_rate = rate;
  publisher_.set_parameters(publishers);
  last_.publishers = setup.publishers;
  on_scenario_(setup.scenario);
  last_.scenario =
      with_live_settings(last_.scenario, settings);  // what needs a restart is listed again next time
  return (applied.empty() ? "no parameter that can change live differs" : "applied: " + applied) +
         (fixed.empty() ? "" : "; these need a restart of the node: " + fixed);
}

bool ParameterReload::serve(std_srvs::TriggerRequest&, std_srvs::TriggerResponse& response) {
  try {
    response.message = reload();
    response.success = true;
    ROS_INFO("reload_parameters: %s", response.message.c_str());
    publisher_.status_changed();
  } catch (const std::exception& e) {
    response.message = e.what();
    response.success = false;
  }
  return true;
}

}  // namespace desert_sim
