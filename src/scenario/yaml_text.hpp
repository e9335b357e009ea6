#pragma once
/// Changes of the text of a YAML file that leave all else as it stands there, comments too.

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <string>
#include <vector>

namespace desert_sim::yaml_text {

/// What stands from `begin` to `end` is replaced.
struct Change {
  std::size_t begin, end;
  std::string by;
};

/// A text with the places in it of the marks that a parser gives.
class MarkedText {
 public:
  explicit MarkedText(const std::string& text);
  std::size_t at(const YAML::Mark& mark) const;
  std::size_t line_of(std::size_t place) const;    ///< where the line of a place begins
  std::size_t next_line(std::size_t place) const;  ///< where the one after it begins
  const std::string& text() const { return text_; }
  /// Changes in any order, none of which meet.
  std::string with(std::vector<Change> changes) const;

 private:
  std::string text_;
  std::vector<std::size_t> lines_{0};
};

/// Throws ConfigError, in the name of `source`, with the line of what is no YAML.
YAML::Node parse(const std::string& text, const std::string& source);

/// The key node of a map, which has the mark of where it stands. Throws Error if it has none of that name.
YAML::Node key_of(const YAML::Node& map, const std::string& key);

std::string indentation(const MarkedText& text, std::size_t place);

/// Takes out the lines from `begin` to `end`, but for the comment of the last.
Change without_line(const MarkedText& text, std::size_t begin, std::size_t end);

/// Takes an entry out of a map that has others.
Change removal(const MarkedText& text, const YAML::Node& map, const std::string& key);

/// Whether both say the same, in whatever order and style.
bool same(const YAML::Node& a, const YAML::Node& b);

}  // namespace desert_sim::yaml_text
