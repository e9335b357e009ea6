#pragma once
/// Programs that a test starts, stops and kills: nodes of its own, and tools.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <map>
#include <string>
#include <vector>

#include "test/support/ros/client.hpp"

namespace node_test {

/// Killed in the end, if it still runs.
class ChildProcess {
 public:
  /// `words`: the program, found as a shell would, and its arguments.
  explicit ChildProcess(std::vector<std::string> words) : pid_(fork()) {
    if (pid_ != 0) return;
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  ~ChildProcess() {
    if (running()) end(SIGKILL);
    unlink(held_file().c_str());
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  bool running() {
    if (!ended_) ended_ = waitpid(pid_, &status_, WNOHANG) == pid_;
    return !ended_;
  }
  /// Waits for its end; exit status, or 128 + signal.
  int wait(double seconds = 60) {
    EXPECT_TRUE(wait_until([this] { return !running(); }, seconds)) << "it does not end";
    if (running()) return -1;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  }
  int end(int with_signal) {
    kill(pid_, with_signal);
    return wait();
  }
  /// Stops it until release(). scripts/flakes, which stops and continues processes at random, leaves it
  /// alone.
  void hold() const {
    close(creat(held_file().c_str(), 0600));
    EXPECT_EQ(kill(pid_, SIGSTOP), 0);
  }
  void release() const {
    unlink(held_file().c_str());
    EXPECT_EQ(kill(pid_, SIGCONT), 0);
  }

 private:
  std::string held_file() const { return "/tmp/desert_sim_held." + std::to_string(pid_); }

  pid_t pid_;
  int status_ = 0;
  bool ended_ = false;
};

/// A paused desert_sim_node of its own, on corner.yaml unless told otherwise. `name` begins with a slash.
class NodeProcess {
 public:
  explicit NodeProcess(const std::string& name, const std::map<std::string, XmlRpc::XmlRpcValue>& more = {})
      : name_(name), process_({DESERT_NODE_BINARY, parameters(name, more)}) {}

  int end(int with_signal) { return process_.end(with_signal); }
  void hold() const { process_.hold(); }
  void release() const { process_.release(); }

  /// A call over a new connection; a test failure if there is no answer, or a refusal.
  template <class Service>
  typename Service::Response call(const std::string& service,
                                  const typename Service::Request& request) const {
    const std::string path = name_ + "/" + service;
    EXPECT_TRUE(wait_until([&] { return ros::service::exists(path, false); })) << path;
    Service exchange;
    exchange.request = request;
    EXPECT_TRUE(desert_sim::call_service(path, exchange)) << path;
    EXPECT_TRUE(exchange.response.success) << exchange.response.message;
    return exchange.response;
  }

 private:
  /// Sets them; the argument that names the node.
  static std::string parameters(const std::string& name,
                                const std::map<std::string, XmlRpc::XmlRpcValue>& more) {
    ros::param::del(name);
    ros::param::set(name + "/scenario",
                    std::string(DESERT_SOURCE_DIR "/test/support/ros/scenarios/corner.yaml"));
    ros::param::set(name + "/backend", std::string("cpu"));
    ros::param::set(name + "/threads", 1);
    ros::param::set(name + "/paused", true);
    ros::param::set(name + "/answer_timeout", 600.0);
    ros::param::set(name + "/refresh_rate", 0.0);
    ros::param::set(name + "/keyframe_rate", 0.0);
    for (const auto& [key, value] : more) ros::param::set(name + "/" + key, value);
    return "__name:=" + name.substr(1);
  }

  std::string name_;
  ChildProcess process_;
};

}  // namespace node_test
