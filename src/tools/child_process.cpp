#include "src/tools/child_process.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
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
    errors_.reset(memfd_create("errors", MFD_CLOEXEC));
    if (errors_.number() >= 0) posix_spawn_file_actions_adddup2(&actions, errors_.number(), STDERR_FILENO);
    std::signal(SIGPIPE, SIG_IGN);  // a program that ends early is told by write()
  }
  const ProcessGroup group = input == Input::piped ? ProcessGroup::own : ProcessGroup::of_parent;
  if (const int failure = spawn_program(child_, std::move(words), actions, group)) {
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
    if (n < 0) {
      wait();
      throw WriteError(what_ + ": " + program_ + " has ended too early" + said());
    }
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

std::string ChildProcess::said() const {
  if (errors_.number() < 0) return "";
  std::string text(400, '\0');
  const ssize_t n = pread(errors_.number(), text.data(), text.size(), 0);
  text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ';');
  return text.empty() ? "" : ": " + text;
}

void ChildProcess::finish() {
  const int status = wait();
  const std::string errors = said();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || !errors.empty()) {
    const std::string text = what_ + ": " + program_ + " failed" + errors;
    if (errors_.number() >= 0) throw WriteError(text);
    throw ConfigError(text);
  }
}

std::string path_for_children(const std::string& library_path) {
  const std::string own = "/proc/self";
  return "/proc/" + std::to_string(getpid()) + library_path.substr(own.size());
}

}  // namespace desert_sim
