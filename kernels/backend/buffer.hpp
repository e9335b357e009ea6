#pragma once
/// Owned device memory: move-only, and uninitialised when it is created.

#include <cstddef>
#include <utility>
#include <vector>

#include "kernels/backend/exec.hpp"

namespace desert_sim {

template <class T>
class Buffer {
 public:
  Buffer() = default;
  Buffer(Exec& exec, std::size_t size)
      : exec_(&exec), size_(size), data_(static_cast<T*>(exec.allocate(size * sizeof(T)))) {}
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Buffer() {
    if (data_) exec_->release(data_, bytes());
  }

  T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }
  explicit operator bool() const { return data_ != nullptr; }

  void set_zero() { exec_->set_zero(data_, size_ * sizeof(T)); }
  void upload(const std::vector<T>& from) { exec_->upload(data_, from.data(), from.size() * sizeof(T)); }
  std::vector<T> download() const {
    std::vector<T> to(size_);
    if (size_) download(0, size_, to.data());
    return to;
  }
  /// Copies elements first … first + count − 1 to the host.
  void download(std::size_t first, std::size_t count, T* to) const {
    exec_->download(to, data_ + first, count * sizeof(T));
  }
  void swap(Buffer& other) noexcept {
    std::swap(exec_, other.exec_);
    std::swap(size_, other.size_);
    std::swap(data_, other.data_);
  }

 private:
  Exec* exec_ = nullptr;
  std::size_t size_ = 0;
  T* data_ = nullptr;
};

}  // namespace desert_sim
