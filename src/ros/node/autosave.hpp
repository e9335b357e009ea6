#pragma once
/// Checkpoints that the node writes by itself, and goes on from when it is started anew.

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "src/ros/node/data_folder.hpp"
#include "src/ros/node/simulation_thread.hpp"

namespace desert_sim {

/// Files autosave/NAME-NUMBER.ckpt below the data folder; the highest number is the newest. NAME is the
/// node's and the hash of the scenario in its parameters, so that a node only resumes its own. A scenario
/// that a service has put in its place is in the file: a node that is started anew knows only its parameters.
class AutosaveFiles {
 public:
  AutosaveFiles(const DataFolder& folder, const std::string& node, const Scenario& scenario);
  /// Newest first.
  std::vector<std::string> found() const;
  /// Path of one that is newer than all.
  std::string next() const;
  /// Removes all but the newest `count`.
  void keep(std::size_t count) const;

 private:
  std::string file_name(unsigned long number) const;
  const DataFolder* folder_;
  std::string name_;
};

/// Writes a checkpoint every `period` seconds of wall time, if something has changed, and keeps the last two.
/// The copy is made between two steps; the file is written on a thread of its own. One that cannot be written
/// is an error in the log and on /diagnostics, and is tried again.
class Autosave {
 public:
  struct State {
    double period = 0;       ///< [s]
    std::string path;        ///< of the last one; empty: none yet
    std::uint64_t step = 0;  ///< of the last one
    double age = 0;          ///< since the terrain was last found saved, or since the start [s]
    std::string fault;       ///< why the last one could not be written; empty if it was
  };

  Autosave(AutosaveFiles files, double period, SimulationThread& simulation);
  /// Waits for the file that is being written.
  ~Autosave();
  State state() const;
  /// From now on, under these names: the scenario in the node's parameters is another.
  void save_as(AutosaveFiles files);

 private:
  using Clock = std::chrono::steady_clock;
  void thread();
  void save();

  AutosaveFiles files_;  ///< under mutex_
  const double period_;
  SimulationThread& simulation_;
  std::uint64_t saved_change_ = 0;
  mutable std::mutex mutex_;
  std::condition_variable stopped_;
  bool stopping_ = false;
  State state_;
  Clock::time_point saved_at_ = Clock::now();
  std::thread thread_;
};

/// Loads the first of `checkpoints` that is whole, and warns of those that are not. With a journal, it is
/// loaded from a copy beside it, `journal`.checkpoint, so that the journal can be replayed when the autosaves
/// have gone. Without a whole one, the session stays at the scenario's start.
void load_newest(Session& session, const std::vector<std::string>& checkpoints, const std::string& journal);

}  // namespace desert_sim
