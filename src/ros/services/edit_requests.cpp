/// Requests that edit the terrain with a brush: ~edit_terrain and ~edit_plants.

#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "src/core/did_you_mean.hpp"
#include "src/core/elementary.hpp"
#include "src/io/raster_loader.hpp"
#include "src/ros/services/request_fields.hpp"
#include "src/ros/services/requests.hpp"
#include "src/simulation/commands/patch_raster.hpp"

namespace desert_sim {

namespace {

// ---- The shape of the brush, in the terrain's frame.

/// Throws if a frame is tilted so much that a direction in it has no meaning in the terrain's. (Points are
/// projected.)
void check_tilt(const tf2::Transform& transform, const std::string& frame) {
  const tf2::Vector3 up = transform.getBasis() * tf2::Vector3(0, 0, 1);
  const double tilt_deg = elementary::atan2_deg(elementary::hypot(up.x(), up.y()), up.z());
  if (tilt_deg <= 45) return;
  throw ConfigError("frame " + in_quotes(frame) + " is tilted by " + std::to_string(tilt_deg) +
                    " deg against the terrain's frame, so angle_deg is undefined (allowed: at most 45 deg)");
}

/// Sets the centre, and the sizes and the angle that the shape has.
template <class Request, class Command>
void set_rectangle(const Request& request, const tf2::Transform& transform, Command& command) {
  require_finite(request.center, "center");
  require_finite(request.angle_deg, "angle_deg");
  const tf2::Vector3 center = transform * tf2::Vector3(request.center.x, request.center.y, request.center.z);
  command.x = center.x();
  command.y = center.y();
  command.radius = request.radius;
  if (command.shape == BrushShape::circle) return;
  const bool same = transform == tf2::Transform::getIdentity();
  if (!same) check_tilt(transform, request.header.frame_id);
  command.radius_y = request.radius_y;
  command.angle_deg = same ? request.angle_deg : direction_in_terrain(request.angle_deg, transform);
}

template <class Request, class Command>
void set_points(const Request& request, const tf2::Transform& transform, Command& command) {
  constexpr std::size_t most = command::EditTerrain::max_points;
  if (request.points.size() > most)
    throw ConfigError("points: " + std::to_string(request.points.size()) + " are given (allowed: at most " +
                      std::to_string(most) + ")");
  for (std::size_t n = 0; n < request.points.size(); ++n) {
    const geometry_msgs::Point& given = request.points[n];
    require_finite(given, "points[" + std::to_string(n) + "]");
    const tf2::Vector3 p = transform * tf2::Vector3(given.x, given.y, given.z);
    command.points.push_back({p.x(), p.y()});
  }
}

/// Refuses the fields of shapes that this one does not use.
template <class Request>
void check_shape_fields(const Request& request, BrushShape shape) {
  const std::string why = "shape '" + request.shape + "' does not use it";
  const bool by_points = shape == BrushShape::capsule || shape == BrushShape::polygon;
  if (by_points)
    require_left_out(request.center, "center", why);
  else
    require_left_out(request.points, "points", why);
  if (shape == BrushShape::polygon) require_left_out(request.radius, "radius", why);
  if (by_points || shape == BrushShape::circle) {
    require_left_out(request.radius_y, "radius_y", why);
    require_left_out(request.angle_deg, "angle_deg", why);
  }
}

// ---- The image of a brush.

std::size_t bytes_per_pixel(const std::string& encoding) {
  namespace known = sensor_msgs::image_encodings;
  if (encoding == known::MONO8) return 1;
  if (encoding == known::MONO16) return 2;
  if (encoding == known::TYPE_32FC1) return 4;
  throw ConfigError("image.encoding: " + not_one_of(encoding, "mono8, mono16, 32FC1"));
}

/// Throws unless size, step and data fit together.
void require_size(const sensor_msgs::Image& image, std::size_t bytes) {
  const std::uint64_t pixels = std::uint64_t{image.width} * image.height;
  const std::string size = std::to_string(image.width) + " x " + std::to_string(image.height);
  if (pixels < 1 || pixels > static_cast<std::uint64_t>(command::Patch::max_pixels))
    throw ConfigError("image: " + size + " pixels (allowed: 1 to " +
                      std::to_string(command::Patch::max_pixels) + " in all)");
  if (image.step < image.width * bytes)
    throw ConfigError("image.step: " + std::to_string(image.step) + " is too small for " +
                      std::to_string(image.width) + " pixels of " + image.encoding + " (allowed: at least " +
                      std::to_string(image.width * bytes) + ")");
  if (image.data.size() != std::uint64_t{image.step} * image.height)
    throw ConfigError("image.data: " + std::to_string(image.data.size()) +
                      " bytes do not match an image of " + size + " pixels with step " +
                      std::to_string(image.step) +
                      " (allowed: " + std::to_string(std::uint64_t{image.step} * image.height) + ")");
}

/// A pixel of one or two bytes as 0 … 1 from black to white, one of four bytes as the float that it is.
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

/// The image as a patch of numbers: pixels times `scale`. Rows may be padded, and of either byte order.
/// Throws if the encoding is none of mono8, mono16 and 32FC1.
command::Patch patch_of(const sensor_msgs::Image& image, double scale) {
  const std::size_t bytes = bytes_per_pixel(image.encoding);
  require_size(image, bytes);
  command::Patch patch{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  patch.values.reserve(static_cast<std::size_t>(image.width) * image.height);
  for (std::size_t row = 0; row < image.height; ++row)
    for (std::size_t column = 0; column < image.width; ++column) {
      const double pixel =
          pixel_of(&image.data[row * image.step + column * bytes], bytes, image.is_bigendian != 0);
      // What a float cannot hold becomes infinite, which the simulation refuses, naming the pixel.
      const double value = pixel * scale;
      patch.values.push_back(std::abs(value) > 1e30 ? HUGE_VALF : static_cast<float>(value));
    }
  return patch;
}

/// A raster below the data folder as a patch; see patch_of_raster().
command::Patch patch_of_file(const DataFolder& files, const std::string& name, std::optional<double> scale) {
  return patch_of_raster(gdal_raster_loader({files.path(), false}), files.for_reading(name), name, scale);
}

void set_patch(const EditTerrainRequest& request, const DataFolder& files, command::EditTerrain& command) {
  command.patch_use = request.image_use.empty()
                          ? PatchUse::heights
                          : choice_named<PatchUse>(patch_uses, request.image_use, "image_use");
  const bool heights = command.patch_use == PatchUse::heights;
  if (!heights) require_left_out(request.image_scale, "image_scale", "image_use 'mask' does not use it");
  if (heights) require_finite(request.image_scale, "image_scale");
  if (!request.image.data.empty())
    require_left_out(request.image_file, "image_file", "image is given, which it would take the place of");
  if (request.image_file.empty()) {
    command.patch = patch_of(request.image, heights ? request.image_scale : 1.0);
    return;
  }
  command.patch = patch_of_file(files, request.image_file,
                                heights ? std::optional<double>(request.image_scale) : std::nullopt);
}

/// Refuses the fields that shape, merge and conserve do not use.
void check_edit_fields(const EditTerrainRequest& request, const command::EditTerrain& command) {
  check_shape_fields(request, command.shape);
  const std::string shape = "shape '" + request.shape + "' does not use it",
                    merge = "merge '" + request.merge + "' does not use it";
  const bool patch = command.shape == BrushShape::patch;
  if (patch || command.shape == BrushShape::polygon)
    require_left_out(request.inner, "inner", shape);
  else
    require_left_out(request.falloff, "falloff", shape);
  if (!patch) {
    require_left_out(request.image.data, "image", shape);
    require_left_out(request.image_file, "image_file", shape);
    require_left_out(request.image_use, "image_use", shape);
    require_left_out(request.image_scale, "image_scale", shape);
  }
  if (command.merge == BrushMerge::smooth) {
    require_left_out(request.value, "value", merge);
  } else {
    require_left_out(request.smooth_radius, "smooth_radius", merge);
    require_left_out(request.smooth_passes, "smooth_passes", merge);
  }
  if (!request.conserve)
    require_left_out(request.ring_width, "ring_width", "an edit without conserve does not use it");
}

}  // namespace

command::EditTerrain edit_command(const EditTerrainRequest& request, const TerrainTransforms& frames,
                                  const DataFolder& files) {
  command::EditTerrain command;
  command.layer = request.layer;
  command.shape = choice_named<BrushShape>(brush_shapes, request.shape, "shape");
  command.merge = choice_named<BrushMerge>(brush_merges, request.merge, "merge");
  check_edit_fields(request, command);
  const bool capsule = command.shape == BrushShape::capsule, polygon = command.shape == BrushShape::polygon;
  const bool patch = command.shape == BrushShape::patch;
  const tf2::Transform transform = frames.to_terrain(request.header);
  if (capsule || polygon)
    set_points(request, transform, command);
  else
    set_rectangle(request, transform, command);
  if (capsule) command.radius = request.radius;
  if (patch) set_patch(request, files, command);
  (polygon || patch ? command.falloff : command.inner) = polygon || patch ? request.falloff : request.inner;
  if (command.merge == BrushMerge::smooth) {
    command.smooth_radius = request.smooth_radius;
    command.smooth_passes = request.smooth_passes;
  } else {
    command.value = request.value;
  }
  command.conserve = request.conserve;
  if (command.conserve) command.ring_width = request.ring_width;
  command.stroke = request.stroke;
  return command;
}

command::EditPlants plants_command(const EditPlantsRequest& request, const TerrainTransforms& frames) {
  command::EditPlants command;
  command.operation = choice_named<PlantEdit>(plant_edits, request.operation, "operation");
  command.species = request.species;
  command.shape = choice_named<BrushShape>(brush_shapes, request.shape, "shape");
  if (command.shape == BrushShape::patch)
    throw ConfigError("shape: 'patch' is not one of: circle, ellipse, rectangle, capsule, polygon");
  check_shape_fields(request, command.shape);
  const bool capsule = command.shape == BrushShape::capsule;
  const tf2::Transform transform = frames.to_terrain(request.header);
  if (capsule || command.shape == BrushShape::polygon)
    set_points(request, transform, command);
  else
    set_rectangle(request, transform, command);
  if (capsule) command.radius = request.radius;
  if (command.operation == PlantEdit::plant) {
    command.density = request.density;
    command.size = request.size;
    command.seed = request.seed;
  } else {
    const std::string clear = "operation 'clear' does not use it";
    require_left_out(request.density, "density", clear);
    require_left_out(request.size, "size", clear);
    require_left_out(request.seed, "seed", clear);
  }
  command.stroke = request.stroke;
  return command;
}

}  // namespace desert_sim
