#include "src/client/waiting_notice.hpp"

#include <algorithm>

namespace desert_sim {

namespace {

constexpr std::chrono::seconds first_notice{3}, next_notice{30};

std::string last_name(const std::string& topic) { return topic.substr(topic.rfind('/') + 1); }

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

}  // namespace

std::string waiting_text(const std::vector<AwaitedTopic>& awaited,
                         const std::vector<std::string>& published) {
  std::vector<std::string> without, silent, instead;
  for (const AwaitedTopic& topic : awaited) (topic.has_publisher ? silent : without).push_back(topic.name);
  for (const std::string& topic : published)
    if (std::any_of(without.begin(), without.end(),
                    [&](const std::string& name) { return last_name(name) == last_name(topic); }))
      instead.push_back(topic);
  std::string text = "Waits for ";
  if (!without.empty()) text += joined(without) + ", which nobody publishes";
  if (!instead.empty()) text += " (but somebody does " + joined(instead) + ")";
  if (!without.empty() && !silent.empty()) text += ", and for ";
  if (!silent.empty()) text += joined(silent) + ", which has a publisher that has sent nothing yet";
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
