#pragma once
/// Which map the change of a terrain is compared with: that of a chosen moment, or that of some seconds ago.

#include <cstddef>
#include <deque>
#include <memory>
#include <utility>

namespace desert_sim::render {

/// `Map`: any immutable map. Times are simulated [s]. Keeps at most `samples` + 2 maps, however many there
/// are.
template <class Map>
class ChangeReference {
 public:
  using Pointer = std::shared_ptr<const Map>;
  static constexpr std::size_t samples = 8;  ///< the time ago is met to this part of `seconds`

  /// Forgets all maps.
  void clear() { *this = ChangeReference(seconds_); }
  /// Compare with the map of so many seconds before the newest one; 0: with that of the last call of mark(),
  /// or with the first one.
  explicit ChangeReference(double seconds = 0) : seconds_(seconds) {}
  void set_seconds(double seconds) {
    seconds_ = seconds;
    history_.clear();
    if (newest_.second) history_.push_back(newest_);
  }
  double seconds() const { return seconds_; }

  /// Takes note of the newest map. Time may go back (a reset): then comparing begins anew.
  void add(double time, const Pointer& map) {
    if (newest_.second && time < newest_.first) clear();
    newest_ = {time, map};
    if (!marked_) marked_ = map;
    if (!(seconds_ > 0)) return;
    if (history_.empty() || time - history_.back().first >= seconds_ / samples) history_.push_back(newest_);
    // The oldest one goes once the next one is old enough.
    while (history_.size() > 1 && time - history_[1].first >= seconds_) history_.pop_front();
  }
  /// The newest map is the one to compare with from now on.
  void mark() { marked_ = newest_.second; }

  /// The map to compare with; null without any map.
  Pointer reference() const {
    if (!(seconds_ > 0)) return marked_;
    return history_.empty() ? nullptr : history_.front().second;
  }
  std::size_t size() const { return history_.size(); }

 private:
  double seconds_;
  std::pair<double, Pointer> newest_{0, nullptr};
  Pointer marked_;
  std::deque<std::pair<double, Pointer>> history_;
};

}  // namespace desert_sim::render
