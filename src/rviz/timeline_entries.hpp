#pragma once
/// The entries of a node's run.timeline as text. An entry is a map of YAML in flow style, which is kept as it
/// is: whoever changes one entry writes no other one anew.

#include <string>
#include <utility>
#include <vector>

namespace desert_sim {

using TimelineEntries = std::vector<std::string>;

/// The entries of a scenario that ~get_scenario tells.
TimelineEntries timeline_entries(const std::string& scenario);
/// The setting for ~apply_settings that replaces the timeline.
std::string timeline_setting(const TimelineEntries& entries);
/// Puts an entry behind all that are not later, and returns its place. One whose time is none comes last: the
/// node says what is wrong with it.
std::size_t insert_entry(TimelineEntries& entries, const std::string& entry);

/// A simulated time of an entry [s], as the digits that count.
std::string time_text(double seconds);

/// Reads a time of an entry, a number or one with a unit. False if it is none; `seconds` stays then.
bool read_entry_time(const std::string& text, double& seconds);

/// When an entry happens and what, in words.
struct EntryWords {
  std::string when, what;
  double end = 0;  ///< when it happens for the last time [s]
};
EntryWords words_of(const std::string& entry);

}  // namespace desert_sim
