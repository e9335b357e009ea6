#pragma once
/// A camera that looks at a terrain obliquely from above, for pictures without a screen.

#include "src/render/view.hpp"

namespace desert_sim::render {

struct Camera {
  /// Where it stands, seen from the middle of what it looks at: counter-clockwise from +x (east), and above
  /// the horizon [deg].
  double azimuth_deg = -60, elevation_deg = 32;
  /// 1: all of it fits into the picture; 2: half of its length and height.
  double zoom = 1;
  double field_of_view_deg = 30;  ///< of the shorter side of the picture
};

/// Places in a picture: column and row of pixels from the upper left corner, and a depth that is smaller in
/// front: the negative reciprocal of the distance [1/m], which is linear in the picture.
struct PicturePoint {
  double column, row, depth;
  bool in_front;  ///< else the point lies behind the camera, and the rest means nothing
};

/// The camera in front of its subject.
class Projection {
 public:
  /// The subject is `box`, in which z is `exaggeration` times the height [m].
  Projection(const Camera& camera, const Box& box, int width, int height);

  PicturePoint project(const Point& point) const;
  /// For choose_levels(). Its terrain's frame has true heights.
  View view(double exaggeration) const;

 private:
  void fill_picture(const Box& box, double zoom);

  int width_, height_;
  Eigen::Matrix4d projection_ = Eigen::Matrix4d::Zero(), camera_from_terrain_ = Eigen::Matrix4d::Identity(),
                  clip_;
};

}  // namespace desert_sim::render
