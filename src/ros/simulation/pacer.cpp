#include "src/ros/simulation/pacer.hpp"

#include <algorithm>

namespace desert_sim {

double Pacer::due_time() const { return start_ + static_cast<double>(done_) / rate_; }

bool Pacer::due(double now) {
  if (rate_ <= 0) return true;
  if (running_ && now < last_) {
    running_ = false;
    jumped_back_ = true;
  }
  if (!running_) {
    running_ = true;
    start_ = now;
    done_ = 0;
    dropped_time_ = 0;
  }
  last_ = now;
  const double behind = now - due_time() - backlog;
  if (behind > 0) {
    start_ += behind;
    dropped_time_ += behind;
  }
  return now >= due_time();
}

void Pacer::drop_backlog(double now) {
  if (rate_ > 0 && running_) start_ += std::max(0.0, now - due_time());
}

void Pacer::stepped(double rate) {
  if (rate_ > 0) ++done_;
  if (rate != rate_) begin(rate, due_time() - 1 / rate_ + 1 / rate);
}

void Pacer::change_rate(double rate, double now) {
  if (rate == rate_) return;
  const double share_left = std::clamp((due_time() - now) * rate_, 0.0, 1.0);
  begin(rate, now + share_left / rate);
  dropped_time_ = 0;
}

/// Starts again from the first due time, or, where one of the rates is none, from the next call of due().
void Pacer::begin(double rate, double first_due) {
  running_ = running_ && rate_ > 0 && rate > 0;
  rate_ = rate;
  start_ = first_due;
  done_ = 0;
}

double Pacer::until_due(double now) const {
  return rate_ <= 0 || !running_ ? 0.0 : std::max(0.0, due_time() - now);
}

double Pacer::lag(double now) const {
  return rate_ <= 0 || !running_ ? 0.0 : dropped_time_ + std::max(0.0, now - due_time());
}

bool Pacer::jumped_back() {
  const bool jumped = jumped_back_;
  jumped_back_ = false;
  return jumped;
}

void RateMeter::count(double now) {
  constexpr double window = 2.0, min_interval = 0.05;
  ++steps_;
  if (!marks_.empty() && now - marks_.back().time < min_interval) return;
  marks_.push_back({now, steps_});
  while (marks_.size() > 2 && now - marks_[1].time > window) marks_.pop_front();
}

double RateMeter::rate(double now) const {
  if (marks_.size() < 2) return 0.0;
  // If no more steps come, the rate falls as time goes on.
  const double interval = (marks_.back().time - marks_.front().time) / static_cast<double>(marks_.size() - 1);
  const double last = marks_.back().time, end = now - last > 2 * interval + 0.5 ? now : last;
  return static_cast<double>(marks_.back().steps - marks_.front().steps) / (end - marks_.front().time);
}

}  // namespace desert_sim
