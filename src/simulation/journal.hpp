#pragma once
/// The journal: every command with the tick (steps done in the session) before which it was applied, one YAML
/// document a line, so that a run that is killed leaves a journal that is whole up to its last line.

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "src/simulation/commands/command.hpp"
#include "src/simulation/undo/edit_history.hpp"

namespace desert_sim {

class JournalWriter {
 public:
  /// Starts a new file with a header that names the scenario's hash, the backend, and the memory for undo
  /// [bytes]. Throws ConfigError.
  JournalWriter(const std::string& path, std::uint64_t scenario_hash, const std::string& backend,
                std::size_t undo_memory = default_undo_memory);
  ~JournalWriter();
  void write(std::uint64_t tick, const Command& command);
  /// How many ticks the session made; written when it ends.
  void end(std::uint64_t tick);

 private:
  void line(const std::string& text);
  std::string path_;
  std::FILE* file_ = nullptr;
};

struct Journal {
  struct Entry {
    std::uint64_t tick;
    Command command;
  };
  int version = 3;  ///< before 3, undo knew edits alone: see Session::undo_edits_alone()
  std::uint64_t scenario_hash = 0;
  std::string backend;
  std::size_t undo_memory = default_undo_memory;  ///< of the session [bytes]; on it depends what undo finds
  std::vector<Entry> entries;
  bool ended = false;
  std::uint64_t ticks = 0;  ///< if it ended: all ticks of the session; else the last entry's
};

/// The paths of the checkpoints that the journal loads.
std::vector<std::string> checkpoints_of(const Journal& journal);

/// The path of the journal that was at `path` before: a node gives it this name.
inline std::string previous_journal(const std::string& path) { return path + ".previous"; }
/// For a node that will write a journal at `path`, unless that is empty: makes its folder where it is
/// missing, and gives an older journal, which can explain why a run failed, the name previous_journal().
/// Throws ConfigError.
void make_way_for_journal(const std::string& path);
/// The paths of the checkpoints that the journal before the one at `path` loads; none if `path` is empty or
/// there is no such journal. One that cannot be read is an error in the log.
std::vector<std::string> checkpoints_of_previous(const std::string& path);

/// Throws ConfigError with file and line.
Journal read_journal(const std::string& path);

/// The path for a copy of the checkpoint that a new journal at `path` begins with: `path`.checkpoint, or
/// `path`.checkpoint.2 if the previous journal loads the former.
std::string checkpoint_beside(const std::string& path);

}  // namespace desert_sim
