#pragma once
/// The errors of an input, together.

#include <string>
#include <utility>

#include "src/core/error.hpp"
#include "src/core/quoted.hpp"

namespace desert_sim {

/// Collects the errors of an input, so that one exception reports them together: those that fit into a
/// message, and the number of the others.
class ValidationErrors {
 public:
  explicit ValidationErrors(std::string source) : source_(std::move(source)) {}
  void add(const std::string& key, const std::string& what) {
    constexpr std::size_t longest = 1000, all = max_message_size - 100;
    const std::string line = shortened(source_ + ": " + shortened(key) + ": " + what, longest);
    if (left_out_ == 0 && text_.size() + line.size() <= all)
      text_ += (text_.empty() ? "" : "\n") + line;
    else
      ++left_out_;
  }
  /// Further errors are only counted.
  bool is_full() const { return left_out_ > 0; }
  void throw_if_any() const {
    if (text_.empty()) return;
    throw ConfigError(left_out_ == 0 ? text_ : text_ + "\nand " + std::to_string(left_out_) + " more errors");
  }

 private:
  std::string source_, text_;
  std::size_t left_out_ = 0;
};

}  // namespace desert_sim
