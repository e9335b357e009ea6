#include <omp.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "kernels/backend/radix_sort.hpp"

namespace desert_sim {

namespace {

constexpr int digit_bits = 8, digits = 1 << digit_bits;
/// Fewer items than this are left to one thread, because waking others costs more than it saves.
constexpr int min_parallel_items = 1 << 14;

int thread_count_for(const CpuExec& exec, int count) {
  return count < min_parallel_items ? 1 : exec.threads();
}
int part_begin(int count, int n, int parts) {
  return static_cast<int>(static_cast<long long>(count) * n / parts);
}

/// One pass of a radix sort. Each part of the items counts its digits and then scatters its items: behind all
/// items of lower digits, and behind those of the same digit in earlier parts.
void sort_by_digit(const std::uint64_t* from, std::uint64_t* to, int count, int shift, int parts) {
  std::vector<std::array<int, digits>> places(static_cast<std::size_t>(parts));
  const auto digit = [shift](std::uint64_t word) {
    return static_cast<std::size_t>((word >> shift) % digits);
  };
#pragma omp parallel for schedule(static) num_threads(parts) if (parts > 1)
  for (int p = 0; p < parts; ++p) {
    auto& counted = places[static_cast<std::size_t>(p)];
    counted.fill(0);
    for (int n = part_begin(count, p, parts); n < part_begin(count, p + 1, parts); ++n)
      ++counted[digit(from[n])];
  }
  int first = 0;
  for (std::size_t d = 0; d < digits; ++d)
    for (auto& counted : places) first += std::exchange(counted[d], first);
#pragma omp parallel for schedule(static) num_threads(parts) if (parts > 1)
  for (int p = 0; p < parts; ++p) {
    auto& place = places[static_cast<std::size_t>(p)];
    for (int n = part_begin(count, p, parts); n < part_begin(count, p + 1, parts); ++n)
      to[place[digit(from[n])]++] = from[n];
  }
}

}  // namespace

SortWorkspace::SortWorkspace(Exec& exec, int items, int values)
    : sort_keys(exec, static_cast<std::size_t>(items)),
      sort_keys_buffer(exec, static_cast<std::size_t>(items)),
      // More than CUB needs; on the GPU sort_by_key() and prefix_sums() check this.
      temporary(exec, (std::size_t{1} << 16) + 2 * static_cast<std::size_t>(items) +
                          static_cast<std::size_t>(values) / 8) {}

void sort_by_key(CpuExec& exec, SortWorkspace& work, int count, int bits) {
  const int parts = thread_count_for(exec, count);
  for (int shift = 32; shift < 32 + bits; shift += digit_bits) {
    sort_by_digit(work.sort_keys.data(), work.sort_keys_buffer.data(), count, shift, parts);
    work.sort_keys.swap(work.sort_keys_buffer);
  }
}

void prefix_sums(CpuExec& exec, SortWorkspace&, const int* values, int* sums, int count) {
  const int parts = thread_count_for(exec, count);
  std::vector<int> before(static_cast<std::size_t>(parts) + 1, 0);
#pragma omp parallel for schedule(static) num_threads(parts) if (parts > 1)
  for (int p = 0; p < parts; ++p) {
    int sum = 0;
    for (int n = part_begin(count, p, parts); n < part_begin(count, p + 1, parts); ++n) sum += values[n];
    before[static_cast<std::size_t>(p) + 1] = sum;
  }
  for (std::size_t p = 1; p < before.size(); ++p) before[p] += before[p - 1];
#pragma omp parallel for schedule(static) num_threads(parts) if (parts > 1)
  for (int p = 0; p < parts; ++p) {
    int sum = before[static_cast<std::size_t>(p)];
    for (int n = part_begin(count, p, parts); n < part_begin(count, p + 1, parts); ++n) {
      sums[n] = sum;
      sum += values[n];
    }
  }
}

}  // namespace desert_sim
