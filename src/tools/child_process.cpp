#include "src/tools/child_process.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "src/core/error.hpp"
#include "src/core/spawn.hpp"

namespace desert_sim {

ChildProcess::ChildProcess(const std::string& what, std::vector<std::string> words, Input input)
    : what_(what), program_(words.at(0)) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  Descriptor read_end(-1);
  if (input == Input::piped) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw ConfigError(what_ + ": " + std::strerror(errno));
    read_end.reset(ends[0]);
    input_.reset(ends[1]);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    std::signal(SIGPIPE, SIG_IGN);  // a program that ends early is told by write()
  }
  if (const int failure = spawn_program(child_, std::move(words), actions)) {
    child_ = -1;
    throw ConfigError(what_ + ": " + program_ + ": " + std::strerror(failure));
  }
}

ChildProcess::~ChildProcess() { wait(); }

void ChildProcess::write(const void* bytes, std::size_t size) {
  const char* next = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t n = ::write(input_.number(), next, size);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw ConfigError(what_ + ": " + program_ + " has ended too early");
    next += n;
    size -= static_cast<std::size_t>(n);
  }
}

int ChildProcess::wait() {
  if (child_ < 0) return 0;
  input_.reset(-1);
  int status = 0;
  while (waitpid(child_, &status, 0) < 0 && errno == EINTR) continue;
  child_ = -1;
  return status;
}

void ChildProcess::finish() {
  const int status = wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw ConfigError(what_ + ": " + program_ + " failed");
}

std::string path_for_children(const std::string& library_path) {
  const std::string own = "/proc/self";
  return "/proc/" + std::to_string(getpid()) + library_path.substr(own.size());
}

}  // namespace desert_sim
