#include "src/simulation/journal.hpp"

#include <fcntl.h>
#include <yaml-cpp/yaml.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "src/core/files.hpp"
#include "src/core/log.hpp"
#include "src/scenario/yaml_document.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/simulation/commands/command_yaml.hpp"

namespace desert_sim {

namespace {

constexpr int journal_version = 3;

/// One line of YAML in flow style.
class Line {
 public:
  Line() {
    yaml::set_full_precision(out_);
    out_.SetMapFormat(YAML::Flow);
    out_.SetSeqFormat(YAML::Flow);
    out_ << YAML::BeginMap;
  }
  template <class T>
  Line& entry(const char* key, const T& value) {
    out_ << YAML::Key << key << YAML::Value << value;
    return *this;
  }
  Line& command(const Command& command) {
    emit_command(out_, command);
    return *this;
  }
  /// Flow style breaks long lines; a line of a journal is one line.
  std::string text() {
    out_ << YAML::EndMap;
    std::string text = out_.c_str();
    for (char& c : text)
      if (c == '\n') c = ' ';
    return text;
  }

 private:
  YAML::Emitter out_;
};

}  // namespace

JournalWriter::JournalWriter(const std::string& path, std::uint64_t scenario_hash, const std::string& backend,
                             std::size_t undo_memory)
    : path_(path) {
  require_writable_file(path);
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (file >= 0) file_ = fdopen(file, "w");
  if (!file_) throw ConfigError(path + ": the journal cannot be written: " + std::strerror(errno));
  line(Line()
           .entry("journal", journal_version)
           .entry("scenario_hash", scenario_hash)
           .entry("backend", backend)
           .entry("undo_memory", undo_memory)
           .text());
}

JournalWriter::~JournalWriter() {
  if (std::fclose(file_) != 0) log_error(path_ + ": the journal cannot be closed: " + std::strerror(errno));
}

void JournalWriter::line(const std::string& text) {
  if (std::fputs((text + "\n").c_str(), file_) < 0 || std::fflush(file_) != 0)
    throw Error(path_ + ": the journal cannot be written: " + std::strerror(errno));
}

void JournalWriter::write(std::uint64_t tick, const Command& command) {
  line(Line().entry("tick", tick).command(command).text());
}

void JournalWriter::end(std::uint64_t tick) {
  line(Line().entry("tick", tick).entry("command", "end").text());
}

std::vector<std::string> checkpoints_of(const Journal& journal) {
  std::vector<std::string> paths;
  for (const Journal::Entry& entry : journal.entries)
    if (const auto* load = std::get_if<command::LoadCheckpoint>(&entry.command)) paths.push_back(load->path);
  return paths;
}

Journal read_journal(const std::string& path) {
  std::istringstream file(read_file(path));
  Journal journal;
  std::string text;
  for (int n = 1; std::getline(file, text); ++n) {
    const std::string source = path + ": line " + std::to_string(n);
    if (file.eof()) break;  // no newline: the writer was killed in the middle of it
    YAML::Node node;
    try {
      node = yaml::load_document(text);
    } catch (const YAML::Exception& e) {
      throw ConfigError(source + ": " + e.msg);
    }
    const auto number = [&](const char* key) {
      std::uint64_t value = 0;
      if (!node.IsMap() || !node[key] || !YAML::convert<std::uint64_t>::decode(node[key], value))
        throw ConfigError(source + ": the key '" + std::string(key) + "' is missing");
      return value;
    };
    if (n == 1) {
      const std::uint64_t version = number("journal");
      if (version < 1 || version > journal_version)
        throw ConfigError(source + ": is a journal of version " + std::to_string(version) +
                          " (allowed: 1 to " + std::to_string(journal_version) + ")");
      journal.version = static_cast<int>(version);
      journal.scenario_hash = number("scenario_hash");
      journal.backend = node["backend"] ? node["backend"].Scalar() : "";
      if (node["undo_memory"])  // journals of version 0.1 have none
        journal.undo_memory = number("undo_memory");
      continue;
    }
    const std::uint64_t tick = number("tick");
    if (journal.ended || tick < journal.ticks)
      throw ConfigError(source + ": tick " + std::to_string(tick) + " is out of order");
    journal.ticks = tick;
    if (node["command"] && node["command"].IsScalar() && node["command"].Scalar() == "end")
      journal.ended = true;
    else
      journal.entries.push_back({tick, read_command(node, source)});
  }
  if (journal.scenario_hash == 0 && journal.backend.empty()) throw ConfigError(path + ": is not a journal");
  return journal;
}

void make_way_for_journal(const std::string& path) {
  namespace fs = std::filesystem;
  if (path.empty()) return;
  std::error_code error;
  fs::create_directories(fs::absolute(path).parent_path(), error);
  if (error) throw ConfigError(path + ": the folder of the journal cannot be made: " + error.message());
  if (!fs::is_regular_file(path, error)) return;
  fs::rename(path, previous_journal(path), error);
  if (error)
    throw ConfigError(path + ": the previous journal cannot be renamed to *.previous: " + error.message());
}

std::vector<std::string> checkpoints_of_previous(const std::string& path) {
  if (path.empty() || !std::filesystem::exists(previous_journal(path))) return {};
  try {
    return checkpoints_of(read_journal(previous_journal(path)));
  } catch (const ConfigError& e) {
    log_error(std::string("what the previous journal loads is not kept: ") + e.what());
  }
  return {};
}

std::string checkpoint_beside(const std::string& path) {
  const std::string usual = path + ".checkpoint";
  for (const std::string& needed : checkpoints_of_previous(path))
    if (same_file(needed, usual)) return usual + ".2";
  return usual;
}

}  // namespace desert_sim
