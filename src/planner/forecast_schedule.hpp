#pragma once
/// When a planner asks for a forecast of the terrain, and how coarse a one.

#include <algorithm>
#include <optional>

namespace desert_sim {

/// One at a time: whoever asks again before the first one is there never gets any on a busy machine. One that
/// takes longer than the period from request to request would always come late, so that the next one has
/// twice the stride (and takes half as long), up to `coarsest` times the one that is wanted; one that takes
/// less than a quarter of the period lets the next one have half the stride.
class ForecastSchedule {
 public:
  static constexpr int coarsest = 16, longest_stride = 1000;

  /// `period` from request to request [s]; `stride`: steps of the terrain that a step of the forecast stands
  /// for.
  ForecastSchedule(double period, int stride) : period_(period), wanted_(stride), stride_(stride) {}

  /// Whether it is time to ask; also where the time has gone back.
  bool due(double time) const {
    return !under_way_ && (!asked_ || time - *asked_ >= period_ || time < *asked_);
  }
  /// The next one is due as soon as none is under way: there is a new goal.
  void hurry() { asked_.reset(); }
  void ask(double time) {
    asked_ = began_ = time;
    under_way_ = true;
  }
  /// `arrived`: it was not refused or given up.
  void end(double time, bool arrived) {
    if (!under_way_) return;
    under_way_ = false;
    if (!arrived) return;
    const double took = time - began_;
    if (took > period_)
      stride_ = std::min({2 * stride_, coarsest * wanted_, longest_stride});
    else if (took < period_ / 4)
      stride_ = std::max(stride_ / 2, wanted_);
  }

  bool under_way() const { return under_way_; }
  int stride() const { return stride_; }  ///< of the one that is under way, else of the next

 private:
  double period_;
  int wanted_, stride_;
  std::optional<double> asked_;
  double began_ = 0;  ///< of the one that is under way
  bool under_way_ = false;
};

}  // namespace desert_sim
