#pragma once
/// The path of a brush from press to release, and the capsules that paint it. A capsule is what a circle
/// covers that moves along a line segment. However fast the path grows and however slowly capsules are
/// taken, nothing of it is lost, and it is cut in the same way: a slow node gets the same stroke.

#include <deque>
#include <optional>

#include "src/render/height_field.hpp"

namespace desert_sim::render {

/// The axis of a capsule; a circle if both ends are the same.
struct Capsule {
  Place from, to;

  double length() const { return distance(from, to); }
};

/// The part of a brush's strength that one capsule of a path has to give [1], so that a pass of the brush
/// along a straight path gives its strength on the axis, in the mean, however the path is cut: for lengths
/// L the capsules overlap 1 + r (1 + inner) / L times, where the weight is 1 up to `inner` r and falls to 0
/// at the radius r [m]. 1 for a circle.
double share_of_depth(const Capsule& capsule, double radius, double inner);
/// The same for what is spread evenly over the capsule's area.
double share_of_area(const Capsule& capsule, double radius);

class StrokePath {
 public:
  /// A capsule is as long as `piece`, but where the path turns, so that none of its places is further than
  /// `tolerance` from the axis, and at the end [m]. Only where more than 64 pieces wait are they longer.
  StrokePath(double piece, double tolerance) : piece_(piece), tolerance_(tolerance) {}

  void add(const Place& place);
  /// The next place begins another line: the brush was lifted in between, or left the terrain.
  void lift();
  /// Nothing more will be added.
  void end();

  /// The next capsule, which begins where the last one of the line ended. Empty if there is none, or if
  /// more of the path has to come first. A line of one place is a circle.
  std::optional<Capsule> take();
  /// Whether the path has ended and all its capsules are taken.
  bool finished() const { return ended_ && lines_.empty(); }

 private:
  struct Line {
    std::deque<Place> places;  ///< from the end of the last capsule on
    bool closed = false;
    bool begun = false;  ///< a capsule of it has been taken
  };

  /// Where the next capsule of the line ends; what it passes is gone. Empty if more has to come first.
  std::optional<Place> cut(Line& line) const;
  /// The length of the path that no capsule has passed [m].
  double waiting() const;

  const double piece_, tolerance_;
  std::deque<Line> lines_;
  bool ended_ = false;
};

}  // namespace desert_sim::render
