// Sorting by key and prefix sums: stable, the same on every backend with any number of threads.

#include "kernels/backend/radix_sort.hpp"

#include <algorithm>
#include <random>

#include "test/support/world.hpp"

namespace desert_sim {
namespace {

std::vector<std::uint64_t> random_words(int count, std::uint32_t keys) {
  std::mt19937 random(5);
  std::vector<std::uint64_t> words;
  for (int n = 0; n < count; ++n)
    words.push_back(static_cast<std::uint64_t>(random() % keys) << 32 | static_cast<std::uint32_t>(n));
  return words;
}

template <class E>
void expect_sorted(E& exec, int count, std::uint32_t keys) {
  SortWorkspace work(exec, count, 1);
  std::vector<std::uint64_t> words = random_words(count, keys);
  work.sort_keys.upload(words);
  sort_by_key(exec, work, count, bit_width_of(keys - 1));
  std::stable_sort(words.begin(), words.end(), [](auto a, auto b) { return a >> 32 < b >> 32; });
  EXPECT_TRUE(work.sort_keys.download() == words) << count << " of " << keys << " keys";
}

class OrderingOf : public test::OnBackend {};

TEST_P(OrderingOf, ItemsOfTheSameKeyKeepTheirOrder) {
  for (int count : {1, 2, 255, 5000, 70001})
    for (std::uint32_t keys : {1u, 2u, 255u, 256u, 257u, 70000u})
      with_backend(exec(), [&](auto& e) { expect_sorted(e, count, keys); });
}

TEST_P(OrderingOf, PrefixSumsLeaveOutTheirOwnValue) {
  for (int count : {1, 2, 777, 70001}) {
    SortWorkspace work(exec(), 1, count);
    std::vector<int> values, expected;
    int sum = 0;
    for (int n = 0; n < count; ++n) {
      values.push_back((n * 7 + 3) % 5);
      expected.push_back(sum);
      sum += values.back();
    }
    Buffer<int> from(exec(), values.size()), to(exec(), values.size());
    from.upload(values);
    with_backend(exec(), [&](auto& e) { prefix_sums(e, work, from.data(), to.data(), count); });
    EXPECT_TRUE(to.download() == expected) << count;
  }
}

TEST(SortWorkspace, DoesNotDependOnTheNumberOfThreads) {
  for (int threads : {2, 3, 7}) {
    CpuExec exec(threads);
    expect_sorted(exec, 50000, 999);
  }
}

TEST(SortWorkspace, BitsOfTheLargestKey) {
  EXPECT_EQ(bit_width_of(0), 1);
  EXPECT_EQ(bit_width_of(1), 1);
  EXPECT_EQ(bit_width_of(255), 8);
  EXPECT_EQ(bit_width_of(256), 9);
  EXPECT_EQ(bit_width_of(0xffffffffu), 32);
}

DESERT_ON_EACH_BACKEND(OrderingOf);

}  // namespace
}  // namespace desert_sim
