#pragma once
/// Lists in messages.

#include <string>

namespace desert_sim {

/// What `name_of` says of each element of a range, separated by ", ".
template <class Range, class NameOf>
std::string joined(const Range& range, NameOf name_of) {
  std::string all;
  for (const auto& element : range) all += (all.empty() ? "" : ", ") + std::string(name_of(element));
  return all;
}

/// The names of a range, separated by ", ".
template <class Names>
std::string joined(const Names& names) {
  return joined(names, [](const auto& name) { return name; });
}

}  // namespace desert_sim
