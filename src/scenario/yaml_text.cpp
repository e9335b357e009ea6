#include "src/scenario/yaml_text.hpp"

#include <algorithm>
#include <optional>

#include "src/core/error.hpp"
#include "src/scenario/yaml_document.hpp"

namespace desert_sim::yaml_text {

MarkedText::MarkedText(const std::string& text) : text_(text) {
  for (std::size_t n = 0; n < text_.size(); ++n)
    if (text_[n] == '\n') lines_.push_back(n + 1);
}

std::size_t MarkedText::at(const YAML::Mark& mark) const {
  return lines_[static_cast<std::size_t>(mark.line)] + static_cast<std::size_t>(mark.column);
}

std::size_t MarkedText::line_of(std::size_t place) const {
  return *std::prev(std::upper_bound(lines_.begin(), lines_.end(), place));
}

std::size_t MarkedText::next_line(std::size_t place) const {
  const std::size_t end = text_.find('\n', place);
  return end == std::string::npos ? text_.size() : end + 1;
}

std::string MarkedText::with(std::vector<Change> changes) const {
  // From the end to the beginning, so that the places of what comes before stay true.
  std::stable_sort(changes.begin(), changes.end(),
                   [](const Change& a, const Change& b) { return a.begin > b.begin; });
  std::string changed = text_;
  for (const Change& change : changes) changed.replace(change.begin, change.end - change.begin, change.by);
  return changed;
}

YAML::Node parse(const std::string& text, const std::string& source) {
  try {
    return yaml::load_document(text);
  } catch (const YAML::Exception& e) {
    throw ConfigError(source + ": line " + std::to_string(e.mark.line + 1) + ": " + e.msg);
  }
}

YAML::Node key_of(const YAML::Node& map, const std::string& key) {
  for (const auto& entry : map)
    if (entry.first.IsScalar() && entry.first.Scalar() == key) return entry.first;
  throw Error("the key " + key + " is missing");
}

std::string indentation(const MarkedText& text, std::size_t place) {
  return std::string(place - text.line_of(place), ' ');
}

Change without_line(const MarkedText& text, std::size_t begin, std::size_t end) {
  const std::string& all = text.text();
  const std::size_t next = text.next_line(end), comment = all.find('#', end);
  const bool says_more = comment < next;
  return {text.line_of(begin), next,
          says_more ? indentation(text, begin) + all.substr(comment, next - comment) : ""};
}

namespace {

/// Where the entry after `key` begins, in the order of the text.
std::optional<std::size_t> next_entry(const MarkedText& text, const YAML::Node& map, std::size_t key) {
  std::optional<std::size_t> next;
  for (const auto& entry : map)
    if (const std::size_t at = text.at(entry.first.Mark()); at > key && (!next || at < *next)) next = at;
  return next;
}

}  // namespace

Change removal(const MarkedText& text, const YAML::Node& map, const std::string& key) {
  const std::size_t at = text.at(key_of(map, key).Mark());
  const std::string& all = text.text();
  if (map.Style() != YAML::EmitterStyle::Flow) return without_line(text, at, at);
  if (const auto next = next_entry(text, map, at)) return {at, *next, ""};
  const std::size_t comma = all.rfind(',', at);  // it is the last
  const std::size_t end = all.find_first_of(",}\n", at);
  return {comma, end, ""};
}

bool same(const YAML::Node& a, const YAML::Node& b) {
  if (a.Type() != b.Type() || (a.IsScalar() && a.Scalar() != b.Scalar()) || a.size() != b.size())
    return false;
  if (a.IsSequence())
    return std::equal(a.begin(), a.end(), b.begin(), [](const auto& x, const auto& y) { return same(x, y); });
  if (a.IsMap())
    return std::all_of(a.begin(), a.end(), [&](const auto& entry) {
      const YAML::Node other = b[entry.first.Scalar()];
      return other.IsDefined() && same(entry.second, other);
    });
  return true;
}

}  // namespace desert_sim::yaml_text
