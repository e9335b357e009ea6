#include "src/scenario/former_keys.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "src/core/error.hpp"
#include "src/core/quoted.hpp"

namespace desert_sim {

namespace {

struct FormerKey {
  const char* section;
  const char* key;
  std::string path() const { return std::string(section) + "." + key; }
};
/// The first that names a model counts: slabs and grains took the place of saltation.
constexpr FormerKey former_keys[] = {{"slab_model", "kind"}, {"particle", "kind"}, {"saltation", "model"}};

const FormerKey* find_former_key(const std::string& path) {
  const auto found = std::find_if(std::begin(former_keys), std::end(former_keys),
                                  [&](const FormerKey& former) { return former.path() == path; });
  return found == std::end(former_keys) ? nullptr : found;
}

/// What a scenario or a command says with former keys, in their order.
using FormerValues = std::array<std::optional<std::string>, std::size(former_keys)>;

/// The model that they name; none if they only say which do not move the sand.
std::optional<std::string> model_of(const FormerValues& values, const std::string& source) {
  const auto names_a_model = [](const std::optional<std::string>& value) {
    return value && *value != "none";
  };
  const auto& [slabs, grains, saltation] = values;
  if (names_a_model(slabs) && names_a_model(grains))
    throw ConfigError(source + ": particle.kind: = " + *grains + " beside slab_model.kind = " + *slabs +
                      " (allowed: one model that moves the sand)");
  for (const auto& value : {slabs, grains})
    if (names_a_model(value)) return value;
  return saltation;
}

bool has_former_key(const YAML::Node& root, const FormerKey& former) {
  const YAML::Node section = root[former.section];
  return section.IsDefined() && section.IsMap() && section[former.key].IsDefined();
}

FormerValues values_in(const YAML::Node& root) {
  FormerValues values;
  for (std::size_t n = 0; n < values.size(); ++n)
    if (const FormerKey& former = former_keys[n]; has_former_key(root, former)) {
      const YAML::Node value = root[former.section][former.key];
      values[n] = value.IsScalar() ? value.Scalar() : "?";
    }
  return values;
}

/// The maps `set` of run.timeline.
std::vector<YAML::Node> timeline_settings(const YAML::Node& root) {
  std::vector<YAML::Node> maps;
  const YAML::Node run = root["run"];
  if (!run.IsDefined() || !run.IsMap() || !run["timeline"].IsDefined() || !run["timeline"].IsSequence())
    return maps;
  for (const YAML::Node& entry : run["timeline"])
    if (entry.IsMap() && entry["set"].IsDefined() && entry["set"].IsMap()) maps.push_back(entry["set"]);
  return maps;
}

bool is_none(const YAML::Node& value) { return value.IsScalar() && value.Scalar() == "none"; }

}  // namespace

std::string instead_of_former_key(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || !find_former_key(setting.substr(0, equals))) return "";
  const std::string value = setting.substr(equals + 1);
  return "is now sand.model; write sand.model=" + shortened(value == "none" ? "hops" : value) +
         " (in a file: sand: {model: " + shortened(value == "none" ? "hops" : value) +
         "}; desert_run --migrate FILE rewrites one)";
}

YAML::Node refuse_former_keys(const YAML::Node& given, ValidationErrors& errors) {
  const FormerValues values = values_in(given);
  YAML::Node root = given;
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (!values[n]) continue;
    const FormerKey& former = former_keys[n];
    errors.add(former.path(), instead_of_former_key(former.path() + "=" + *values[n]));
    if (root == given) root.reset(YAML::Clone(given));
    root[former.section].remove(former.key);
  }
  return root;
}

YAML::Node without_former_keys(const YAML::Node& given, const std::string& source) {
  YAML::Node root = YAML::Clone(given);
  if (!root.IsMap()) return root;
  const std::optional<std::string> model = model_of(values_in(root), source);
  for (const FormerKey& former : former_keys)
    if (has_former_key(root, former)) root[former.section].remove(former.key);
  if (model) root["sand"]["model"] = *model;
  for (YAML::Node settings : timeline_settings(root))
    for (const FormerKey& former : former_keys) {
      const YAML::Node value = settings[former.path()];
      if (!value.IsDefined()) continue;
      settings["sand.model"] = is_none(value) ? YAML::Node("hops") : YAML::Clone(value);
      settings.remove(former.path());
    }
  return root;
}

Settings without_former_keys(const Settings& settings, SandModel present, const std::string& source) {
  FormerValues values;
  Settings kept;
  for (const std::string& setting : settings) {
    const std::size_t equals = std::min(setting.find('='), setting.size());
    if (const FormerKey* former = find_former_key(setting.substr(0, equals)))
      values[static_cast<std::size_t>(former - former_keys)] =
          setting.substr(std::min(equals + 1, setting.size()));
    else
      kept.push_back(setting);
  }
  if (kept.size() == settings.size()) return settings;
  const bool saltates = is_saltation(present), flies = present == SandModel::wang;
  const FormerValues before{saltates || flies ? "none" : name_of(present), flies ? name_of(present) : "none",
                            saltates ? name_of(present) : name_of(SandModel::hops)};
  for (std::size_t n = 0; n < values.size(); ++n)
    if (!values[n]) values[n] = before[n];
  kept.push_back("sand.model=" + *model_of(values, source));
  return kept;
}

// ---- The text of a file.

namespace {

/// A text by lines, changed from its end to its beginning, so that marks of what comes before stay true.
class MarkedText {
 public:
  explicit MarkedText(const std::string& text) : text_(text) {
    for (std::size_t n = 0; n < text_.size(); ++n)
      if (text_[n] == '\n') lines_.push_back(n + 1);
  }
  std::size_t at(const YAML::Mark& mark) const {
    return lines_[static_cast<std::size_t>(mark.line)] + static_cast<std::size_t>(mark.column);
  }
  std::size_t line_of(std::size_t place) const {
    return *std::prev(std::upper_bound(lines_.begin(), lines_.end(), place));
  }
  std::size_t next_line(std::size_t place) const {
    const std::size_t end = text_.find('\n', place);
    return end == std::string::npos ? text_.size() : end + 1;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::vector<std::size_t> lines_{0};
};

struct Change {
  std::size_t begin, end;
  std::string by;
};

YAML::Node parse(const std::string& text, const std::string& source) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& e) {
    throw ConfigError(source + ": line " + std::to_string(e.mark.line + 1) + ": " + e.msg);
  }
}

/// The key node of a map, which has the mark of where it stands.
YAML::Node key_of(const YAML::Node& map, const std::string& key) {
  for (const auto& entry : map)
    if (entry.first.IsScalar() && entry.first.Scalar() == key) return entry.first;
  throw Error("the key " + key + " is missing");
}

/// Where the entry after `key` begins, in the order of the text.
std::optional<std::size_t> next_entry(const MarkedText& text, const YAML::Node& map, std::size_t key) {
  std::optional<std::size_t> next;
  for (const auto& entry : map)
    if (const std::size_t at = text.at(entry.first.Mark()); at > key && (!next || at < *next)) next = at;
  return next;
}

std::string indentation(const MarkedText& text, std::size_t place) {
  return std::string(place - text.line_of(place), ' ');
}

/// Takes out the lines from `begin` to `end`, but for the comment of the last.
Change without_line(const MarkedText& text, std::size_t begin, std::size_t end) {
  const std::string& all = text.text();
  const std::size_t next = text.next_line(end), comment = all.find('#', end);
  const bool says_more = comment < next;
  return {text.line_of(begin), next,
          says_more ? indentation(text, begin) + all.substr(comment, next - comment) : ""};
}

/// Takes an entry out of a section that has others.
Change removal(const MarkedText& text, const YAML::Node& section, const FormerKey& former) {
  const std::size_t key = text.at(key_of(section, former.key).Mark());
  const std::string& all = text.text();
  if (section.Style() != YAML::EmitterStyle::Flow) return without_line(text, key, key);
  if (const auto next = next_entry(text, section, key)) return {key, *next, ""};
  const std::size_t comma = all.rfind(',', key);  // it is the last
  const std::size_t end = all.find_first_of(",}\n", key);
  return {comma, end, ""};
}

/// What makes a section of its only entry.
std::vector<Change> renaming(const MarkedText& text, const YAML::Node& root, const FormerKey& former,
                             const std::string& model) {
  const YAML::Node section = root[former.section];
  const std::size_t name = text.at(key_of(root, former.section).Mark()),
                    key = text.at(key_of(section, former.key).Mark()),
                    value = text.at(section[former.key].Mark());
  const std::size_t length = section[former.key].Scalar().size();
  return {{name, name + std::string(former.section).size(), "sand"},
          {key, key + std::string(former.key).size(), "model"},
          {value, value + length, model}};
}

std::vector<Change> changes_of(const MarkedText& text, const YAML::Node& root, const std::string& source) {
  std::vector<Change> changes;
  std::optional<std::string> model = model_of(values_in(root), source);
  const bool has_section = root["sand"].IsDefined();
  for (const FormerKey& former : former_keys) {
    if (!has_former_key(root, former)) continue;
    const YAML::Node section = root[former.section];
    const std::size_t name = text.at(key_of(root, former.section).Mark());
    const bool counts = model && section[former.key].Scalar() == *model && !has_section;
    if (section.size() == 1 && counts) {
      for (const Change& change : renaming(text, root, former, *model)) changes.push_back(change);
      model.reset();
      continue;
    }
    if (section.size() == 1) {  // it switches off what nothing else is said of
      changes.push_back(without_line(text, name, text.at(section[former.key].Mark())));
      continue;
    }
    changes.push_back(removal(text, section, former));
    if (!counts) continue;
    const bool flow = root.Style() == YAML::EmitterStyle::Flow;
    const std::string end = flow ? ", " : "\n" + indentation(text, name);
    changes.push_back({name, name, "sand: {model: " + *model + "}" + end});
    model.reset();
  }
  for (const YAML::Node& settings : timeline_settings(root))
    for (const FormerKey& former : former_keys) {
      if (!settings[former.path()].IsDefined()) continue;
      const std::size_t key = text.at(key_of(settings, former.path()).Mark());
      changes.push_back({key, key + former.path().size(), "sand.model"});
      const YAML::Node value = settings[former.path()];
      const std::size_t at = text.at(value.Mark());
      if (is_none(value)) changes.push_back({at, at + value.Scalar().size(), "hops"});
    }
  return changes;
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

/// Sections that have become empty say nothing.
YAML::Node without_empty_sections(const YAML::Node& root) {
  YAML::Node kept(YAML::NodeType::Map);
  for (const auto& entry : root)
    if (!(entry.second.IsMap() && entry.second.size() == 0)) kept[entry.first.Scalar()] = entry.second;
  return kept;
}

}  // namespace

std::string migrated(const std::string& given, const std::string& source) {
  const std::string byte_order_mark = "\xEF\xBB\xBF";
  const bool marked = given.compare(0, byte_order_mark.size(), byte_order_mark) == 0;
  const MarkedText text(marked ? given.substr(byte_order_mark.size()) : given);
  const YAML::Node root = parse(text.text(), source);
  if (!root.IsMap()) return given;
  std::vector<Change> changes = changes_of(text, root, source);
  std::sort(changes.begin(), changes.end(),
            [](const Change& a, const Change& b) { return a.begin > b.begin; });
  std::string changed = text.text();
  for (const Change& change : changes) changed.replace(change.begin, change.end - change.begin, change.by);
  const YAML::Node wanted = without_empty_sections(without_former_keys(root, source));
  if (!same(wanted, without_empty_sections(parse(changed, source))))
    throw ConfigError(source +
                      ": cannot be rewritten; write sand: {model: ...} in the place of "
                      "slab_model.kind, particle.kind and saltation.model by hand");
  return (marked ? byte_order_mark : "") + changed;
}

}  // namespace desert_sim
