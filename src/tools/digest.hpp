#pragma once
/// XXH3-64 of numbers.

#include <xxhash.h>

#include <cstdint>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>

namespace desert_sim {

class Digest {
 public:
  Digest() : sum_(XXH3_createState(), XXH3_freeState) {
    if (!sum_) throw std::bad_alloc();
    XXH3_64bits_reset(sum_.get());
  }
  template <class Number>
  void add(const Number& number) {
    static_assert(std::is_arithmetic_v<Number>, "bytes between the members of a structure have no value");
    XXH3_64bits_update(sum_.get(), &number, sizeof number);
  }
  template <class Number>
  void add(const std::vector<Number>& numbers) {
    static_assert(std::is_arithmetic_v<Number>);
    XXH3_64bits_update(sum_.get(), numbers.data(), numbers.size() * sizeof(Number));
  }
  std::uint64_t value() const { return XXH3_64bits_digest(sum_.get()); }

 private:
  std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> sum_;
};

}  // namespace desert_sim
