#pragma once
/// The words of a checkpoint: its layers, and the columns of its plants, as they lie in the file.

#include <cstring>
#include <string>
#include <vector>

#include "kernels/plants/population.hpp"
#include "src/simulation/checkpoint_header.hpp"

namespace desert_sim {

/// `count` words of four bytes at any address.
class WordsInFile {
 public:
  WordsInFile(const char* bytes, std::size_t count) : bytes_(bytes), count_(count) {}
  std::size_t size() const { return count_; }
  std::uint32_t operator[](std::size_t n) const {
    std::uint32_t word;
    std::memcpy(&word, bytes_ + n * sizeof word, sizeof word);
    return word;
  }
  std::vector<std::uint32_t> copy() const {
    std::vector<std::uint32_t> words(count_);
    if (count_ > 0) std::memcpy(words.data(), bytes_, count_ * sizeof(std::uint32_t));
    return words;
  }

 private:
  const char* bytes_;
  std::size_t count_;
};

struct CheckpointWords {
  std::vector<WordsInFile> layers;  ///< in the order of the header's; one word a cell
  WordsInFile plants{nullptr, 0};   ///< as plants::words() gives them
};

/// Divides `length` bytes behind a header into what it lists. Throws ConfigError if there are too few or too
/// many.
CheckpointWords divide_words(const CheckpointHeader& header, const char* bytes, std::size_t length,
                             const std::string& path);

/// Throws ConfigError, which names layer or column, cell or plant, value and range, if a value is one that no
/// simulation of the scenario can hold.
void check_words(const CheckpointHeader& header, const CheckpointWords& words, const std::string& path);

}  // namespace desert_sim
