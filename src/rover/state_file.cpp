#include "src/rover/state_file.hpp"

#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "src/core/constants.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/input_file.hpp"
#include "src/core/quoted.hpp"

namespace desert_sim {

namespace {

const std::string magic = "desert_sim rover\n";
constexpr std::uint32_t version = 1;
constexpr std::size_t most_bytes = 1 << 16;

template <class T>
void append(std::string& to, const T& value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append_text(std::string& to, const std::string& text) {
  append(to, static_cast<std::uint64_t>(text.size()));
  to += text;
}

class Reader {
 public:
  Reader(const std::string& bytes, std::size_t end, const std::string& path)
      : bytes_(bytes), end_(end), path_(path) {}
  template <class T>
  T value() {
    T value;
    require(sizeof value);
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  std::string text(std::size_t size) {
    require(size);
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }
  std::string text() { return text(value<std::uint64_t>()); }
  std::size_t rest() const { return end_ - at_; }

 private:
  void require(std::size_t size) const {
    if (size > rest()) throw ConfigError(path_ + ": is truncated");
  }
  const std::string& bytes_;
  std::size_t at_ = 0;
  const std::size_t end_;
  const std::string& path_;
};

/// The first line in which the texts of two rovers differ, for a refusal.
std::string difference(const std::string& saved, const std::string& here) {
  std::istringstream a(saved), b(here);
  std::string x, y;
  while (true) {
    const bool in_saved = static_cast<bool>(std::getline(a, x)),
               in_here = static_cast<bool>(std::getline(b, y));
    if (!in_saved || !in_here)
      return in_quotes(in_saved ? x : y) + ", which " + (in_saved ? "this rover" : "it") + " has not";
    if (x != y) return in_quotes(x) + ", while this rover has " + in_quotes(y);
  }
}

void check_numbers(const RoverState& state, const std::string& path) {
  constexpr double farthest = 1e12;  // [m, s, m/s, …]
  for_each_number(state, [&](const char* name, const auto& value) {
    const auto number = static_cast<double>(value);
    if (!(std::abs(number) <= farthest || std::is_integral_v<std::decay_t<decltype(value)>>)) {
      std::ostringstream text;
      text << path << ": " << name << ": " << number << " (allowed: up to " << farthest << ")";
      throw ConfigError(text.str());
    }
  });
  const auto require = [&](bool right, const char* what) {
    if (!right) throw ConfigError(path + ": " + what);
  };
  const double steepest = pi / 2;
  require(std::abs(state.pose.roll) <= steepest && std::abs(state.pose.pitch) <= steepest,
          "roll or pitch is beyond 90 deg");
  require(std::abs(state.rocker) <= steepest && std::abs(state.bogie[0]) <= steepest &&
              std::abs(state.bogie[1]) <= steepest,
          "a joint is beyond 90 deg");
  require(state.rest >= 0 && state.rest < 2 * Rover::internal_step,
          "the rest of time is no part of an internal step");
  require(std::all_of(state.wheels.begin(), state.wheels.end(),
                      [](const WheelState& w) {
                        return w.sunk >= 0 && std::abs(w.slip) <= 1 && std::abs(w.dug) <= 1;
                      }),
          "a wheel has a sinkage below 0 or a slip beyond 1");
}

}  // namespace

std::uint64_t hash_of(const RoverState& state) {
  std::string bytes;
  append(bytes, static_cast<std::uint32_t>(state.condition));
  for_each_number(state, [&](const char*, const auto& value) { append(bytes, value); });
  return XXH3_64bits(bytes.data(), bytes.size());
}

std::string rover_state_bytes(const Rover& rover) {
  const RoverState& state = rover.state();
  std::string bytes = magic;
  append(bytes, version);
  append_text(bytes, rover.text());
  append(bytes, static_cast<std::uint32_t>(state.condition));
  append(bytes, static_cast<std::uint32_t>(state.placed));
  append_text(bytes, state.reason);
  for_each_number(state, [&](const char*, const auto& value) { append(bytes, value); });
  append(bytes, static_cast<std::uint64_t>(XXH3_64bits(bytes.data(), bytes.size())));
  return bytes;
}

RoverState rover_state_of(const std::string& bytes, const Rover& rover, const std::string& path) {
  if (bytes.compare(0, magic.size(), magic) != 0) throw ConfigError(path + ": is not the state of a rover");
  if (bytes.size() < magic.size() + sizeof(std::uint32_t) + sizeof(std::uint64_t))
    throw ConfigError(path + ": is truncated");
  const std::size_t end = bytes.size() - sizeof(std::uint64_t);
  Reader reader(bytes, end, path);
  reader.text(magic.size());
  if (const auto found = reader.value<std::uint32_t>(); found != version)
    throw ConfigError(path + ": is a rover's state of version " + std::to_string(found) +
                      "; this program reads version " + std::to_string(version));
  std::uint64_t sum;
  std::memcpy(&sum, bytes.data() + end, sizeof sum);
  if (sum != XXH3_64bits(bytes.data(), end))
    throw ConfigError(path + ": is truncated or corrupt (its checksum does not match)");
  if (const std::string text = reader.text(); text != rover.text())
    throw ConfigError(path + ": is the state of another rover: " + difference(text, rover.text()));
  RoverState state;
  const auto condition = reader.value<std::uint32_t>(), placed = reader.value<std::uint32_t>();
  constexpr std::uint32_t conditions = sizeof rover_conditions / sizeof *rover_conditions;
  if (condition >= conditions || placed > 1)
    throw ConfigError(path + ": condition " + std::to_string(condition) + " (allowed: 0 to " +
                      std::to_string(conditions - 1) + "), placed " + std::to_string(placed) +
                      " (allowed: 0, 1)");
  state.condition = static_cast<RoverCondition>(condition);
  state.placed = placed == 1;
  state.reason = reader.text();
  for_each_number(state,
                  [&](const char*, auto& value) { value = reader.value<std::decay_t<decltype(value)>>(); });
  if (reader.rest() != 0)
    throw ConfigError(path + ": has " + std::to_string(reader.rest()) + " bytes too many");
  check_numbers(state, path);
  return state;
}

void save_rover(const std::string& path, const Rover& rover) { write_file(path, rover_state_bytes(rover)); }

void load_rover(const std::string& path, Rover& rover, const std::string& folder) {
  const InputFile file(path, folder);
  if (file.size() > most_bytes)
    throw ConfigError(path + ": has " + std::to_string(file.size()) +
                      " bytes; the state of a rover has at most " + std::to_string(most_bytes));
  rover.set_state(rover_state_of(file.read_all(), rover, path));
}

}  // namespace desert_sim
