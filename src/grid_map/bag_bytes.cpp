#include "src/grid_map/bag_bytes.hpp"

#include <cstdint>

namespace desert_sim {

namespace {

// Values of the field `op` of a record.
constexpr char message_record = 2, bag_header_record = 3, index_record = 4, chunk_record = 5,
               chunk_info_record = 6, connection_record = 7;
constexpr std::uint32_t connection_id = 0, one = 1, format_of_index = 1;
constexpr std::size_t bag_header_bytes = 4096;  // header and data of the first record together

/// The bytes of a number in the order of the host, which is that of the format: little-endian.
template <class T>
std::string bytes_of(const T& number) {
  return std::string(reinterpret_cast<const char*>(&number), sizeof number);
}
std::string bytes_of(const ros::Time& time) { return bytes_of(time.sec) + bytes_of(time.nsec); }

std::string with_length(const std::string& bytes) {
  return bytes_of(static_cast<std::uint32_t>(bytes.size())) + bytes;
}

std::string field(const std::string& name, const std::string& value) {
  return with_length(name + "=" + value);
}

/// The header of a record: `op` and more fields, with their length.
std::string header(char op, const std::string& fields) {
  return with_length(field("op", std::string(1, op)) + fields);
}

std::string bag_header(std::uint64_t index_position) {
  const std::string fields =
      header(bag_header_record, field("index_pos", bytes_of(index_position)) +
                                    field("conn_count", bytes_of(one)) + field("chunk_count", bytes_of(one)));
  const std::size_t padding = bag_header_bytes - (fields.size() - sizeof(std::uint32_t));
  return "#ROSBAG V2.0\n" + fields + with_length(std::string(padding, ' '));
}

}  // namespace

std::string bag_bytes(const std::string& topic, const ros::M_string& connection_header, const ros::Time& time,
                      const std::string& message) {
  std::string connection_fields;
  for (const auto& [name, value] : connection_header) connection_fields += field(name, value);
  const std::string id = field("conn", bytes_of(connection_id));
  const std::string connection =
      header(connection_record, id + field("topic", topic)) + with_length(connection_fields);
  const std::string message_header = header(message_record, id + field("time", bytes_of(time)));
  const auto chunk_size = static_cast<std::uint32_t>(connection.size() + message_header.size() +
                                                     sizeof(std::uint32_t) + message.size());
  const std::uint64_t chunk_position = bag_header(0).size();

  std::string bag;
  bag.reserve(chunk_position + chunk_size + connection.size() + 1024);  // growing could take twice the memory
  bag += bag_header(0);
  bag += header(chunk_record, field("compression", "none") + field("size", bytes_of(chunk_size)));
  bag += bytes_of(chunk_size);
  bag += connection;
  bag += message_header;
  bag += bytes_of(static_cast<std::uint32_t>(message.size()));
  bag += message;
  const auto message_offset = static_cast<std::uint32_t>(connection.size());
  bag += header(index_record, field("ver", bytes_of(format_of_index)) + id + field("count", bytes_of(one)));
  bag += with_length(bytes_of(time) + bytes_of(message_offset));
  const std::uint64_t index_position = bag.size();
  bag += connection;
  bag += header(chunk_info_record, field("ver", bytes_of(format_of_index)) +
                                       field("chunk_pos", bytes_of(chunk_position)) +
                                       field("start_time", bytes_of(time)) +
                                       field("end_time", bytes_of(time)) + field("count", bytes_of(one)));
  bag += with_length(bytes_of(connection_id) + bytes_of(one));
  return bag.replace(0, chunk_position, bag_header(index_position));
}

}  // namespace desert_sim
