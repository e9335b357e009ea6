/// Services for the parameters of a scenario as YAML has them.

#include <desert_sim/ApplySettings.h>
#include <desert_sim/GetScenario.h>

#include "src/ros/services/services.hpp"

namespace desert_sim {

void add_parameter_services(Services& services) {
  const ServiceContext& c = services.context();
  services.add<ApplySettings>(
      "apply_settings", [&c](const ApplySettingsRequest& request, ApplySettingsResponse&) {
        c.simulation.apply(command::SetParameters{request.settings, request.ramp, request.stroke}).get();
        c.publisher.status_changed();
      });
  services.add<GetScenario>(
      "get_scenario", [&c](const GetScenarioRequest& request, GetScenarioResponse& response) {
        const Scenario scenario =
            request.start != 0 ? c.simulation.scenario_at_start().get() : c.simulation.scenario().get();
        response.name = scenario.name;
        response.yaml = dump_scenario(scenario);
      });
}

}  // namespace desert_sim
