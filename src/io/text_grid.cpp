#include "src/io/text_grid.hpp"

#include <cpl_conv.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <memory>
#include <vector>

#include "src/core/quoted.hpp"
#include "src/io/raster_geometry.hpp"

namespace desert_sim {

namespace {

/// The words of a file between blanks, one after the other.
class Words {
 public:
  explicit Words(VSILFILE* file) : file_(file), bytes_(1 << 20) {}

  /// False at the end. Of a longer word the first hundred characters.
  bool next(std::string& word) {
    constexpr std::size_t longest = 100;
    word.clear();
    for (int c = character(); c >= 0; c = character()) {
      if (!std::isspace(c)) {
        if (word.empty()) line_ = lines_;
        if (word.size() < longest) word += static_cast<char>(c);
      } else if (!word.empty()) {
        lines_ += c == '\n';
        return true;
      } else {
        lines_ += c == '\n';
      }
    }
    return !word.empty();
  }
  /// Of the last word, from 1.
  std::uint64_t line() const { return line_; }

 private:
  int character() {
    if (at_ == end_) {
      end_ = VSIFReadL(bytes_.data(), 1, bytes_.size(), file_);
      at_ = 0;
      if (end_ == 0) return -1;
    }
    return static_cast<unsigned char>(bytes_[at_++]);
  }

  VSILFILE* const file_;
  std::vector<char> bytes_;
  std::size_t at_ = 0, end_ = 0;
  std::uint64_t lines_ = 1, line_ = 1;
};

/// As GDAL reads them: with a decimal point or comma, nan, inf, or what C of Windows writes for these
/// (1.#QNAN).
bool is_number(std::string word) {
  if (word.find(".#") != std::string::npos) return true;
  std::replace(word.begin(), word.end(), ',', '.');
  char* end = nullptr;
  CPLStrtod(word.c_str(), &end);  // in every locale
  return end == word.c_str() + word.size();
}

bool is_whole(const std::string& word) {
  const std::size_t first = word[0] == '-' || word[0] == '+' ? 1 : 0;
  return word.find_first_not_of("0123456789", first) == std::string::npos;
}

bool is_key(const std::string& word) {
  return std::isalpha(static_cast<unsigned char>(word[0])) && !is_number(word);
}

}  // namespace

void check_text_grid(const std::string& path, const std::string& name, int columns, int rows, bool whole) {
  const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file(VSIFOpenL(name.c_str(), "rb"), VSIFCloseL);
  if (!file) throw_raster_error(path, "cannot be read once more");
  Words words(file.get());
  std::string word;
  bool more = words.next(word);
  while (more && is_key(word)) more = words.next(word) && words.next(word);
  const std::uint64_t expected = static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows);
  std::uint64_t numbers = 0;
  for (; more; more = words.next(word), ++numbers) {
    if (!is_number(word))
      throw_raster_error(path, concatenate("line ", words.line(), ": ", in_quotes(word), " is not a number"));
    if (whole && !is_whole(word))
      throw_raster_error(path,
                         concatenate("line ", words.line(), ": ", in_quotes(word),
                                     " is no whole number, as those at the beginning are, so that GDAL takes "
                                     "all for whole ones; write one of the first with a decimal point"));
  }
  if (numbers != expected)
    throw_raster_error(path, concatenate("has ", numbers, " numbers after its header, which says ", columns,
                                         " columns and ", rows, " rows: ", expected));
}

}  // namespace desert_sim
