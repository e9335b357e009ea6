#pragma once
/// What a rover was told, and which ground it had, so that a run can be repeated to the bit: one YAML
/// document a line, the first with the rover's parameters, each other one with what happened next.
///
///   {rover_journal: 1, micro_relief: false, rover: "<rover_text()>"}
///   {reset: [x, y, yaw], terrain: 0}      {place: [x, y, yaw], terrain: 12}      {state: !!binary …}
///   {drive: [forward, sideways, yaw_rate], seconds: 2}
///   {advance: 0.02, terrain: 13, time: 13}      on the ground of this step; without: none is known

#include <cstdint>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "src/rover/rover.hpp"

namespace desert_sim {

namespace rover_event {
struct Place {
  double x = 0, y = 0, yaw = 0;
  bool reset = false;
  std::uint64_t terrain = 0;
};
struct Drive {
  DriveCommand command;
  double seconds = 0;
};
struct Advance {
  double seconds = 0;
  std::optional<std::uint64_t> terrain;
  double time = 0;
};
struct SetState {
  std::string bytes;  ///< as in a file: see state_file.hpp
};
}  // namespace rover_event
using RoverEvent =
    std::variant<rover_event::Place, rover_event::Drive, rover_event::Advance, rover_event::SetState>;

class RoverJournalWriter {
 public:
  /// Starts a new file. Throws ConfigError if it cannot be written.
  /// `micro_relief`: whether its ground has ripples and bumps.
  RoverJournalWriter(const std::string& path, const Rover& rover, bool micro_relief);
  ~RoverJournalWriter();
  RoverJournalWriter(const RoverJournalWriter&) = delete;
  RoverJournalWriter& operator=(const RoverJournalWriter&) = delete;
  void write(const RoverEvent& event);

 private:
  void line(const std::string& text);
  std::string path_;
  std::FILE* file_ = nullptr;
};

struct RoverJournal {
  RoverParameters rover;
  WheelGroundParameters ground;
  WetGroundParameters wet_ground;
  bool micro_relief = false;  ///< whether its ground had ripples and bumps
  std::vector<RoverEvent> events;
};

/// Throws ConfigError with file and line. A last line that was cut off (its node was killed) is left out.
RoverJournal read_rover_journal(const std::string& path);

/// The ground at a step of the terrain; called with steps in the order of the journal.
using GroundAtStep = std::function<const GroundSource&(std::uint64_t step)>;

/// Applies one event. `ground` is asked where the event has a step of the terrain.
void apply(Rover& rover, const RoverEvent& event, const GroundAtStep& ground);
/// The rover at the end of the journal. `watch`, if given, is called after each event.
RoverState replay(const RoverJournal& journal, const GroundAtStep& ground,
                  const std::function<void(const RoverState&)>& watch = nullptr);

}  // namespace desert_sim
