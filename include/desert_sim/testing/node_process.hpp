#pragma once
/// Processes that a test starts: a ROS master, and nodes.

#include <XmlRpcValue.h>
#include <sys/types.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace desert_sim::test {

/// What all time limits are multiplied by: the environment's DESERT_PATIENCE, 1 if that is not set.
double patience();

/// Waits until `happened()`, at most so many seconds of wall time, times patience(); whether it did.
bool wait_until(const std::function<bool()>& happened, double seconds);

/// Makes this process a ROS node with a name that nobody else has. In a rostest its master is the test's;
/// else it gets a master of its own on a free port, which ends with it: a test does not meddle with the robot
/// whose master the environment names. To be called once, in main(). Throws std::runtime_error if no master
/// comes up.
void init(int& argc, char** argv, const std::string& name);

/// A program that is ended with this object.
class Process {
 public:
  /// `words`: the program, which is searched for in $PATH, and its arguments; `quiet`: what it prints is
  /// lost. Throws std::runtime_error if it cannot be started.
  explicit Process(const std::vector<std::string>& words, bool quiet = false);
  /// SIGINT, and SIGKILL if it still runs after a minute.
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  bool running();

 private:
  pid_t pid_ = -1;
  bool ended_ = false;
};

using Parameters = std::map<std::string, XmlRpc::XmlRpcValue>;

/// Starts a node of this package with private parameters in place of all that there were. `path`: its full
/// name. Throws std::runtime_error if there is no such program in the packages' folders (CMAKE_PREFIX_PATH).
std::unique_ptr<Process> start_node(const std::string& program, const std::string& path,
                                    const Parameters& parameters);

}  // namespace desert_sim::test
