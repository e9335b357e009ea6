#include "src/export/height_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "src/core/log.hpp"
#include "src/core/number_text.hpp"
#include "src/export/square_heights.hpp"
#include "src/io/picture.hpp"
#include "src/io/snapshots.hpp"

namespace desert_sim {

namespace {

constexpr double most_levels = 65535;
constexpr double coarse_step = 0.02;  // rounds heights by a centimetre [m]

}  // namespace

void write_colours(const std::string& path, int width, int height,
                   const std::vector<render::PackedColour>& colours) {
  constexpr int most = 8192;
  render::Picture picture{width, height, {}};
  picture.pixels.reserve(colours.size());
  for (int row = height - 1; row >= 0; --row) {
    const auto first = colours.begin() + static_cast<std::ptrdiff_t>(row) * width;
    picture.pixels.insert(picture.pixels.end(), first, first + width);
  }
  cv::Mat bgr = bgr_of(picture);
  if (const int longest = std::max(width, height); longest > most)
    cv::resize(bgr, bgr, {}, static_cast<double>(most) / longest, static_cast<double>(most) / longest,
               cv::INTER_AREA);
  write_png(path, bgr);
}

void write_elevation_exr(const std::string& path, const ExportedTerrain& terrain) {
  const Snapshot& s = *terrain.snapshot;
  write_exr(path, to_raster(s, *s.find(Layer::elevation), ""));
}

void write_height_png(const std::string& path, const ExportedTerrain& terrain) {
  const Snapshot& s = *terrain.snapshot;
  const Square square(s);
  const std::vector<float> heights = square.of(*s.find(Layer::elevation));
  const auto range = std::minmax_element(heights.begin(), heights.end());
  const double lowest = *range.first, relief = static_cast<double>(*range.second) - lowest;
  cv::Mat picture(square.side(), square.side(), CV_16UC1);
  for (int y = 0; y < square.side(); ++y)
    for (int x = 0; x < square.side(); ++x) {
      const double height = heights[static_cast<std::size_t>(y) * static_cast<std::size_t>(square.side()) +
                                    static_cast<std::size_t>(x)];
      picture.at<std::uint16_t>(square.side() - 1 - y, x) =
          static_cast<std::uint16_t>(relief > 0 ? std::lround((height - lowest) / relief * most_levels) : 0);
    }
  const double step = relief / most_levels;
  write_png(path, picture,
            frame_note(s) + "; 0 is " + number_text(lowest, 9) + " m high, 65535 is " +
                number_text(lowest + relief, 9) + " m; pixels are " + number_text(s.cell_size, 9) +
                " m apart, and the middle is at " + point_text(square.middle_x(), square.middle_y()));
  if (step > coarse_step)
    log_warning(std::filesystem::path(path).filename().string() + ": its heights are in steps of " +
                number_text(100 * step) + " cm, 1/65535 of the relief (.exr has them as they are)");
}

}  // namespace desert_sim
