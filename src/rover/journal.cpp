#include "src/rover/journal.hpp"

#include <fcntl.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <set>
#include <sstream>

#include "src/core/base64.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/log.hpp"
#include "src/rover/state_file.hpp"
#include "src/scenario/yaml_document.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

constexpr int journal_version = 1;

using rover_event::Advance;
using rover_event::Place;
using rover_event::SetState;

void start_line(YAML::Emitter& out) {
  yaml::set_full_precision(out);
  out.SetMapFormat(YAML::Flow);
  out.SetSeqFormat(YAML::Flow);
  out << YAML::BeginMap;
}

/// Flow style breaks long lines; a line of a journal is one line.
std::string line_of(YAML::Emitter& out) {
  out << YAML::EndMap;
  std::string text = out.c_str();
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text;
}

template <class T>
void entry(YAML::Emitter& out, const char* key, const T& value) {
  out << YAML::Key << key << YAML::Value << value;
}

void emit(YAML::Emitter& out, const Place& e) {
  entry(out, e.reset ? "reset" : "place", std::vector<double>{e.x, e.y, e.yaw});
  entry(out, "terrain", e.terrain);
}
void emit(YAML::Emitter& out, const rover_event::Drive& e) {
  entry(out, "drive", std::vector<double>{e.command.forward, e.command.sideways, e.command.yaw_rate});
  entry(out, "seconds", e.seconds);
}
void emit(YAML::Emitter& out, const Advance& e) {
  entry(out, "advance", e.seconds);
  if (!e.terrain) return;
  entry(out, "terrain", *e.terrain);
  entry(out, "time", e.time);
}
void emit(YAML::Emitter& out, const SetState& e) {
  entry(out, "state", YAML::Binary(reinterpret_cast<const unsigned char*>(e.bytes.data()), e.bytes.size()));
}

std::array<double, 3> three_numbers(const YAML::Node& node, const char* key) {
  const auto list = node[key].as<std::vector<double>>();
  if (list.size() != 3) throw ConfigError(std::string(key) + ": is no list of 3 numbers");
  return {list[0], list[1], list[2]};
}

RoverEvent event_of(const YAML::Node& node) {
  for (const char* key : {"reset", "place"})
    if (node[key]) {
      const std::array<double, 3> at = three_numbers(node, key);
      return Place{at[0], at[1], at[2], std::string(key) == "reset", node["terrain"].as<std::uint64_t>()};
    }
  if (node["drive"]) {
    const std::array<double, 3> c = three_numbers(node, "drive");
    return rover_event::Drive{{c[0], c[1], c[2]}, node["seconds"].as<double>()};
  }
  if (node["state"]) {
    const std::vector<unsigned char> bytes = decode_base64(node["state"].as<std::string>(), "state");
    return SetState{std::string(bytes.begin(), bytes.end())};
  }
  if (!node["advance"]) throw ConfigError("is none of reset, place, drive, state, advance");
  Advance advance{node["advance"].as<double>(), std::nullopt, 0};
  if (node["terrain"]) {
    advance.terrain = node["terrain"].as<std::uint64_t>();
    advance.time = node["time"].as<double>();
  }
  return advance;
}

void read_header(const YAML::Node& node, const std::string& where, RoverJournal& journal) {
  if (!node.IsMap() || !node["rover_journal"] || !node["rover"])
    throw ConfigError(where + ": is not the journal of a rover");
  if (const int version = node["rover_journal"].as<int>(); version != journal_version)
    throw ConfigError(where + ": is a journal of version " + std::to_string(version) +
                      "; this program reads version " + std::to_string(journal_version));
  if (node["micro_relief"])
    journal.micro_relief = node["micro_relief"].as<bool>();  // journals of older versions lack it
  ValidationErrors errors(where);
  const YAML::Node rover = YAML::Load(node["rover"].as<std::string>());
  std::set<std::string> known{"wheel_ground", "wet_ground"};
  yaml::read_parameters(rover, "", errors, journal.rover, known);
  yaml::reject_unknown_keys(rover, "", known, errors);
  yaml::read_section(rover["wheel_ground"], "wheel_ground", errors, journal.ground);
  yaml::read_section(rover["wet_ground"], "wet_ground", errors, journal.wet_ground);
  errors.throw_if_any();
}

}  // namespace

RoverJournalWriter::RoverJournalWriter(const std::string& path, const Rover& rover, bool micro_relief)
    : path_(path) {
  require_writable_file(path);
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (file >= 0) file_ = fdopen(file, "w");
  if (!file_) throw ConfigError(path + ": the journal cannot be written: " + std::strerror(errno));
  YAML::Emitter out;
  start_line(out);
  entry(out, "rover_journal", journal_version);
  entry(out, "micro_relief", micro_relief);
  out << YAML::Key << "rover" << YAML::Value << YAML::DoubleQuoted << rover.text();
  line(line_of(out));
}

RoverJournalWriter::~RoverJournalWriter() {
  if (std::fclose(file_) != 0) log_error(path_ + ": the journal cannot be closed: " + std::strerror(errno));
}

void RoverJournalWriter::line(const std::string& text) {
  if (std::fputs((text + "\n").c_str(), file_) < 0 || std::fflush(file_) != 0)
    throw Error(path_ + ": the journal cannot be written: " + std::strerror(errno));
}

void RoverJournalWriter::write(const RoverEvent& event) {
  YAML::Emitter out;
  start_line(out);
  std::visit([&out](const auto& e) { emit(out, e); }, event);
  line(line_of(out));
}

RoverJournal read_rover_journal(const std::string& path) {
  const std::string text = read_file(path);
  RoverJournal journal;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string where = path + ":" + std::to_string(number);
    try {
      if (number == 1)
        read_header(yaml::load_document(line), where, journal);
      else if (lines.eof())
        break;  // no newline at its end: it was cut off
      else
        journal.events.push_back(event_of(yaml::load_document(line)));
    } catch (const YAML::Exception& e) {
      throw ConfigError(where + ": " + e.what());
    } catch (const ConfigError& e) {
      throw number == 1 ? e : ConfigError(where + ": " + e.what());
    }
  }
  if (text.empty()) throw ConfigError(path + ": is not the journal of a rover");
  return journal;
}

void apply(Rover& rover, const RoverEvent& event, const GroundAtStep& ground) {
  if (const auto* place = std::get_if<Place>(&event)) {
    const GroundSource& at = ground(place->terrain);
    place->reset ? rover.reset(place->x, place->y, place->yaw, at)
                 : rover.place(place->x, place->y, place->yaw, at);
  } else if (const auto* drive = std::get_if<rover_event::Drive>(&event)) {
    rover.drive(drive->command, drive->seconds);
  } else if (const auto* state = std::get_if<SetState>(&event)) {
    rover.set_state(rover_state_of(state->bytes, rover, "journal"));
  } else {
    const auto& advance = std::get<Advance>(event);
    if (advance.terrain) rover.note_terrain(*advance.terrain, advance.time);
    rover.advance(advance.seconds, advance.terrain ? &ground(*advance.terrain) : nullptr);
  }
}

RoverState replay(const RoverJournal& journal, const GroundAtStep& ground,
                  const std::function<void(const RoverState&)>& watch) {
  Rover rover(journal.rover, journal.ground, "rover", journal.wet_ground);
  for (const RoverEvent& event : journal.events) {
    apply(rover, event, ground);
    if (watch) watch(rover.state());
  }
  return rover.state();
}

}  // namespace desert_sim
