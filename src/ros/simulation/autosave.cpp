#include "src/ros/simulation/autosave.hpp"

#include <ros/console.h>

#include <algorithm>

#include "src/core/files.hpp"
#include "src/core/hash_text.hpp"
#include "src/simulation/checkpoint.hpp"

namespace desert_sim {

namespace {

constexpr const char *subfolder = "autosave", *file_extension = ".ckpt";
constexpr std::size_t max_files =
    2;  // files; a second one, because a disk may lose what it reported as written

}  // namespace

// ---- Files.

namespace {

std::string file_prefix(const std::string& node, const Scenario& scenario) {
  std::string name = node.substr(node.find_first_not_of('/'));
  std::replace(name.begin(), name.end(), '/', '.');
  return name + "-" + hash_text(scenario_hash(scenario)) + "-";
}

}  // namespace

AutosaveFiles::AutosaveFiles(const DataFolder& folder, const std::string& node, const Scenario& scenario)
    : folder_(&folder),
      files_(folder.path() + "/" + subfolder, file_prefix(node, scenario), file_extension) {}

WritableFile AutosaveFiles::next() const {
  return folder_->for_writing(std::string(subfolder) + "/" + files_.next_name());
}

// ---- Saving.

Autosave::Autosave(AutosaveFiles files, double period, SimulationThread& simulation,
                   const std::string& journal)
    : files_(std::move(files)),
      period_(period),
      simulation_(simulation),
      previously_loaded_(checkpoints_of_previous(journal)) {
  state_.period = period;
  thread_ = std::thread([this] { run_thread(); });
}

Autosave::~Autosave() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    stopped_.notify_all();
  }
  thread_.join();
}

Autosave::State Autosave::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  State state = state_;
  state.age = std::chrono::duration<double>(Clock::now() - saved_at_).count();
  return state;
}

void Autosave::set_files(AutosaveFiles files) {
  const std::lock_guard<std::mutex> lock(mutex_);
  files_ = std::move(files);
  saved_change_ = 0;
}

void Autosave::run_thread() {
  const auto period = std::chrono::duration<double>(period_);
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopped_.wait_for(lock, period, [this] { return stopping_; })) {
    lock.unlock();
    std::string error;
    try {
      save();
    } catch (const std::exception& e) {
      if (simulation_.ended()) return;  // the log says so already, and there is nothing more to save
      error = e.what();
      ROS_ERROR("The autosave failed: %s", error.c_str());
    }
    lock.lock();
    state_.error = error;
    if (error.empty())
      saved_at_ = Clock::now();
    else
      saved_change_ = 0;
  }
}

void Autosave::save() {
  std::unique_lock<std::mutex> lock(mutex_);
  const std::uint64_t change = simulation_.changes();
  if (saved_change_ == change) return;
  saved_change_ = change;  // the copy can only be newer; set_files() and an error reset this
  const AutosaveFiles files = files_;
  lock.unlock();
  const CheckpointCopy copy = simulation_.checkpoint().get();
  const WritableFile file = files.next();
  file.write([&](const std::string& path) { write_file(path, copy.bytes); });
  std::vector<std::string> needed = copy.journal_files;
  needed.insert(needed.end(), previously_loaded_.begin(), previously_loaded_.end());
  files.keep_newest(max_files, needed);
  lock.lock();
  state_.path = file.path();
  state_.step = copy.moment.step;
}

// ---- Resuming.

void load_newest(Session& session, const std::vector<std::string>& checkpoints, const std::string& folder,
                 const std::string& journal) {
  for (const std::string& checkpoint : checkpoints) {
    try {
      std::string path = checkpoint;
      if (!journal.empty()) {
        path = checkpoint_beside(journal);
        write_file(path, read_file(checkpoint, folder));
      } else {
        session.confine_commands(folder);
      }
      session.apply(command::LoadCheckpoint{path, 0});
      ROS_INFO("The simulation was resumed at step %lu from the autosave %s.",
               static_cast<unsigned long>(session.simulation().steps()), checkpoint.c_str());
      return;
    } catch (const ConfigError& e) {
      ROS_WARN("The autosave %s cannot be loaded: %s", checkpoint.c_str(), e.what());
    }
  }
  ROS_INFO("No complete autosave was found: the simulation starts at the beginning of the scenario.");
}

}  // namespace desert_sim
