#include "src/testing/failure_picture.hpp"

#if DESERT_WITH_IO
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "kernels/view/cell_cost.hpp"
#include "src/io/picture.hpp"
#else
#include "src/core/error.hpp"
#endif

namespace desert_sim::test {

#if DESERT_WITH_IO

namespace {

const cv::Scalar white(255, 255, 255), red(40, 40, 230), blue(230, 120, 30), green(60, 200, 60);  // BGR

class Drawing {
 public:
  explicit Drawing(const LayerMap& map) : grid_(map.info()) {
    const std::vector<float> elevation = map.values();
    PictureInput input;
    input.width = static_cast<int>(grid_.width);
    input.height = static_cast<int>(grid_.height);
    input.cell_size = grid_.cell_size;
    input.elevation = elevation.data();
    image_ = hillshade_picture(input);
    pixels_per_metre_ = image_.cols / (grid_.width * grid_.cell_size);
  }

  void tint_lethal_cells(const std::vector<std::int8_t>& costs) {
    cv::Mat lethal(static_cast<int>(grid_.height), static_cast<int>(grid_.width), CV_8U, cv::Scalar(0));
    for (std::size_t n = 0; n < costs.size(); ++n)
      if (costs[n] == cell_cost::lethal) lethal.data[n] = 255;
    cv::flip(lethal, lethal, 0);
    cv::resize(lethal, lethal, image_.size(), 0, 0, cv::INTER_NEAREST);
    const cv::Mat tinted = 0.6 * image_ + cv::Mat(image_.size(), image_.type(), red) * 0.4;
    tinted.copyTo(image_, lethal);
  }

  void line(const std::vector<Point>& points, const cv::Scalar& colour) {
    for (std::size_t n = 1; n < points.size(); ++n)
      cv::line(image_, pixel(points[n - 1]), pixel(points[n]), colour, 2, cv::LINE_AA);
  }

  void cross(const Point& p) { cv::drawMarker(image_, pixel(p), green, cv::MARKER_TILTED_CROSS, 16, 3); }

  void arrow(const Pose& pose) {
    constexpr double length = 24;  // [pixels]
    const cv::Point at = pixel({pose.x, pose.y});
    const cv::Point tip(at.x + cvRound(length * std::cos(pose.yaw)),
                        at.y - cvRound(length * std::sin(pose.yaw)));
    cv::circle(image_, at, 6, red, cv::FILLED, cv::LINE_AA);
    cv::arrowedLine(image_, at, tip, red, 3, cv::LINE_AA, 0, 0.4);
  }

  const cv::Mat& image() const { return image_; }

 private:
  cv::Point pixel(const Point& p) const {
    return {cvRound((p.x - grid_.origin_x) * pixels_per_metre_),
            image_.rows - cvRound((p.y - grid_.origin_y) * pixels_per_metre_)};
  }

  const MapInfo grid_;
  cv::Mat image_;
  double pixels_per_metre_ = 1;
};

}  // namespace

void write_failure_picture(const std::string& path, const FailurePicture& picture) {
  Drawing drawing(*picture.elevation);
  drawing.tint_lethal_cells(picture.costs);
  drawing.line(picture.way, white);
  for (const std::vector<Point>& way : picture.paths) drawing.line(way, blue);
  if (picture.goal) drawing.cross(*picture.goal);
  if (picture.rover) drawing.arrow(*picture.rover);
  write_png(path, drawing.image());
}

#else

void write_failure_picture(const std::string& path, const FailurePicture&) {
  throw Error(path + ": this build writes no pictures: it was made without OpenCV");
}

#endif

}  // namespace desert_sim::test
