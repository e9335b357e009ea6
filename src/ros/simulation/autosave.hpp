#pragma once
/// Autosaves: checkpoints that the node writes by itself, and resumes from when it is started again.

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "src/core/data_folder.hpp"
#include "src/core/numbered_files.hpp"
#include "src/ros/simulation/simulation_thread.hpp"

namespace desert_sim {

/// The files autosave/NAME-NUMBER.ckpt below the data folder, as NumberedFiles. NAME is made of the name of
/// the node and the hash of the scenario in its parameters, so that a node resumes only its own files. That
/// holds also while a service has loaded another scenario: the file has that one, but a node that is
/// started again knows only its parameters.
class AutosaveFiles {
 public:
  AutosaveFiles(const DataFolder& folder, const std::string& node, const Scenario& scenario);
  /// The paths of the files there are, newest first.
  std::vector<std::string> paths() const { return files_.paths(); }
  /// A file that is newer than all.
  WritableFile next() const;
  /// Removes all files but the newest `count`, and but those in `needed`.
  void keep_newest(std::size_t count, const std::vector<std::string>& needed) const {
    files_.keep_newest(count, needed);
  }

 private:
  const DataFolder* folder_;
  NumberedFiles files_;
};

/// Writes a checkpoint every `period` seconds of wall time, if something has changed, and keeps the last two
/// files, and those that a journal loads. The copy is made between two steps; the file is written on a thread
/// of its own. If a file cannot be written, the log and /diagnostics have an error, and it is tried again a
/// period later.
class Autosave {
 public:
  struct State {
    double period = 0;       ///< [s]
    std::string path;        ///< of the last file; empty if there is none yet
    std::uint64_t step = 0;  ///< of the last file
    double age = 0;          ///< since it was last found that the terrain is saved, or since the start [s]
    std::string error;       ///< why the last file could not be written; empty if it was
  };

  /// `journal`: file, or empty. What the journal before it loads is kept too, until there is another one.
  Autosave(AutosaveFiles files, double period, SimulationThread& simulation, const std::string& journal);
  /// Waits for the file that is being written.
  ~Autosave();
  State state() const;
  /// Saves to these files from now on, because the scenario in the node's parameters has changed.
  void set_files(AutosaveFiles files);

 private:
  using Clock = std::chrono::steady_clock;
  void run_thread();
  void save();

  AutosaveFiles files_;  ///< guarded by mutex_
  const double period_;
  SimulationThread& simulation_;
  const std::vector<std::string> previously_loaded_;  ///< checkpoints that the previous journal loads
  std::uint64_t saved_change_ = 0;
  mutable std::mutex mutex_;  ///< guards all that is not const, except thread_
  std::condition_variable stopped_;
  bool stopping_ = false;
  State state_;
  Clock::time_point saved_at_ = Clock::now();
  std::thread thread_;
};

/// Loads the first of `checkpoints` that is complete and lies below `folder`, and warns of those that are
/// not. With a journal, it is loaded from a copy, checkpoint_beside(journal), so that the journal can be
/// replayed when the autosaves are gone; without one, the session's commands are confined to the folder. If
/// none is complete, the session stays at the start of the scenario.
void load_newest(Session& session, const std::vector<std::string>& checkpoints, const std::string& folder,
                 const std::string& journal);

}  // namespace desert_sim
