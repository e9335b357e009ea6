#pragma once
/// Messages from the bytes of a fuzzer: deserialized from raw bytes, or filled field by field with values
/// that are plausible, extreme or wrong.

#include <fuzzer/FuzzedDataProvider.h>
#include <tf2/exceptions.h>

#include <boost/array.hpp>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "src/grid_map/message_bytes.hpp"
#include "test/fuzz/fuzz.hpp"

namespace desert_sim::fuzz {

/// A stream of roscpp's serialization that gives each field of a message a value of its kind.
class FilledStream {
 public:
  static const ros::serialization::StreamType stream_type = ros::serialization::stream_types::Input;
  /// `words`: what texts are most often. Keeps references to both.
  FilledStream(FuzzedDataProvider& data, const std::vector<std::string>& words)
      : data_(data), words_(words) {}

  template <class T>
  void next(T& value) {
    if constexpr (std::is_floating_point_v<T>)
      value = static_cast<T>(number());
    else if constexpr (std::is_integral_v<T>)
      value = integer<T>();
    else
      ros::serialization::deserialize(*this, value);
  }
  void next(std::string& text) {
    text = data_.ConsumeIntegralInRange(0, 15) == 0
               ? data_.ConsumeRandomLengthString(40)
               : words_[data_.ConsumeIntegralInRange<std::size_t>(0, words_.size() - 1)];
  }
  void next(ros::Time& time) {
    const bool latest = data_.ConsumeIntegralInRange(0, 3) != 0;
    time = latest ? ros::Time() : ros::Time(integer<std::uint32_t>(), integer<std::uint32_t>() % 1000000000u);
  }
  template <class T>
  void next(std::vector<T>& values) {
    const std::size_t count =
        data_.ConsumeIntegralInRange(0, 60) == 60 ? 600 : data_.ConsumeIntegralInRange<std::size_t>(0, 6);
    values.resize(count);
    for (T& value : values) next(value);
  }
  template <class T, std::size_t N>
  void next(boost::array<T, N>& values) {
    for (T& value : values) next(value);
  }

 private:
  double number() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double extremes[] = {
        0,        -0.0,     1,         -1,           0.001,
        1e-3 / 3, 360,      -360,      1e5,          1e6,
        1e7,      1e12,     1e38,      1e39,         1e300,
        -1e300,   infinity, -infinity, 5e-324,       1e-30,
        -1e-9,    512,      4096,      4294967296.0, std::numeric_limits<double>::quiet_NaN()};
    switch (data_.ConsumeIntegralInRange(0, 4)) {
      case 0:
        return data_.PickValueInArray(extremes);
      case 1:
        return data_.ConsumeFloatingPointInRange(0.0, 1.0);
      case 2:
        return data_.ConsumeFloatingPointInRange(-400.0, 400.0);
      default:
        return data_.ConsumeIntegralInRange(-20, 300) / 10.0;
    }
  }
  template <class T>
  T integer() {
    if (data_.ConsumeIntegralInRange(0, 3) == 0) return data_.ConsumeIntegral<T>();
    return static_cast<T>(data_.ConsumeIntegralInRange(0, 20));
  }

  FuzzedDataProvider& data_;
  const std::vector<std::string>& words_;
};

/// A message of type M. Throws StreamOverrunException for raw bytes that are too few.
///
/// Raw bytes are read by BoundedInputStream: that of roscpp allocates as many elements as a length says
/// before it looks how many bytes there are, which is not this project's to mend.
template <class M>
M next_message(FuzzedDataProvider& data, const std::vector<std::string>& words) {
  M message;
  if (data.ConsumeBool()) {
    FilledStream stream(data, words);
    stream.next(message);
    return message;
  }
  std::vector<std::uint8_t> bytes =
      data.ConsumeBytes<std::uint8_t>(data.ConsumeIntegralInRange<std::size_t>(0, 4096));
  bytes.reserve(1);  // a stream adds to the pointer to its bytes, which must not be null
  BoundedInputStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  stream.next(message);
  return message;
}

/// Calls `take` until the bytes are used up, at most so often: each call takes messages from them. What it
/// refuses, and raw bytes that are too few, are no failure.
template <class Take>
void take_messages(FuzzedDataProvider& data, int most, const Take& take) {
  for (int n = 0; n < most && data.remaining_bytes() > 0; ++n) {
    try {
      accept_or_refuse(take);
    } catch (const ros::serialization::StreamOverrunException&) {
    }
  }
}

/// Hands each transform of a tf2_msgs/TFMessage over, as a listener does; what tf2 refuses is no failure.
template <class Message, class Add>
void hear_transforms(const Message& message, const Add& add) {
  for (const auto& transform : message.transforms) {
    try {
      add(transform);
    } catch (const tf2::TransformException&) {
    }
  }
}

}  // namespace desert_sim::fuzz
