#pragma once
/// Calls of services on a thread of its own, one after the other, with answers in the thread of Qt.

#include <ros/node_handle.h>

#include <QObject>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

namespace desert_sim {

/// What became of a call.
struct CallOutcome {
  bool success = false;
  std::string message;  ///< why not; what the service says
};

class ServiceCaller : public QObject {
  Q_OBJECT

 public:
  explicit ServiceCaller(QObject* parent = nullptr);
  /// Waits for no service: a call under way is given up.
  ~ServiceCaller() override;

  /// Calls a service whose response has `success` and `message`, after all calls before. `done` is called in
  /// the thread of this object, unless the call is cancelled or the object is gone.
  template <class Service>
  void call(const std::string& service, const typename Service::Request& request,
            std::function<void(const CallOutcome&, const typename Service::Response&)> done) {
    work([this, service, request, done = std::move(done)]() -> std::function<void()> {
      Service exchange;
      exchange.request = request;
      CallOutcome outcome;
      if (transfer(service, exchange, outcome)) {
        outcome.success = exchange.response.success;
        outcome.message = exchange.response.message;
      }
      return [done, outcome, response = exchange.response] { done(outcome, response); };
    });
  }
  /// The same for a service that refuses by failing, whose response has no fields that say so.
  template <class Service>
  void call_plain(const std::string& service, const typename Service::Request& request,
                  std::function<void(const CallOutcome&)> done) {
    work([this, service, request, done = std::move(done)]() -> std::function<void()> {
      Service exchange;
      exchange.request = request;
      CallOutcome outcome;
      outcome.success = transfer(service, exchange, outcome);
      return [done, outcome] { done(outcome); };
    });
  }
  /// Does `job` on the thread of this caller, after all calls before; what it returns is called in the thread
  /// of this object.
  void work(std::function<std::function<void()>()> job);

  /// Gives up the call under way and those that wait; none of them is answered.
  void cancel();

 private:
  struct Job {
    std::function<std::function<void()>()> work;
    unsigned generation;
  };

  /// Whether the service answered; if not, the outcome says why.
  template <class Service>
  bool transfer(const std::string& service, Service& exchange, CallOutcome& outcome) {
    // A connection that stays is one that cancel() can cut, so that nobody waits for a node that hangs.
    ros::ServiceClient client = ros::NodeHandle().serviceClient<Service>(service, true);
    if (!client.isValid()) {
      outcome.message = "nobody offers " + service + ": is the node running, and the ROS master?";
      return false;
    }
    if (!begin(client)) return false;
    const bool answered = client.call(exchange);
    end();
    if (!answered)
      outcome.message = service + " failed: the node has ended, or refuses (its reason is in rviz's log)";
    return answered;
  }
  /// False if the call has been cancelled already.
  bool begin(const ros::ServiceClient& client);
  void end();
  void loop();

  std::mutex mutex_;  ///< guards the following members; held only briefly
  std::condition_variable wake_up_;
  std::deque<Job> jobs_;
  ros::ServiceClient current_;   ///< of the call under way
  unsigned generation_ = 0;      ///< counts cancellations
  unsigned job_generation_ = 0;  ///< generation_ when the job under way was asked for
  bool ending_ = false;
  std::thread thread_;  ///< the last member: it uses the others
};

}  // namespace desert_sim
