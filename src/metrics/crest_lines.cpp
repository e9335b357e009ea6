#include "src/metrics/crest_lines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace desert_sim {

namespace {

constexpr double reach = 4;  ///< along a profile, between crests of one line on neighbouring profiles [cells]
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

struct Crest {
  double place = 0;  ///< along the profile [cells]
  double top = 0;    ///< [m]
  double low_before = unknown, low_after = unknown;
  bool linked_before = false, linked_after = false;  ///< with a crest of the profile before, after
};

/// Where the profiles lie on the grid [cells].
class Frame {
 public:
  Frame(const Field& f, double crest_deg)
      : field_(f), along_x_(std::cos(crest_deg * degree)), along_y_(std::sin(crest_deg * degree)) {
    profiles_ = extent(along_x_, along_y_);
    length_ = extent(along_y_, -along_x_);
  }
  int profiles() const { return profiles_; }  ///< as many as cover the grid
  int length() const { return length_; }      ///< of a profile across the grid [cells]
  double x(int profile, double place) const {
    return 0.5 * (field_.width - 1) + (profile - 0.5 * (profiles_ - 1)) * along_x_ +
           (place - 0.5 * (length_ - 1)) * along_y_;
  }
  double y(int profile, double place) const {
    return 0.5 * (field_.height - 1) + (profile - 0.5 * (profiles_ - 1)) * along_y_ -
           (place - 0.5 * (length_ - 1)) * along_x_;
  }
  /// Whether the place lies on the grid, at least `margin` cells from an open border.
  bool on_grid(int profile, double place, double margin) const {
    if (field_.periodic) return true;
    const double px = x(profile, place), py = y(profile, place);
    return px >= margin - 0.5 && py >= margin - 0.5 && px <= field_.width - 0.5 - margin &&
           py <= field_.height - 0.5 - margin;
  }

 private:
  int extent(double ex, double ey) const {
    return static_cast<int>(std::lround(std::abs(field_.width * ex) + std::abs(field_.height * ey)));
  }
  const Field& field_;
  double along_x_, along_y_;
  int profiles_ = 0, length_ = 0;
};

/// Follows one profile from place to place.
class CrestFinder {
 public:
  CrestFinder(double low, double high) : low_(low), high_(high) {}

  /// The next place, a cell further; `smooth` decides, `height` is measured.
  void add(double place, double smooth, double height) {
    if (!in_dune_ && smooth > high_) begin_dune();
    if (in_dune_ && smooth < low_) {
      in_dune_ = false;
      least_ = height;
    }
    if (in_dune_) {
      if (smooth > highest_smooth_) highest_smooth_ = smooth, crests_.back().place = place;
      crests_.back().top = std::max(crests_.back().top, height);
    } else {
      least_ = std::isnan(least_) ? height : std::min(least_, height);
    }
  }
  /// The terrain ends here; what follows does not belong together with what was.
  void interrupt() {
    if (!in_dune_) end_low();
    in_dune_ = false;
    has_former_ = false;
    least_ = unknown;
  }
  std::vector<Crest> finish() {
    interrupt();
    return std::move(crests_);
  }

 private:
  void begin_dune() {
    end_low();
    Crest crest;
    crest.top = -std::numeric_limits<double>::infinity();
    crest.low_before = least_;
    crests_.push_back(crest);
    highest_smooth_ = -std::numeric_limits<double>::infinity();
    in_dune_ = has_former_ = true;
  }
  void end_low() {
    if (has_former_) crests_.back().low_after = least_;
  }

  double low_, high_, highest_smooth_ = 0, least_ = unknown;
  bool in_dune_ = false, has_former_ = false;
  std::vector<Crest> crests_;
};

/// The crests of a profile; periodic ones go on by half their length at both ends, so that none is cut.
std::vector<Crest> find_crests(const Field& relief, const Field& smooth, const Frame& frame, int profile,
                               double low, double high) {
  const int beyond = relief.periodic ? frame.length() / 2 : 0;
  CrestFinder finder(low, high);
  for (int place = -beyond; place < frame.length() + beyond; ++place) {
    if (!frame.on_grid(profile, place, 0)) {
      finder.interrupt();
      continue;
    }
    const double x = frame.x(profile, place), y = frame.y(profile, place);
    finder.add(place, smooth.sample(x, y), relief.sample(x, y));
  }
  std::vector<Crest> crests = finder.finish();
  for (Crest& c : crests) {
    const auto beside = [&](double cells) {
      return smooth.sample(frame.x(profile, c.place + cells), frame.y(profile, c.place + cells));
    };
    c.place += parabola_top(beside(-1), beside(0), beside(1));
  }
  return crests;
}

/// Links each crest with at most one of the next profile, the nearest pairs first.
void link(std::vector<Crest>& here, std::vector<Crest>& next, std::vector<double>& lengths) {
  struct Pair {
    double distance;
    Crest *a, *b;
  };
  std::vector<Pair> pairs;
  for (Crest& a : here)
    for (Crest& b : next)
      if (const double d = std::abs(a.place - b.place); d <= reach) pairs.push_back({d, &a, &b});
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& p, const Pair& q) { return p.distance < q.distance; });
  lengths.assign(here.size(), 0.0);
  for (const Pair& p : pairs) {
    if (p.a->linked_after || p.b->linked_before) continue;
    p.a->linked_after = p.b->linked_before = true;
    lengths[static_cast<std::size_t>(p.a - here.data())] = std::hypot(1.0, p.distance);
  }
}

/// Adds the crests of a profile, whose neighbours have been linked, to the sums.
void add_profile(const Frame& frame, int profile, const std::vector<Crest>& crests,
                 const std::vector<double>& lengths, CrestLines& sums) {
  for (std::size_t n = 0; n < crests.size(); ++n) {
    const Crest& c = crests[n];
    if (c.place < 0 || c.place >= frame.length()) continue;  // counted at the other end
    sums.length += lengths[n];
    sums.terminations += !c.linked_before && frame.on_grid(profile - 1, c.place, reach) ? 1 : 0;
    sums.terminations += !c.linked_after && frame.on_grid(profile + 1, c.place, reach) ? 1 : 0;
    const double height = c.top - 0.5 * (c.low_before + c.low_after);
    if (std::isnan(height)) continue;  // a border cuts it
    ++sums.dunes;
    sums.mean_height += height;
    sums.highest = std::max(sums.highest, height);
  }
}

}  // namespace

CrestLines crest_lines(const Field& relief, double crest_deg, double sigma) {
  CrestLines sums;
  const Field smooth = smoothed(relief, sigma);
  double mean = 0;
  for (float v : smooth.values) mean += static_cast<double>(v) / static_cast<double>(smooth.values.size());
  const double deviation = roughness(smooth);
  if (!(deviation > 0)) return sums;
  const Frame frame(relief, crest_deg);
  const auto crests_of = [&](int profile) {
    return find_crests(relief, smooth, frame, profile, mean, mean + 0.25 * deviation);
  };
  // One profile more on both sides: there periodic fields go on, and others have no crests.
  std::vector<Crest> before = crests_of(-1), here = crests_of(0);
  std::vector<double> lengths;
  link(before, here, lengths);
  for (int profile = 0; profile < frame.profiles(); ++profile) {
    std::vector<Crest> next = crests_of(profile + 1);
    link(here, next, lengths);
    add_profile(frame, profile, here, lengths, sums);
    here = std::move(next);
  }
  sums.length *= relief.cell_size;
  if (sums.dunes > 0) sums.mean_height /= static_cast<double>(sums.dunes);
  return sums;
}

}  // namespace desert_sim
