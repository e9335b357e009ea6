/// Services that change wind and weather.

#include <desert_sim/EditWind.h>
#include <desert_sim/SetWeather.h>
#include <desert_sim/SetWind.h>
#include <desert_sim/SetWindSchedule.h>

#include "src/ros/services/requests.hpp"
#include "src/ros/services/services.hpp"

namespace desert_sim {

void add_wind_services(Services& services) {
  const ServiceContext& c = services.context();
  const auto apply = [&c](const Command& command) {
    c.simulation.apply(command).get();
    c.publisher.status_changed();
  };
  services.add<SetWind>(
      "set_wind", [apply](const SetWindRequest& request, SetWindResponse&) { apply(wind_command(request)); });
  services.add<SetWindSchedule>("set_wind_schedule",
                                [apply](const SetWindScheduleRequest& request, SetWindScheduleResponse&) {
                                  apply(wind_schedule_command(request));
                                });
  services.add<EditWind>("edit_wind", [apply, &c](const EditWindRequest& request, EditWindResponse&) {
    apply(wind_edit_command(request, c.frames));
  });
  services.add<SetWeather>("set_weather", [apply](const SetWeatherRequest& request, SetWeatherResponse&) {
    apply(weather_command(request));
  });
}

}  // namespace desert_sim
