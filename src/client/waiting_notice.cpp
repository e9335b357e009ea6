#include "include/desert_sim/client/waiting_notice.hpp"

#include <algorithm>

#include "src/core/joined.hpp"

namespace desert_sim {

namespace {

constexpr std::chrono::seconds first_notice{3}, next_notice{30};

std::string last_name(const std::string& topic) { return topic.substr(topic.rfind('/') + 1); }

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string waiting_text(const std::vector<AwaitedTopic>& awaited,
                         const std::vector<std::string>& published) {
  std::vector<std::string> without, silent, instead;
  for (const AwaitedTopic& topic : awaited) {
    // What has just been subscribed to may not be connected yet.
    const bool is_published = topic.has_publisher || contains(published, topic.name);
    (is_published ? silent : without).push_back(topic.name);
  }
  for (const std::string& topic : published)
    if (std::any_of(without.begin(), without.end(),
                    [&](const std::string& name) { return last_name(name) == last_name(topic); }))
      instead.push_back(topic);
  std::string text = "The terrain client waits.";
  if (!without.empty()) text += " Nobody publishes " + joined(without);
  if (!instead.empty()) text += " (somebody does " + joined(instead) + ")";
  if (!without.empty()) text += ".";
  if (!silent.empty()) text += " Nothing has come yet of " + joined(silent) + ".";
  return text;
}

bool WaitingNotice::due(bool waits, Clock::time_point now) {
  if (waits && !waits_) next_ = now + first_notice;
  waits_ = waits;
  if (!waits || now < next_) return false;
  next_ = now + next_notice;
  return true;
}

}  // namespace desert_sim
