/// Services that let the simulation run, pause, step, and begin anew.

#include <desert_sim/Step.h>
#include <ros/console.h>
#include <std_srvs/Trigger.h>

#include "src/core/hash_text.hpp"
#include "src/ros/services/services.hpp"

namespace desert_sim {

void add_run_services(Services& services) {
  using std_srvs::Trigger;
  using Request = std_srvs::TriggerRequest;
  using Response = std_srvs::TriggerResponse;
  const ServiceContext& c = services.context();

  services.add<Step>(
      "step",
      [&c](const StepRequest& request, StepResponse& response) {
        const ReachedState reached = c.simulation.step(request.steps).get();
        c.publisher.publish_now();
        response.step = reached.moment.step;
        response.sim_time = reached.moment.time;
        response.state_hash = hash_text(reached.hash);
      },
      &c.step_queue);
  services.add<Trigger>("pause", [&c](const Request&, Response&) {
    c.simulation.pause().get();
    c.publisher.publish_now(c.answer_timeout);
  });
  services.add<Trigger>("resume", [&c](const Request&, Response&) {
    c.simulation.resume().get();
    c.publisher.status_changed();
  });
  services.add<Trigger>("reset", [&c](const Request&, Response&) {
    c.simulation.apply(command::Reset{}).get();
    ROS_INFO("The simulation was reset to the start of the scenario.");
    c.publisher.publish_now(c.answer_timeout);
  });
}

}  // namespace desert_sim
