#include "include/desert_sim/testing/node_process.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/param.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <sstream>
#include <thread>

#include "src/core/error.hpp"
#include "src/core/spawn.hpp"

namespace desert_sim::test {

namespace fs = std::filesystem;

namespace {

constexpr auto poll_period = std::chrono::milliseconds(10);

/// A port that nobody listens on.
int free_port() {
  const int probe = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const bool found = probe >= 0 && bind(probe, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                     getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  if (probe >= 0) close(probe);
  if (!found) throw Error(std::string("no port is free for a ROS master: ") + std::strerror(errno));
  return ntohs(address.sin_port);
}

/// rostest and roslaunch name the nodes that they start, and those have the master of the test.
bool started_by_roslaunch(int argc, char** argv) {
  for (int n = 1; n < argc; ++n)
    if (std::string(argv[n]).rfind("__name:=", 0) == 0) return true;
  return false;
}

/// The program of this package in the folders of CMAKE_PREFIX_PATH, where catkin puts it.
std::string program_path(const std::string& name) {
  const char* const path = std::getenv("CMAKE_PREFIX_PATH");
  std::stringstream prefixes(path ? path : "");
  std::error_code error;
  for (std::string prefix; std::getline(prefixes, prefix, ':');)
    if (const fs::path found = fs::path(prefix) / "lib" / "desert_sim" / name;
        fs::is_regular_file(found, error))
      return found.string();
  if (const fs::path found = fs::path("/usr/lib/desert_sim") / name; fs::is_regular_file(found, error))
    return found.string();
  throw Error("no program " + name + " in lib/desert_sim of CMAKE_PREFIX_PATH='" + (path ? path : "") +
              "' (setup.bash of its workspace sets it)");
}

}  // namespace

double patience() {
  const char* const factor = std::getenv("DESERT_PATIENCE");
  return factor ? std::strtod(factor, nullptr) : 1;
}

bool wait_until(const std::function<bool()>& happened, double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds * patience());
  while (!happened()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(poll_period);
  }
  return true;
}

// ---- processes

Process::Process(const std::vector<std::string>& words, bool quiet) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  if (quiet)
    for (const int output : {STDOUT_FILENO, STDERR_FILENO})
      posix_spawn_file_actions_addopen(&actions, output, "/dev/null", O_WRONLY, 0);
  if (const int failure = spawn_program(pid_, words, actions))
    throw Error(words.front() + ": " + std::strerror(failure));
}

bool Process::running() {
  if (!ended_) ended_ = waitpid(pid_, nullptr, WNOHANG) == pid_;
  return !ended_;
}

Process::~Process() {
  if (running()) kill(pid_, SIGINT);
  if (wait_until([this] { return !running(); }, 60)) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

std::unique_ptr<Process> start_node(const std::string& program, const std::string& path,
                                    const Parameters& parameters) {
  const std::string found = program_path(program);
  ros::param::del(path);
  for (const auto& [key, value] : parameters) ros::param::set(path + "/" + key, value);
  const std::size_t last = path.rfind('/');
  return std::make_unique<Process>(std::vector<std::string>{found, "__name:=" + path.substr(last + 1),
                                                            "__ns:=" + (last ? path.substr(0, last) : "/")});
}

// ---- master

void init(int& argc, char** argv, const std::string& name) {
  static std::unique_ptr<Process> master;  // ends when the process does
  const bool own = !started_by_roslaunch(argc, argv);
  if (own) {
    const std::string port = std::to_string(free_port());
    setenv("ROS_MASTER_URI", ("http://localhost:" + port).c_str(), 1);
    setenv("ROS_HOSTNAME", "localhost", 1);
    unsetenv("ROS_IP");
    master = std::make_unique<Process>(std::vector<std::string>{"rosmaster", "--core", "-p", port}, true);
  }
  std::uint32_t options = 0;
  if (own) options |= ros::init_options::AnonymousName;
  ros::init(argc, argv, name, options);
  if (!wait_until([] { return ros::master::check(); }, 60))
    throw Error("no ROS master answers at " + ros::master::getURI() + " within 60 s");
  ros::start();
}

}  // namespace desert_sim::test
