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
  /// inherited: it is interrupted with this one. piped: it reads what write() writes, and Ctrl-C leaves it to
  /// end what it was given.
  enum class Input { inherited, piped };

  /// `words`: the program, which is searched for in $PATH, and its arguments. Throws ConfigError that begins
  /// with `what` if it cannot be started.
  ChildProcess(const std::string& what, std::vector<std::string> words, Input input = Input::inherited);
  /// Ends the program's input and waits for it, whatever its status.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Bytes for its standard input. Throws WriteError if it no longer reads.
  void write(const void* bytes, std::size_t size);
  /// Ends its input and waits for it. Throws ConfigError unless its exit status is 0; with a piped input
  /// WriteError that has what it said, also if it said anything at all: ffmpeg ends with 0 on a full disk.
  void finish();

 private:
  int wait();
  /// The beginning of what it has written to its standard error, as far as that is kept (piped input).
  std::string said() const;

  const std::string what_, program_;
  Descriptor input_{-1}, errors_{-1};
  pid_t child_ = -1;
};

/// A path under which a child process can open a file of this one; see TemporaryFile::library_path().
std::string path_for_children(const std::string& library_path);

}  // namespace desert_sim
