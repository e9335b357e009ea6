#pragma once
/// File descriptors.

namespace desert_sim {

/// Owns a file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor();
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }  ///< negative: none
  /// Closes what it has owned, and owns `number` from now on.
  void reset(int number);
  /// False, with errno, if what was written could not be kept.
  bool close();

 private:
  int number_;
};

}  // namespace desert_sim
