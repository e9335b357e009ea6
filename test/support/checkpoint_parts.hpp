#pragma once
/// Checkpoints taken apart, changed, and put together again with a checksum that is right.

#include <yaml-cpp/yaml.h>

#include <string>

#include "kernels/field/layers.hpp"
#include "kernels/plants/population.hpp"

namespace desert_sim::test {

struct CheckpointParts {
  std::string header;  ///< YAML
  std::string words;   ///< of the layers, then of the plants

  /// Throws std::runtime_error if the bytes are no checkpoint.
  explicit CheckpointParts(const std::string& bytes);
  std::string bytes() const;

  YAML::Node parsed_header() const { return YAML::Load(header); }
  void set_header(const YAML::Node& node);
  /// Sets one value of the header.
  template <class T>
  void set(const char* key, const T& value) {
    YAML::Node node = parsed_header();
    node[key] = value;
    set_header(node);
  }

  std::size_t word_count() const { return words.size() / sizeof(std::uint32_t); }
  std::uint32_t word(std::size_t n) const;
  void set_word(std::size_t n, std::uint32_t word);
  /// Where the word of a cell is, or of a plant; the header must be as it was saved.
  std::size_t place(Layer layer, std::size_t cell) const;
  std::size_t place(plants::Column column, std::size_t plant) const;
};

}  // namespace desert_sim::test
