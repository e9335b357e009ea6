// Bags with a GridMap: raw bytes; or a bag of a map whose fields are filled from the input, with numbers
// changed in its records, and perhaps its chunk compressed after that.
#include <roslz4/lz4s.h>

#include <cstring>

#include "src/grid_map/bag_bytes.hpp"
#include "src/grid_map/grid_map_bag.hpp"
#include "test/fuzz/fuzz.hpp"
#include "test/fuzz/message_source.hpp"

namespace desert_sim {
namespace {

const std::vector<std::string> words{"elevation", "bedrock", "sand_depth",   "variance",
                                     "",          "map",     "column_index", "row_index"};
constexpr std::size_t chunk_begin = 13 + 8 + 4096;  // behind the first line and the header of the bag

template <class T = std::uint32_t>
T number_at(const std::string& bytes, std::size_t at) {
  T number = 0;
  if (at + sizeof number <= bytes.size()) std::memcpy(&number, &bytes[at], sizeof number);
  return number;
}
template <class T>
void set_number(std::string& bytes, std::size_t at, T number) {
  if (at + sizeof number <= bytes.size()) std::memcpy(&bytes[at], &number, sizeof number);
}

/// Gives the layers the size that the map says, or does not.
void fit_layers(GridMap& map, FuzzedDataProvider& data) {
  const auto rows = data.ConsumeIntegralInRange(1u, 9u), columns = data.ConsumeIntegralInRange(1u, 9u);
  map.layers.clear();
  for (std::size_t n = 0; n < map.data.size(); ++n) map.layers.push_back(words[n % words.size()]);
  for (std_msgs::Float32MultiArray& layer : map.data) {
    if (data.ConsumeBool()) continue;
    const float value = layer.data.empty() ? 1 : layer.data[0];
    layer.data.assign(std::size_t{rows} * columns, value);
    layer.layout.data_offset = 0;
    layer.layout.dim.resize(2);
    layer.layout.dim[0].label = "column_index";
    layer.layout.dim[0].size = columns;
    layer.layout.dim[1].label = "row_index";
    layer.layout.dim[1].size = rows;
  }
  if (data.ConsumeBool()) return;
  map.info.resolution = 0.5;
  map.info.length_x = 0.5 * rows;
  map.info.length_y = 0.5 * columns;
  map.info.pose.position.x = map.info.pose.position.y = 7;
  map.info.pose.orientation = geometry_msgs::Quaternion();
  map.outer_start_index = static_cast<std::uint16_t>(map.outer_start_index % rows);
  map.inner_start_index = static_cast<std::uint16_t>(map.inner_start_index % columns);
}

std::string bag_of(const GridMap& map) {
  std::string message(ros::serialization::serializationLength(map), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(message.data()),
                                     static_cast<std::uint32_t>(message.size()));
  ros::serialization::serialize(stream, map);
  using Type = GridMapType<GridMap>;
  return bag_bytes("/map", {{"type", Type::name}, {"md5sum", Type::md5}, {"message_definition", "float32 x"}},
                   ros::Time(10, 5), message);
}

/// Changes numbers, most often by little, which are lengths and places if they lie in a header.
void change_numbers(std::string& bag, std::size_t begin, std::size_t end, FuzzedDataProvider& data) {
  for (int changes = data.ConsumeIntegralInRange(0, 3); changes > 0 && begin + 4 < end; --changes) {
    const std::size_t at = data.ConsumeIntegralInRange(begin, end - 4);
    const auto number = number_at(bag, at);
    set_number(bag, at,
               data.ConsumeBool() ? number + static_cast<std::uint32_t>(data.ConsumeIntegralInRange(-9, 9))
                                  : data.ConsumeIntegral<std::uint32_t>());
  }
}

/// The bag with its chunk compressed, and the index found behind it.
std::string compressed(const std::string& bag) {
  const std::size_t header_size = number_at(bag, chunk_begin), data_at = chunk_begin + 4 + header_size;
  std::string chunk = bag.substr(data_at + 4, number_at(bag, data_at));
  std::string packed(chunk.size() + 1024, '\0');
  auto size = static_cast<unsigned int>(packed.size());
  const int block = 6;  // 4 MB
  if (roslz4_buffToBuffCompress(chunk.data(), static_cast<unsigned int>(chunk.size()), packed.data(), &size,
                                block) != ROSLZ4_OK)
    return bag;
  packed.resize(size);
  std::string header = bag.substr(chunk_begin + 4, header_size);
  const std::size_t name = header.find("compression=none");
  header.replace(name, 16, "compression=lz4");
  set_number(header, name - 4, std::uint32_t{15});
  std::string length(4, '\0');
  set_number(length, 0, static_cast<std::uint32_t>(header.size()));
  std::string result = bag.substr(0, chunk_begin) + length + header;
  set_number(length, 0, size);
  result += length + packed;
  const std::size_t index = result.find("index_pos=") + 10, before = data_at + 4 + chunk.size();
  set_number(result, index, number_at<std::uint64_t>(bag, index) - before + result.size());
  return result + bag.substr(before);
}

std::string built_bag(FuzzedDataProvider& data) {
  GridMap map;
  fuzz::FilledStream(data, words).next(map);
  fit_layers(map, data);
  std::string bag = bag_of(map);
  const std::size_t chunk_at = chunk_begin + 8 + number_at(bag, chunk_begin),
                    chunk_size = number_at(bag, chunk_at - 4);
  change_numbers(bag, chunk_at, std::min(bag.size(), chunk_at + chunk_size), data);
  const std::size_t size = bag.size();
  if (data.ConsumeBool()) bag = compressed(bag);
  if (data.ConsumeBool()) change_numbers(bag, bag.size() - (size - chunk_at - chunk_size), bag.size(), data);
  if (data.ConsumeBool()) change_numbers(bag, chunk_begin, chunk_at, data);
  if (data.ConsumeBool()) change_numbers(bag, 13, 120, data);
  return bag;
}

}  // namespace
}  // namespace desert_sim

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace desert_sim;
  FuzzedDataProvider data(bytes, size);
  const std::string bag = data.ConsumeBool() ? built_bag(data) : data.ConsumeRemainingBytesAsString();
  const fuzz::MemoryFile file(bag.data(), bag.size());
  return fuzz::accept_or_refuse([&] {
    const GridMap map = read_grid_map(file.path());
    RasterOptions options;
    options.band = data.ConsumeIntegralInRange(0, 4);
    to_raster(map, options, "fuzz");
  });
}
