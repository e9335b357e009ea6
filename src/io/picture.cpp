#include "src/io/picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iomanip>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <vector>

#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/render/terrain_colours.hpp"

namespace desert_sim {
namespace {

constexpr int min_long_side = 512, max_long_side = 2048;  // long side of a hillshade [pixels]
constexpr float unknown_value = std::numeric_limits<float>::quiet_NaN();
using Colour = cv::Vec3f;  // B, G, R in 0..255, OpenCV's order

/// A colour of the renderer in OpenCV's order.
Colour to_bgr(const render::Colour& c) { return Colour(c.b, c.g, c.r) * 255.0F; }

void check_input(int width, int height, double cell_size, const char* missing) {
  std::ostringstream text;
  if (width < 1 || height < 1)
    text << "the grid is " << width << " x " << height << ", must be at least 1 x 1";
  else if (!(cell_size > 0) || !std::isfinite(cell_size))
    text << "cell_size is " << cell_size << ", must be > 0";
  else if (missing)
    text << "the layer " << missing << " is needed";
  if (!text.str().empty()) throw ConfigError("picture: " + text.str());
}

/// The size at which a picture is computed: that of the grid, but at most max_long_side on its long side.
cv::Size working_size(int width, int height) {
  const int longest = std::max(width, height);
  if (longest <= max_long_side) return {width, height};
  const auto reduced = [&](int n) {
    return std::max(1, cvRound(static_cast<double>(n) * max_long_side / longest));
  };
  return {reduced(width), reduced(height)};
}

/// The finished picture enlarged by a whole number to at least `smallest` on its long side.
cv::Mat enlarged(const cv::Mat& picture, int smallest) {
  const int longest = std::max(picture.cols, picture.rows), factor = (smallest + longest - 1) / longest;
  if (factor <= 1) return picture;
  cv::Mat result;
  // In a picture of a very small grid, single cells stay visible.
  const int method = factor > 8 ? cv::INTER_NEAREST : cv::INTER_CUBIC;
  cv::resize(picture, result, picture.size() * factor, 0, 0, method);
  return result;
}

cv::Mat reduced(const cv::Mat& layer) {
  const cv::Size size = working_size(layer.cols, layer.rows);
  if (size == layer.size()) return layer;
  cv::Mat result;
  cv::resize(layer, result, size, 0, 0, cv::INTER_AREA);
  return result;
}

/// A layer at the working size, north up, with 0 in place of NaN; empty if the layer is not in use.
cv::Mat layer_image(const float* values, int width, int height) {
  if (!values) return {};
  const cv::Mat view(height, width, CV_32F, const_cast<float*>(values));  // not written to
  cv::Mat flipped;
  cv::flip(view, flipped, 0);
  flipped.setTo(0, flipped != flipped);
  return reduced(flipped);
}

/// The same for a layer of class numbers (species): it samples the nearest cell, since their mean has no
/// meaning.
cv::Mat class_image(const float* values, int width, int height) {
  if (!values) return {};
  const cv::Mat view(height, width, CV_32F, const_cast<float*>(values));  // not written to
  cv::Mat flipped, result;
  cv::flip(view, flipped, 0);
  cv::resize(flipped, result, working_size(width, height), 0, 0, cv::INTER_NEAREST);
  return result;
}

/// Elevation at the working size, north up. A pixel is the mean of its known cells, or NaN where less than
/// half of it is known.
cv::Mat elevation_image(const float* values, int width, int height) {
  cv::Mat elevation = layer_image(values, width, height);
  const cv::Mat view(height, width, CV_32F, const_cast<float*>(values));  // not written to
  cv::Mat known;
  cv::flip(view == view, known, 0);
  if (cv::countNonZero(known) == width * height) return elevation;
  known.convertTo(known, CV_32F, 1.0 / 255);
  known = reduced(known);
  elevation /= known;
  elevation.setTo(unknown_value, known < 0.5);
  return elevation;
}

/// Slope (dz/dx, dz/dy) with y north; a one-sided difference beside unknown ground and at the border.
cv::Vec2f gradient(const cv::Mat& elevation, int row, int column, float pixel_size) {
  const float here = elevation.at<float>(row, column);
  const auto along = [&](int row_step, int column_step) {
    float rise = 0;
    int reach = 0;
    for (int side : {-1, 1}) {
      const int r = row + side * row_step, c = column + side * column_step;
      if (r < 0 || c < 0 || r >= elevation.rows || c >= elevation.cols ||
          std::isnan(elevation.at<float>(r, c)))
        continue;
      rise += side * (elevation.at<float>(r, c) - here);
      ++reach;
    }
    return reach ? rise / (reach * pixel_size) : 0.0F;
  };
  return {along(0, 1), -along(1, 0)};
}

double exaggeration_of(const cv::Mat& elevation, float pixel_size) {
  constexpr float flat_slope = 1e-4F;
  constexpr double steep_share = 0.9, wanted_slope = 0.6, least_exaggeration = 0.5, most_exaggeration = 60;
  std::vector<float> slopes;
  const int stride = std::max(1, std::max(elevation.rows, elevation.cols) / min_long_side);
  for (int row = 0; row < elevation.rows; row += stride)
    for (int column = 0; column < elevation.cols; column += stride) {
      if (std::isnan(elevation.at<float>(row, column))) continue;
      const float slope = static_cast<float>(cv::norm(gradient(elevation, row, column, pixel_size)));
      if (slope > flat_slope) slopes.push_back(slope);
    }
  if (slopes.empty()) return 1;
  const auto steep =
      slopes.begin() + static_cast<std::ptrdiff_t>(steep_share * static_cast<double>(slopes.size() - 1));
  std::nth_element(slopes.begin(), steep, slopes.end());
  return std::clamp(wanted_slope / *steep, least_exaggeration, most_exaggeration);
}

/// Brightness by Lambert's law, 1 on flat ground; 0 where unknown.
cv::Mat shading(const cv::Mat& elevation, float pixel_size, double exaggeration) {
  const double altitude = 40 * CV_PI / 180, ambient = 0.3;
  const cv::Vec3f light(static_cast<float>(-std::cos(altitude) * std::sqrt(0.5)),
                        static_cast<float>(std::cos(altitude) * std::sqrt(0.5)),
                        static_cast<float>(std::sin(altitude)));
  cv::Mat shade(elevation.size(), CV_32F, cv::Scalar(0));
  const auto steepness = static_cast<float>(exaggeration);
  cv::parallel_for_({0, elevation.rows}, [&](const cv::Range& rows) {
    for (int row = rows.start; row < rows.end; ++row)
      for (int column = 0; column < elevation.cols; ++column) {
        if (std::isnan(elevation.at<float>(row, column))) continue;
        const cv::Vec2f slope = gradient(elevation, row, column, pixel_size) * steepness;
        const cv::Vec3f normal = cv::normalize(cv::Vec3f(-slope[0], -slope[1], 1));
        const float glow = std::max(0.0F, normal.dot(light)) / light[2];
        shade.at<float>(row, column) = static_cast<float>(ambient + (1 - ambient) * glow);
      }
  });
  return shade;
}

float value_at(const cv::Mat& layer, int row, int column) {
  return layer.empty() ? 0.0F : layer.at<float>(row, column);
}

Colour mix(const Colour& a, const Colour& b, float share) { return a * (1 - share) + b * share; }

/// The colour multiplied by `shade`. Where that exceeds the largest channel value, white is mixed in instead,
/// so that bright slopes keep their contrast.
Colour apply_shading(const Colour& colour, float shade) {
  const Colour white{225, 245, 255};
  const float most = 240 / std::max({colour[0], colour[1], colour[2], 1.0F});
  return shade <= most ? colour * shade : mix(colour * most, white, std::min(1.0F, shade - most));
}

struct Materials {
  cv::Mat sand, vegetation, plants, obstacle, water, soil, wind_shadow;  // empty if not in use
  const std::vector<std::array<float, 3>>& crown_colours;
  const render::Palette& palette;

  /// Colour of the ground lit with `shade`, and of the water on it.
  Colour colour(int row, int column, float shade) const {
    render::SurfaceMaterials m;
    m.sand = render::cover_of_depth(value_at(sand, row, column));
    m.soil = render::cover_of_depth(value_at(soil, row, column));
    m.vegetation = value_at(vegetation, row, column);
    m.obstacle = value_at(obstacle, row, column);
    const auto species = static_cast<std::size_t>(value_at(plants, row, column));
    if (species > 0 && species <= crown_colours.size()) {
      const auto& [r, g, b] = crown_colours[species - 1];
      m.plants = render::Colour{r, g, b};
    }
    Colour ground = to_bgr(ground_colour(m, palette));
    ground = apply_shading(ground,
                           shade * (1 - 0.12F * std::clamp(value_at(wind_shadow, row, column), 0.0F, 1.0F)));
    const float depth = std::max(value_at(water, row, column), 0.0F);
    const Colour water_colour = to_bgr(render::water_colour(depth, palette)) * (0.75F + 0.25F * shade);
    return mix(ground, water_colour, render::water_opacity(depth));
  }
};

std::string big_endian(std::uint32_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 255);
  return bytes;
}

/// A chunk of a PNG file: length, type and content, checksum (CRC-32).
std::string png_chunk(const std::string& type_and_content) {
  std::uint32_t crc = 0xffffffff;
  for (const char c : type_and_content) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return big_endian(static_cast<std::uint32_t>(type_and_content.size() - 4)) + type_and_content +
         big_endian(~crc);
}

/// Writes outlined text at the lower left; it is omitted if the picture is too small for it.
void write_caption(cv::Mat& picture, const std::string& text) {
  const double scale = std::max(0.45, picture.cols / 2200.0);
  const int face = cv::FONT_HERSHEY_SIMPLEX;
  int below = 0;
  const cv::Size size = cv::getTextSize(text, face, scale, 1, &below);
  if (size.width + 16 > picture.cols || 4 * size.height > picture.rows) return;
  const cv::Point at_left(8, picture.rows - 8 - below / 2);
  cv::putText(picture, text, at_left, face, scale, {30, 30, 30}, 3, cv::LINE_AA);
  cv::putText(picture, text, at_left, face, scale, {250, 250, 250}, 1, cv::LINE_AA);
}

/// The number with three significant digits, or with all digits of its integer part if these are more.
std::string number(double value) {
  std::ostringstream text;
  text << std::fixed
       << std::setprecision(std::abs(value) >= 100  ? 0
                            : std::abs(value) >= 10 ? 1
                                                    : 2)
       << value;
  return text.str();
}

void draw_arrow(cv::Mat& picture, cv::Point2f centre, cv::Point2f half, const cv::Scalar& colour,
                int thickness) {
  const auto point = [](cv::Point2f p) { return cv::Point(cvRound(p.x * 16), cvRound(p.y * 16)); };
  const cv::Point2f tip = centre + half, across(-half.y, half.x);
  cv::line(picture, point(centre - half), point(tip), colour, thickness, cv::LINE_AA, 4);
  for (float side : {-0.35F, 0.35F})
    cv::line(picture, point(tip), point(tip - half * 0.6F + across * side), colour, thickness, cv::LINE_AA,
             4);
}

/// Draws about 32 arrows along the long side, which point to where the air moves; their length is
/// proportional to the speed.
void draw_arrows(cv::Mat& picture, const cv::Mat& u, const cv::Mat& v, float fastest) {
  constexpr int hatches_across = 32;
  const float spacing = static_cast<float>(std::max(picture.cols, picture.rows)) / hatches_across;
  const float enlargement = static_cast<float>(picture.cols) / static_cast<float>(u.cols);
  const int thickness = std::max(1, picture.cols / 1024);
  for (float y = spacing / 2; y < static_cast<float>(picture.rows); y += spacing)
    for (float x = spacing / 2; x < static_cast<float>(picture.cols); x += spacing) {
      const cv::Point cell(static_cast<int>(x / enlargement), static_cast<int>(y / enlargement));
      const cv::Point2f wind(u.at<float>(cell), -v.at<float>(cell));  // a picture's y axis points down
      if (cv::norm(wind) <= 0.02 * fastest) continue;
      const cv::Point2f half = wind * (0.42F * spacing / fastest);
      draw_arrow(picture, {x, y}, half, {40, 40, 40}, thickness + 2);
      draw_arrow(picture, {x, y}, half, {255, 255, 255}, thickness);
    }
}

void shade_lightly(cv::Mat& picture, const cv::Mat& elevation, double pixel_size) {
  const auto size = static_cast<float>(pixel_size);
  const cv::Mat shade = shading(elevation, size, exaggeration_of(elevation, size));
  for (int row = 0; row < picture.rows; ++row)
    for (int column = 0; column < picture.cols; ++column) {
      auto& pixel = picture.at<cv::Vec3b>(row, column);
      const bool known = !std::isnan(elevation.at<float>(row, column));
      pixel = known ? Colour(pixel) * (0.55F + 0.45F * shade.at<float>(row, column))
                    : to_bgr(render::unknown_colour);
    }
}

}  // namespace

double picture_exaggeration(const PictureInput& input) {
  check_input(input.width, input.height, input.cell_size, input.elevation ? nullptr : "elevation");
  const cv::Mat elevation = elevation_image(input.elevation, input.width, input.height);
  return exaggeration_of(elevation, static_cast<float>(input.cell_size * input.width / elevation.cols));
}

cv::Mat hillshade_picture(const PictureInput& input) {
  check_input(input.width, input.height, input.cell_size, input.elevation ? nullptr : "elevation");
  const int width = input.width, height = input.height;
  const cv::Mat elevation = elevation_image(input.elevation, width, height);
  const auto pixel_size = static_cast<float>(input.cell_size * width / elevation.cols);
  const double exaggeration = exaggeration_of(elevation, pixel_size);
  const cv::Mat shade = shading(elevation, pixel_size, exaggeration);
  const Materials materials{layer_image(input.sand, width, height),
                            layer_image(input.vegetation, width, height),
                            class_image(input.plants, width, height),
                            layer_image(input.obstacle, width, height),
                            layer_image(input.water, width, height),
                            layer_image(input.soil, width, height),
                            layer_image(input.wind_shadow, width, height),
                            input.crown_colours,
                            input.palette};
  double lowest = 0, highest = 0;
  cv::minMaxLoc(elevation, &lowest, &highest, nullptr, nullptr, elevation == elevation);
  cv::Mat picture(elevation.size(), CV_8UC3);
  for (int row = 0; row < picture.rows; ++row)
    for (int column = 0; column < picture.cols; ++column) {
      const float z = elevation.at<float>(row, column);
      Colour colour = to_bgr(render::unknown_colour);
      if (!std::isnan(z)) {
        const float tint =
            highest > lowest ? static_cast<float>(0.16 * ((z - lowest) / (highest - lowest) - 0.5)) : 0;
        colour = materials.colour(row, column, shade.at<float>(row, column) * (1 + tint));
      }
      picture.at<cv::Vec3b>(row, column) = colour;
    }
  picture = enlarged(picture, min_long_side);
  write_caption(picture, number(width * input.cell_size) + " x " + number(height * input.cell_size) +
                             " m, relief " + number(highest - lowest) + " m, shaded z x" +
                             number(exaggeration));
  return picture;
}

cv::Mat wind_picture(int width, int height, double cell_size, const float* wind_x, const float* wind_y,
                     const float* elevation, const VectorCaption& caption) {
  check_input(width, height, cell_size, !wind_x ? "wind_x" : !wind_y ? "wind_y" : nullptr);
  const cv::Mat u = layer_image(wind_x, width, height), v = layer_image(wind_y, width, height);
  cv::Mat speed, level, picture;
  cv::magnitude(u, v, speed);
  double slowest = 0, fastest = 0;
  cv::minMaxLoc(speed, &slowest, &fastest);
  const double darkest = std::min(slowest, 0.9 * fastest);  // hides rounding noise of a uniform wind
  const double contrast = fastest > 0 ? 255 / (fastest - darkest) : 0;
  speed.convertTo(level, CV_8U, contrast, -contrast * darkest);
  cv::applyColorMap(level, picture, cv::COLORMAP_VIRIDIS);
  if (elevation)
    shade_lightly(picture, elevation_image(elevation, width, height), cell_size * width / picture.cols);
  picture = enlarged(picture, 2 * min_long_side);
  draw_arrows(picture, u, v, static_cast<float>(fastest));
  write_caption(picture, caption.name + (" " + number(slowest)) + " to " + number(fastest) + " " +
                             caption.unit + ", dark to bright");
  return picture;
}

cv::Mat bgr_of(const render::Picture& picture) {
  // Red lies in the lowest byte of a colour.
  const cv::Mat rgba(picture.height, picture.width, CV_8UC4,
                     const_cast<render::PackedColour*>(picture.pixels.data()));
  cv::Mat bgr;
  cv::cvtColor(rgba, bgr, cv::COLOR_RGBA2BGR);
  return bgr;
}

void write_png(const std::string& path, const cv::Mat& picture, const std::string& description) {
  const auto throw_error = [&](const std::string& reason) {
    throw ConfigError("picture '" + path + "' cannot be written: " + reason);
  };
  std::vector<unsigned char> bytes;
  try {
    if (picture.empty()) throw_error("it has no pixels");
    if (!cv::imencode(".png", picture, bytes)) throw_error("OpenCV cannot encode it");
  } catch (const cv::Exception& error) {
    throw_error(error.err);
  }
  constexpr std::size_t end_of_header = 33;  // signature, and the chunk with the size
  std::string file(bytes.begin(), bytes.end());
  if (!description.empty())
    file.insert(end_of_header, png_chunk("tEXt" + std::string("Description") + '\0' + description));
  write_file(path, file);
}

}  // namespace desert_sim
