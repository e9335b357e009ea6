#pragma once
/// Deserialization of messages from files that may be corrupt.

#include <ros/serialization.h>

#include <cstring>
#include <type_traits>
#include <vector>

namespace desert_sim {

/// An input stream for deserializing a message. Unlike roscpp's IStream, it does not allocate an array of
/// more elements than the remaining bytes can contain. Throws ros::serialization::StreamOverrunException.
class BoundedInputStream : public ros::serialization::Stream {
 public:
  static const ros::serialization::StreamType stream_type = ros::serialization::stream_types::Input;
  BoundedInputStream(std::uint8_t* data, std::uint32_t size) : Stream(data, size) {}

  template <class T>
  void next(T& value) {
    ros::serialization::deserialize(*this, value);
  }
  template <class T>
  void next(std::vector<T>& values) {
    std::uint32_t count = 0;
    next(count);
    values.clear();
    if constexpr (std::is_arithmetic_v<T>) {
      if (count > getLength() / sizeof(T)) ros::serialization::throwStreamOverrun();
      const std::uint32_t bytes = count * static_cast<std::uint32_t>(sizeof(T));
      values.resize(count);
      if (bytes > 0) std::memcpy(values.data(), advance(bytes), bytes);
    } else {
      for (std::uint32_t n = 0; n < count; ++n) {
        values.emplace_back();
        next(values.back());
      }
    }
  }
};

}  // namespace desert_sim
