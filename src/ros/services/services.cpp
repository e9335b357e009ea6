#include "src/ros/services/services.hpp"

namespace desert_sim {

Services::Services(ServiceContext context) : context_(std::move(context)) {
  add_wind_services(*this);
  add_edit_services(*this);
  add_map_services(*this);
  add_run_services(*this);
  add_file_services(*this);
  add_parameter_services(*this);
}

}  // namespace desert_sim
