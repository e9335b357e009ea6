#include "src/grid_map/grid_map_bag.hpp"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include "src/core/files.hpp"
#include "src/core/joined.hpp"
#include "src/core/quoted.hpp"
#include "src/grid_map/bag_bytes.hpp"
#include "src/grid_map/bag_records.hpp"
#include "src/grid_map/message_bytes.hpp"
#include "src/io/raster_loader.hpp"
#include "src/scenario/raster_grid.hpp"

namespace desert_sim {

namespace {

using Type = GridMapType<GridMap>;

constexpr double max_bag_bytes = 2e9;  // rosbag has 32-bit sizes and doubles its buffers

ros::M_string connection_header() {
  return {{"type", Type::name},
          {"md5sum", Type::md5},
          {"message_definition", Type::definition()},
          {"latching", "1"}};
}

std::string serialised(const GridMap& map) {
  std::string bytes(ros::serialization::serializationLength(map), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                     static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, map);
  return bytes;
}

void require_one_topic(rosbag::Bag& bag, rosbag::View& maps) {
  std::set<std::string> topics, types;
  for (const rosbag::ConnectionInfo* connection : maps.getConnections()) {
    topics.insert(connection->topic);
    if (connection->md5sum != Type::md5)
      throw ConfigError("its " + std::string(Type::name) + " has another message definition (md5sum " +
                        shortened(connection->md5sum) + " instead of " + Type::md5 + ")");
  }
  if (topics.size() > 1)
    throw ConfigError("contains GridMaps on several topics: " + shortened(joined(topics)) +
                      " (rosbag filter can extract one)");
  if (maps.size() > 0) return;
  rosbag::View all(bag);
  for (const rosbag::ConnectionInfo* connection : all.getConnections()) types.insert(connection->datatype);
  throw ConfigError("contains no " + std::string(Type::name) +
                    (types.empty() ? "" : " (it contains: " + shortened(joined(types)) + ")"));
}

GridMap read_last_map(rosbag::Bag& bag) {
  rosbag::View maps(bag, rosbag::TypeQuery(Type::name));
  require_one_topic(bag, maps);
  rosbag::View::iterator last = maps.begin();
  for (rosbag::View::iterator next = last; next != maps.end(); ++next) last = next;
  const std::uint32_t size = last->size();
  const std::unique_ptr<std::uint8_t[]> bytes(new std::uint8_t[size]);
  ros::serialization::OStream copy(bytes.get(), size);
  last->write(copy);
  BoundedInputStream message(bytes.get(), size);
  GridMap map;
  message.next(map);
  return map;
}

}  // namespace

void write_grid_map(const std::string& path, const std::string& topic, const GridMap& map) {
  double bytes = 0;
  for (const std_msgs::Float32MultiArray& layer : map.data)
    bytes += 4.0 * static_cast<double>(layer.data.size());
  if (bytes > max_bag_bytes)
    throw ConfigError(path + ": a bag cannot hold the " + std::to_string(bytes * 1e-9) + " GB of this map");
  const ros::Time time = std::max(map.info.header.stamp, ros::TIME_MIN);
  write_file(path, bag_bytes(topic, connection_header(), time, serialised(map)));
}

GridMap read_grid_map(const std::string& path, const std::string& folder) {
  const InputFile file(path, folder);
  try {
    validate_bag_records(file);
    rosbag::Bag bag(file.descriptor_path(), rosbag::bagmode::Read);
    return read_last_map(bag);
  } catch (const rosbag::BagUnindexedException&) {
    throw ConfigError(path + ": is truncated or still being recorded (rosbag reindex can repair it)");
  } catch (const ConfigError& e) {
    throw ConfigError(path + ": " + e.what());
  } catch (const std::exception& e) {
    throw ConfigError(path + ": is not a bag, or is truncated or corrupt: " + shortened(e.what()));
  }
}

RasterLoader raster_loader_with_bags(const RasterAccess& access) {
  return [access, gdal = gdal_raster_loader(access)](const RasterRequest& request) {
    if (!is_bag(request.path)) return gdal(request);
    const GridMap map = read_grid_map(request.path, access.folder);
    RasterField field = resample_to_request(to_raster(map, raster_options(request), request.path), request);
    field.bands = map.layers;
    return field;
  };
}

}  // namespace desert_sim
