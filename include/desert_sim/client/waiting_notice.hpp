#pragma once
/// Tells which topics a client waits for: one that has another name than the client thinks never comes, and
/// nothing else would say so.

#include <chrono>
#include <string>
#include <vector>

namespace desert_sim {

/// A topic on which nothing has come yet.
struct AwaitedTopic {
  std::string name;    ///< full name
  bool has_publisher;  ///< else nobody publishes it
};

/// What to say of topics that are awaited. `published`: topics of the same type that somebody publishes;
/// those that end in the same name are told, since the wanted one may be among them.
std::string waiting_text(const std::vector<AwaitedTopic>& awaited, const std::vector<std::string>& published);

/// When to say it: after three seconds of waiting, and every half minute from then on.
class WaitingNotice {
 public:
  using Clock = std::chrono::steady_clock;

  /// Whether to tell now, given whether something is awaited now.
  bool due(bool waits, Clock::time_point now);

 private:
  bool waits_ = false;
  Clock::time_point next_{};
};

}  // namespace desert_sim
