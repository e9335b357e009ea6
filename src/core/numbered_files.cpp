#include "src/core/numbered_files.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "src/core/error.hpp"
#include "src/core/files.hpp"

namespace desert_sim {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t min_digits = 10;

bool has_ends(const std::string& name, const std::string& begin, const std::string& end) {
  return name.size() >= begin.size() + end.size() && name.compare(0, begin.size(), begin) == 0 &&
         name.compare(name.size() - end.size(), end.size(), end) == 0;
}

bool is_number(const std::string& digits) {
  if (digits.find_first_not_of("0123456789") != std::string::npos) return false;
  return digits.size() == min_digits || (digits.size() > min_digits && digits[0] != '0');
}

std::string successor(std::string number) {
  for (auto digit = number.rbegin(); digit != number.rend(); ++digit) {
    if (*digit != '9') {
      ++*digit;
      return number;
    }
    *digit = '0';
  }
  return "1" + number;
}

}  // namespace

NumberedFiles::NumberedFiles(std::string folder, std::string prefix, std::string suffix)
    : folder_(std::move(folder)), prefix_(std::move(prefix)), suffix_(std::move(suffix)) {}

/// The names of all regular files in the folder.
std::vector<std::string> NumberedFiles::names() const {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error))
    if (entry->symlink_status().type() == fs::file_type::regular)
      names.push_back(entry->path().filename().string());
  if (error && error != std::errc::no_such_file_or_directory && error != std::errc::not_a_directory)
    throw ConfigError(folder_ + ": cannot be read: " + error.message());
  return names;
}

/// The numbers of the files, highest first.
std::vector<std::string> NumberedFiles::numbers() const {
  std::vector<std::string> numbers;
  for (const std::string& name : names()) {
    if (!has_ends(name, prefix_, suffix_)) continue;
    const std::string digits = name.substr(prefix_.size(), name.size() - prefix_.size() - suffix_.size());
    if (is_number(digits)) numbers.push_back(digits);
  }
  std::sort(numbers.begin(), numbers.end(), [](const std::string& a, const std::string& b) {
    return std::make_pair(a.size(), a) > std::make_pair(b.size(), b);
  });
  return numbers;
}

std::vector<std::string> NumberedFiles::paths() const {
  std::vector<std::string> paths;
  for (const std::string& number : numbers()) paths.push_back(folder_ + "/" + prefix_ + number + suffix_);
  return paths;
}

std::string NumberedFiles::next_name() const {
  const std::vector<std::string> all = numbers();
  return prefix_ + successor(all.empty() ? std::string(min_digits, '0') : all.front()) + suffix_;
}

void NumberedFiles::keep_newest(std::size_t count, const std::vector<std::string>& needed) const {
  std::vector<std::string> old = paths();
  old.erase(old.begin(), old.begin() + static_cast<std::ptrdiff_t>(std::min(count, old.size())));
  for (const std::string& name : names())
    if (has_ends(name, "." + prefix_, ".part")) old.push_back(folder_ + "/" + name);
  for (const std::string& path : old) {
    const auto is_path = [&path](const std::string& other) { return same_file(path, other); };
    if (std::any_of(needed.begin(), needed.end(), is_path)) continue;
    std::error_code error;
    fs::remove(path, error);
    if (error) throw ConfigError(path + ": cannot be removed: " + error.message());
  }
}

}  // namespace desert_sim
