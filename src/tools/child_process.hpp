#pragma once
/// Programs that desert_run and desert_bench start.

#include <sys/types.h>

#include <string>
#include <vector>

#include "src/core/descriptor.hpp"

namespace desert_sim {

/// A program that runs until finish(). It finds the file FILE that this process has open under
/// open_file_path(FILE).
class ChildProcess {
 public:
  enum class Input { inherited, piped };

  /// `words`: the program, which is searched for in $PATH, and its arguments. Throws ConfigError that begins
  /// with `what` if it cannot be started.
  ChildProcess(const std::string& what, std::vector<std::string> words, Input input = Input::inherited);
  /// Ends the program's input and waits for it, whatever its status.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Bytes for its standard input. Throws ConfigError if it no longer reads.
  void write(const void* bytes, std::size_t size);
  /// Ends its input and waits for it. Throws ConfigError unless its exit status is 0.
  void finish();

 private:
  int wait();

  const std::string what_, program_;
  Descriptor input_{-1};
  pid_t child_ = -1;
};

/// A path under which a child process can open a file of this one; see TemporaryFile::library_path().
std::string path_for_children(const std::string& library_path);

}  // namespace desert_sim
