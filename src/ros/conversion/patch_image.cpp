#include "src/ros/conversion/patch_image.hpp"

#include <sensor_msgs/image_encodings.h>

#include <cmath>
#include <cstring>

#include "src/core/error.hpp"
#include "src/core/quoted.hpp"

namespace desert_sim {

namespace {

std::size_t bytes_a_pixel(const std::string& encoding) {
  namespace known = sensor_msgs::image_encodings;
  if (encoding == known::MONO8) return 1;
  if (encoding == known::MONO16) return 2;
  if (encoding == known::TYPE_32FC1) return 4;
  throw ConfigError("image.encoding: " + quoted(encoding) + " is not one of: mono8, mono16, 32FC1");
}

void require_size(const sensor_msgs::Image& image, std::size_t bytes) {
  const std::uint64_t pixels = std::uint64_t{image.width} * image.height;
  const std::string size = std::to_string(image.width) + " x " + std::to_string(image.height);
  if (pixels < 1 || pixels > static_cast<std::uint64_t>(command::Patch::most_pixels))
    throw ConfigError("image: " + size + " pixels (allowed: 1 to " +
                      std::to_string(command::Patch::most_pixels) + " in all)");
  if (image.step < image.width * bytes)
    throw ConfigError("image.step: = " + std::to_string(image.step) + " is too little for " +
                      std::to_string(image.width) + " pixels of " + image.encoding + " (allowed: from " +
                      std::to_string(image.width * bytes) + ")");
  if (image.data.size() != std::uint64_t{image.step} * image.height)
    throw ConfigError("image.data: " + std::to_string(image.data.size()) + " bytes are not what " + size +
                      " with step " + std::to_string(image.step) +
                      " needs (allowed: " + std::to_string(std::uint64_t{image.step} * image.height) + ")");
}

double pixel_of(const std::uint8_t* bytes, std::size_t count, bool big_endian) {
  std::uint32_t bits = 0;
  for (std::size_t n = 0; n < count; ++n)
    bits |= std::uint32_t{bytes[n]} << (8 * (big_endian ? count - 1 - n : n));
  if (count == 1) return bits / 255.0;
  if (count == 2) return bits / 65535.0;
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace

command::Patch patch_of(const sensor_msgs::Image& image, double scale) {
  const std::size_t bytes = bytes_a_pixel(image.encoding);
  require_size(image, bytes);
  command::Patch patch{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  patch.values.reserve(static_cast<std::size_t>(image.width) * image.height);
  for (std::size_t row = 0; row < image.height; ++row)
    for (std::size_t column = 0; column < image.width; ++column) {
      const double pixel =
          pixel_of(&image.data[row * image.step + column * bytes], bytes, image.is_bigendian != 0);
      // What a float does not hold becomes infinite, which the simulation refuses by its place.
      const double value = pixel * scale;
      patch.values.push_back(std::abs(value) > 1e30 ? HUGE_VALF : static_cast<float>(value));
    }
  return patch;
}

}  // namespace desert_sim
