#pragma once
/// A file that is written in many small pieces, and appears under its name when it is complete.

#include <cstring>
#include <functional>
#include <string>
#include <utility>

#include "src/core/temporary_file.hpp"

namespace desert_sim {

/// Throws what TemporaryFile and `after_piece` throw.
class BufferedFile {
 public:
  /// `after_piece`: called after each MiB, unless it is empty.
  BufferedFile(const std::string& path, std::function<void()> after_piece)
      : file_(path), after_piece_(std::move(after_piece)) {}

  void text(const std::string& text) { bytes(text.data(), text.size()); }
  /// The bytes of a number, the lowest one first.
  template <class Number>
  void number(Number number) {
    static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the formats have the lowest byte first");
    bytes(&number, sizeof number);
  }
  void publish() {
    flush();
    file_.publish();
  }

 private:
  void bytes(const void* data, std::size_t size) {
    constexpr std::size_t piece = 1 << 20;
    buffer_.append(static_cast<const char*>(data), size);
    if (buffer_.size() >= piece) flush();
  }
  void flush() {
    file_.write(buffer_);
    buffer_.clear();
    if (after_piece_) after_piece_();
  }

  TemporaryFile file_;
  const std::function<void()> after_piece_;
  std::string buffer_;
};

}  // namespace desert_sim
