#include "src/core/near_name.hpp"

#include <algorithm>
#include <set>

#include "src/core/did_you_mean.hpp"
#include "src/core/joined.hpp"

namespace desert_sim {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_names = 1000;  // of a folder: more would take long

/// Names that can stand in a list, sorted.
std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end && names.size() < most_names;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const bool plain =
        std::all_of(name.begin(), name.end(), [](unsigned char c) { return c >= ' ' && c != 0x7f; });
    if (plain && name[0] != '.' && name.find(", ") == std::string::npos) names.insert(name);
  }
  return names;
}

}  // namespace

std::string near_name(const fs::path& missing) {
  constexpr std::size_t shortest = 3;  // shorter ones are contained in too many
  std::error_code error;
  fs::path folder;
  auto part = missing.begin();
  for (; part != missing.end() && fs::exists(folder / *part, error); ++part) folder /= *part;
  if (part == missing.end()) return "";
  const std::set<std::string> names = names_in(folder.empty() ? "." : folder);
  const std::string near = did_you_mean(part->string(), joined(names)), stem = part->stem().string();
  if (!near.empty() || stem.size() < shortest) return near;
  for (const std::string& name : names)
    if (lower_case(name).find(lower_case(stem)) != std::string::npos)
      return "; did you mean " + in_quotes(name) + "?";
  return "";
}

}  // namespace desert_sim
