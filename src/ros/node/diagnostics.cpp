#include "src/ros/node/diagnostics.hpp"

#include <ros/console.h>
#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "src/client/ros_time.hpp"
#include "src/core/joined.hpp"
#include "src/core/pace_text.hpp"

namespace desert_sim {

namespace {

using diagnostic_msgs::DiagnosticStatus;
constexpr auto answer_timeout = std::chrono::seconds(2);
constexpr auto master_period = std::chrono::seconds(2);
constexpr int slow_periods = 3;
constexpr const char* states[] = {"running", "paused", "waiting for /clock"};

double mebibytes(double bytes) { return bytes / (1 << 20); }

double resident_bytes() {
  double all = 0, resident = 0;  // [pages]
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace

Diagnostics::Diagnostics(ros::NodeHandle node, double period, SimulationThread& simulation,
                         const TopicPublisher& publisher, const ForecastServer& forecast,
                         const Autosave* autosave)
    : simulation_(simulation),
      publisher_(publisher),
      forecast_(forecast),
      autosave_(autosave),
      updater_(node, node, node.getNamespace()) {
  diagnostics_ = node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1);
  updater_.setHardwareID("desert_sim");
  updater_.add("simulation", [this](Status& status) { check_simulation(status); });
  updater_.add("mass balance", [this](Status& status) { check_mass(status); });
  updater_.add("memory", [this](Status& status) { check_memory(status); });
  updater_.add("topics", [this](Status& status) { check_topics(status); });
  updater_.add("forecast", [this](Status& status) { check_forecast(status); });
  updater_.add("autosave", [this](Status& status) { check_autosave(status); });
  updater_.add("master", [this](Status& status) { check_master(status); });
  timer_ = node.createWallTimer(ros::WallDuration(period), [this](const ros::WallTimerEvent&) { update(); });
}

void Diagnostics::update() {
  ask_master();
  if (diagnostics_.getNumSubscribers() == 0 || is_near_the_last_time(ros::Time::now())) return;
  report_.reset();
  try {
    std::future<StatusReport> answer = simulation_.report(false);
    if (answer.wait_for(answer_timeout) == std::future_status::ready) report_ = answer.get();
  } catch (const Error&) {
    // The simulation has failed, which check_simulation() says, or it is ending.
  }
  if (report_) updater_.setHardwareID(report_->device);
  updater_.force_update();
}

void Diagnostics::check_simulation(Status& status) const {
  const std::string failure = publisher_.failure().empty() ? simulation_.failure() : publisher_.failure();
  if (!failure.empty()) return status.summary(DiagnosticStatus::ERROR, failure);
  if (!report_)
    return status.summary(DiagnosticStatus::WARN,
                          "the simulation has not answered for 2 s: a step takes long");
  const StatusReport& r = *report_;
  if (r.state == RunState::waiting) {
    status.summary(DiagnosticStatus::WARN, "use_sim_time is true, but no message has arrived on /clock yet");
  } else if (r.lag > Pacer::backlog) {
    status.summaryf(DiagnosticStatus::WARN,
                    "the simulation is %.1f s behind its schedule: %.1f of %.1f steps per second", r.lag,
                    r.steps_per_second, r.step_rate);
  } else {
    status.summary(DiagnosticStatus::OK, states[static_cast<int>(r.state)]);
  }
  for (const auto& [process, text] : r.warnings)
    status.mergeSummary(DiagnosticStatus::WARN, process + ": " + text);
  status.add("state", states[static_cast<int>(r.state)]);
  status.add("scenario", r.scenario);
  status.add("backend", r.backend_choice);
  status.add("device", r.device);
  status.add("step", r.moment.step);
  status.add("simulated time [s]", r.moment.time);
  status.add("time step [s]", r.time_step);
  status.add("acceleration", r.acceleration);
  status.add("pace", pace_text(r.acceleration, r.step_rate, r.time_step));
  status.add("steps a second wanted", r.step_rate);
  status.add("steps a second", r.steps_per_second);
  status.add("lag [s]", r.lag);
}

void Diagnostics::check_mass(Status& status) const {
  if (!report_)
    return status.summary(DiagnosticStatus::OK,
                          "the simulation has not answered: the balance was not checked");
  long long lost = 0;
  for (int m = 0; m < material_count; ++m) {
    const MaterialBalance& b = report_->balance[static_cast<std::size_t>(m)];
    lost += std::abs(b.residual());
    status.addf(material_names[m], "residual %lld quanta (relative %g)", b.residual(), b.relative_residual());
  }
  if (lost == 0)
    status.summary(DiagnosticStatus::OK, "mass is conserved");
  else
    status.summaryf(DiagnosticStatus::ERROR, "mass is not conserved: the residual is %lld quanta", lost);
}

void Diagnostics::check_memory(Status& status) const {
  status.addf("host, resident [MiB]", "%.1f", mebibytes(resident_bytes()));
  status.addf("host, peak [MiB]", "%.1f", mebibytes(peak_bytes()));
  if (!report_)
    return status.summary(DiagnosticStatus::OK,
                          "the simulation has not answered: the memory of the backend was not checked");
  const auto layers = static_cast<double>(report_->layer_bytes),
             available = static_cast<double>(report_->memory_available);
  status.addf("layers [MiB]", "%.1f", mebibytes(layers));
  status.addf("available to the backend [MiB]", "%.1f", mebibytes(available));
  // A reset or a load keeps the old terrain until the new one is complete.
  if (available < report_->memory_needed)
    status.summaryf(DiagnosticStatus::WARN, "%.0f MiB are available, but a reset or a load needs %.0f MiB",
                    mebibytes(available), mebibytes(report_->memory_needed));
  else
    status.summary(DiagnosticStatus::OK, "the available memory is sufficient");
}

void Diagnostics::check_topics(Status& status) {
  const std::string failure = publisher_.failure();
  std::vector<std::string> slow;
  for (const TopicRate& topic : publisher_.rates()) {
    // The many topics of layers that nobody listens to would hide the others.
    if (topic.subscribers > 0 || topic.name.find("/layers/") == std::string::npos)
      status.addf(topic.name, "%.2f of %.2f Hz, %u subscribers", topic.achieved, topic.wanted,
                  topic.subscribers);
    // A state that has not changed is not published again.
    const bool runs = report_ && report_->state == RunState::running && topic.subscribers > 0;
    const double expected = runs ? std::min(topic.wanted, report_->steps_per_second) : 0;
    int& periods = slow_[topic.name];
    periods = topic.achieved < 0.5 * expected ? periods + 1 : 0;
    if (periods >= slow_periods) slow.push_back(topic.name);
  }
  if (!failure.empty()) return status.summary(DiagnosticStatus::ERROR, failure);
  status.summary(DiagnosticStatus::OK, "all topics reach their rates");
  if (!slow.empty())
    status.mergeSummary(DiagnosticStatus::WARN, "less than half of the target rate: " + joined(slow));
  for (const auto& [topic, problem] : publisher_.problems())
    status.mergeSummary(DiagnosticStatus::WARN, topic + ": " + problem);
}

void Diagnostics::check_forecast(Status& status) const {
  const ForecastReport r = forecast_.report();
  status.add("forecasts", r.done);
  status.addf("the last one took [s]", "%.2f", r.seconds);
  status.addf("rate of its topics", "%.3f of %.3f Hz", r.achieved_rate, r.wanted_rate);
  if (!r.error.empty())
    status.summary(DiagnosticStatus::ERROR, r.error);
  else if (r.wanted_rate > 0 && r.seconds * r.wanted_rate > 2)
    status.summaryf(DiagnosticStatus::WARN, "a forecast takes %.1f s, and %.3f Hz are wanted", r.seconds,
                    r.wanted_rate);
  else
    status.summary(DiagnosticStatus::OK,
                   r.done == 0 ? "there was no forecast yet" : "the last forecast succeeded");
}

void Diagnostics::check_autosave(Status& status) const {
  if (!autosave_) return status.summary(DiagnosticStatus::OK, "autosave is off");
  const Autosave::State s = autosave_->state();
  status.add("period [s]", s.period);
  status.add("last file", s.path);
  status.add("its step", s.step);
  status.addf("its age [s]", "%.1f", s.age);
  if (!s.error.empty())
    status.summary(DiagnosticStatus::ERROR, s.error);
  else if (s.age > 2 * s.period + std::chrono::duration<double>(answer_timeout).count())
    status.summaryf(DiagnosticStatus::WARN, "no autosave has been written for %.0f s", s.age);
  else
    status.summary(DiagnosticStatus::OK, s.path.empty() ? "autosave is on; no file has been written yet"
                                                        : "the last autosave succeeded");
}

void Diagnostics::ask_master() {
  const auto now = std::chrono::steady_clock::now();
  if (now - asked_master_ < master_period) return;
  asked_master_ = now;
  XmlRpc::XmlRpcValue request, response, own_uri;
  request[0] = request[1] = ros::this_node::getName();
  const Master before = master_;
  if (!ros::master::check())
    master_ = Master::does_not_answer;
  else if (ros::master::execute("lookupNode", request, response, own_uri, false) &&
           own_uri.getType() == XmlRpc::XmlRpcValue::TypeString &&
           static_cast<std::string>(own_uri) == ros::XMLRPCManager::instance()->getServerURI())
    master_ = Master::knows_node;
  else
    master_ = Master::does_not_know_node;
  if (master_ != before && master_ == Master::does_not_know_node)
    ROS_ERROR("The ROS master was started anew and does not know this node: start the node anew, too.");
}

void Diagnostics::check_master(Status& status) const {
  status.add("ROS_MASTER_URI", ros::master::getURI());
  if (master_ == Master::knows_node)
    status.summary(DiagnosticStatus::OK, "the ROS master knows this node");
  else if (master_ == Master::does_not_answer)
    status.summary(
        DiagnosticStatus::WARN,
        "the ROS master does not answer: nodes that are connected are served, others find nothing");
  else
    status.summary(DiagnosticStatus::ERROR,
                   "the ROS master was started anew and does not know this node: start the node anew, too");
}

}  // namespace desert_sim
