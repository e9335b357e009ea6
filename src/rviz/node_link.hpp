#pragma once
/// The node that a panel works with: its name, its status, and calls of its services that tell an ErrorLine
/// what became of them.

#include <QObject>
#include <QPointer>
#include <functional>
#include <string>
#include <utility>

#include "src/rviz/error_line.hpp"
#include "src/rviz/node_watch.hpp"
#include "src/rviz/service_caller.hpp"

namespace desert_sim {

class NodeLink : public QObject {
  Q_OBJECT

 public:
  explicit NodeLink(QObject* parent = nullptr);

  /// Works with the node of this name from now on; what another one was asked for is given up. Throws
  /// ConfigError if it is not a name of ROS.
  void set_node(const std::string& name);
  const std::string& node() const { return node_; }  ///< resolved, such as /desert_sim
  NodeWatch& watch() { return watch_; }
  ServiceCaller& caller() { return caller_; }

  /// Calls a service of the node by its name, such as "pause". `line` shows that it is under way, and why it
  /// was refused. `done` is called after success.
  template <class Service>
  void call(ErrorLine* line, const std::string& service, const typename Service::Request& request = {},
            std::function<void(const typename Service::Response&)> done = nullptr) {
    call_by<Service>(caller_, line, service, request, std::move(done));
  }
  /// The same apart from all other calls, which do not wait for it.
  template <class Service>
  void call_apart(ErrorLine* line, const std::string& service, const typename Service::Request& request,
                  std::function<void(const typename Service::Response&)> done = nullptr) {
    call_by<Service>(slow_caller_, line, service, request, std::move(done));
  }
  /// Sets a floating-point parameter, such as "step_rate" or "run__acceleration", through ~set_parameters.
  void set_number(ErrorLine* line, const std::string& name, double value);

 Q_SIGNALS:
  void presence_changed();
  void status_came(const desert_sim::SimulationStatusConstPtr& status);
  void description_came(const dynamic_reconfigure::ConfigDescriptionConstPtr& description);
  void parameters_came(const dynamic_reconfigure::ConfigConstPtr& parameters);

 private:
  template <class Service>
  void call_by(ServiceCaller& caller, ErrorLine* line, const std::string& service,
               const typename Service::Request& request,
               std::function<void(const typename Service::Response&)> done) {
    line->show_note(service + " ...");
    caller.call<Service>(node_ + "/" + service, request,
                         [line = QPointer<ErrorLine>(line), done = std::move(done)](
                             const CallOutcome& outcome, const typename Service::Response& response) {
                           if (line) show(*line, outcome);
                           if (outcome.success && done) done(response);
                         });
  }
  static void show(ErrorLine& line, const CallOutcome& outcome);

  std::string node_;
  NodeWatch watch_;
  ServiceCaller caller_, slow_caller_;  ///< ~step can take long, and ~pause must not wait for it
};

}  // namespace desert_sim
