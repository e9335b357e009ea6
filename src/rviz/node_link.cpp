#include "src/rviz/node_link.hpp"

#include <dynamic_reconfigure/Reconfigure.h>

#include "src/rviz/names.hpp"

namespace desert_sim {

NodeLink::NodeLink(QObject* parent) : QObject(parent) {
  connect(&watch_, &NodeWatch::presence_changed, this, &NodeLink::presence_changed);
  connect(&watch_, &NodeWatch::status_came, this, &NodeLink::status_came);
  connect(&watch_, &NodeWatch::description_came, this, &NodeLink::description_came);
  connect(&watch_, &NodeWatch::parameters_came, this, &NodeLink::parameters_came);
}

void NodeLink::set_node(const std::string& name) {
  const std::string full = full_name(name, "node");
  caller_.cancel();
  slow_caller_.cancel();
  node_ = full;
  watch_.watch(node_);
}

void NodeLink::set_number(ErrorLine* line, const std::string& name, double value) {
  dynamic_reconfigure::ReconfigureRequest request;
  request.config.doubles.resize(1);
  request.config.doubles[0].name = name;
  request.config.doubles[0].value = value;
  line->show_note("set_parameters ...");
  caller_.call_plain<dynamic_reconfigure::Reconfigure>(
      node_ + "/set_parameters", request, [line = QPointer<ErrorLine>(line)](const CallOutcome& outcome) {
        if (line) show(*line, outcome);
      });
}

void NodeLink::show(ErrorLine& line, const CallOutcome& outcome) {
  if (outcome.success)
    line.show_nothing();
  else
    line.show_error(outcome.message.empty() ? "refused without a reason" : outcome.message);
}

}  // namespace desert_sim
