#include "test/support/program.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "test/support/temporary_folder.hpp"

namespace desert_sim::test {

std::string program_path(const char* variable, const std::string& built) {
  const char* path = std::getenv(variable);
  return path && path[0] ? path : built;
}

ProgramRun run_program(const std::string& program, const std::vector<std::string>& arguments,
                       const std::vector<Signal>& signals) {
  const TemporaryFolder folder;
  const std::string out = folder.path("out"), err = folder.path("err");
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  const pid_t child = fork();
  if (child == 0) {
    setpgid(0, 0);
    dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
    execv(program.c_str(), argv.data());
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  bool ended = false;
  for (auto next = signals.begin(); next != signals.end() && !ended;) {
    ended = wait4(child, &status, WNOHANG, &usage) == child;
    if (!ended && next->when(file_bytes(err)))
      kill(-child, next++->number);
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (!ended) wait4(child, &status, 0, &usage);
  ProgramRun run;
  run.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  run.resident_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
  run.out = file_bytes(out);
  run.err = file_bytes(err);
  return run;
}

}  // namespace desert_sim::test
