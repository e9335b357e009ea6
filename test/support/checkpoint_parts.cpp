#include "test/support/checkpoint_parts.hpp"

#include <xxhash.h>

#include <cstring>
#include <stdexcept>

namespace desert_sim::test {

namespace {

const std::string beginning = std::string("desert_sim checkpoint\n") + std::string("\3\0\0\0", 4);

template <class T>
std::string bytes_of(T value) {
  return std::string(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

CheckpointParts::CheckpointParts(const std::string& bytes) {
  std::uint64_t length = 0;
  const std::size_t start = beginning.size() + sizeof length;
  if (bytes.compare(0, beginning.size(), beginning) != 0 || bytes.size() < start + sizeof length)
    throw std::runtime_error("not a checkpoint");
  std::memcpy(&length, bytes.data() + beginning.size(), sizeof length);
  header = bytes.substr(start, length);
  words = bytes.substr(start + length, bytes.size() - start - length - sizeof(std::uint64_t));
}

std::string CheckpointParts::bytes() const {
  const std::string all = beginning + bytes_of(static_cast<std::uint64_t>(header.size())) + header + words;
  return all + bytes_of(static_cast<std::uint64_t>(XXH3_64bits(all.data(), all.size())));
}

void CheckpointParts::set_header(const YAML::Node& node) {
  YAML::Emitter out;
  out << node;
  header = out.c_str();
}

std::uint32_t CheckpointParts::word(std::size_t n) const {
  std::uint32_t word = 0;
  std::memcpy(&word, words.data() + n * sizeof word, sizeof word);
  return word;
}

void CheckpointParts::set_word(std::size_t n, std::uint32_t word) {
  std::memcpy(&words[n * sizeof word], &word, sizeof word);
}

std::size_t CheckpointParts::place(Layer layer, std::size_t cell) const {
  const YAML::Node node = parsed_header(), layers = node["layers"];
  const std::size_t plants = node["plants"].as<std::size_t>() * plants::column_count,
                    cells = (word_count() - plants) / layers.size();
  for (std::size_t n = 0; n < layers.size(); ++n)
    if (layers[n].Scalar() == info(layer).name) return n * cells + cell;
  throw std::runtime_error(std::string("no layer ") + info(layer).name);
}

std::size_t CheckpointParts::place(plants::Column column, std::size_t plant) const {
  const auto plants = parsed_header()["plants"].as<std::size_t>();
  return word_count() - plants * plants::column_count + static_cast<std::size_t>(column) * plants + plant;
}

}  // namespace desert_sim::test
