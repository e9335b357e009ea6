// for_each_line_in_turn() on a CPU beside a plain loop, for lines shorter than its reach and longer than
// those that are left to one thread. (On a GPU: the tests of parity.)

#include <gtest/gtest.h>

#include <vector>

#include "kernels/backend/for_each_cpu.hpp"

namespace desert_sim {
namespace {

using Number = std::uint32_t;

/// Two numbers a place, which depend on all places within reach in the line before.
struct Mixing {
  static constexpr int words = 2, reach = 2;
  using Word = Number;
  using Loaded = Number;
  bool ring;
  int length;
  Number* results;

  bool around() const { return ring; }
  Number beyond(int word, Number nearest) const { return word == 0 ? 0 : nearest; }
  Number before_first(int word, int place) const { return static_cast<Number>(place * 7 + word + 1); }
  Number load(int line, int place) const { return static_cast<Number>(line * 1000003 + place * 31); }
  template <class Before, class After>
  Number pass(Number loaded, const Before& before, const After& after) const {
    Number sum = loaded;
    for (int k = -reach; k <= reach; ++k) sum = sum * 3 + before(0, k) + 5 * before(1, -k);
    after(0) = sum;
    after(1) = sum >> 7;
    return sum ^ before(1);
  }
  void store(int line, int place, Number result) const { results[line * length + place] = result; }
};

/// The second number depends on the first ones of the same line.
struct Completing : Mixing {
  static constexpr bool completes = true;
  template <class Here>
  void complete(const Here& here) const {
    here(1) = 3 * here(0, -1) + 5 * here(0, 0) + 7 * here(0, 1);
  }
};

/// Where the ends of a line are laws of their own: those, and what a line does as a whole.
struct MixingEnds : Mixing {
  Number load(int line, int place) const { return Mixing::load(line, place) + 7; }
};
struct MixingWithEnds : Mixing {
  Number load(int line, int place) const {
    return place == 0 || place == length - 1 ? MixingEnds{*this}.load(line, place)
                                             : Mixing::load(line, place);
  }
};

template <class Law>
std::vector<Number> expected(const Law& law, int first, int end) {
  std::vector<Number> all(static_cast<std::size_t>(end * law.length));
  std::vector<Number> before[2], after[2];
  for (int w = 0; w < 2; ++w)
    for (int n = 0; n < law.length; ++n) before[w].push_back(law.before_first(w, n));
  for (int line = first; line < end; ++line) {
    for (int w = 0; w < 2; ++w) after[w].assign(static_cast<std::size_t>(law.length), 0);
    for (int n = 0; n < law.length; ++n) {
      const auto at = [&](int word, int place) -> Number {
        const int l = law.length;
        if (law.ring) return before[word][static_cast<std::size_t>(((place % l) + l) % l)];
        if (place < 0) return law.beyond(word, before[word].front());
        if (place >= l) return law.beyond(word, before[word].back());
        return before[word][static_cast<std::size_t>(place)];
      };
      Number sum = law.load(line, n);
      for (int k = -2; k <= 2; ++k) sum = sum * 3 + at(0, n + k) + 5 * at(1, n - k);
      after[0][static_cast<std::size_t>(n)] = sum;
      after[1][static_cast<std::size_t>(n)] = sum >> 7;
      if (line >= 0) all[static_cast<std::size_t>(line * law.length + n)] = sum ^ at(1, n);
    }
    if constexpr (CompletesLines<Law>::value)
      for (int n = 0; n < law.length; ++n) {
        const auto at = [&](int place) -> Number {
          const int within = law.ring ? (place + law.length) % law.length : place;
          const auto end = static_cast<int>(after[0].size());
          if (within < 0 || within >= end) return law.beyond(0, 0);
          return after[0][static_cast<std::size_t>(within)];
        };
        after[1][static_cast<std::size_t>(n)] = 3 * at(n - 1) + 5 * at(n) + 7 * at(n + 1);
      }
    for (int w = 0; w < 2; ++w) before[w] = after[w];
  }
  return all;
}

TEST(LineSweep, PassesLinesOfAnyLengthOnAnyNumberOfThreads) {
  for (const int length : {1, 2, 3, 40, min_parallel_line, min_parallel_line + 5})
    for (const bool ring : {true, false})
      for (const int threads : {1, 3}) {
        SCOPED_TRACE(testing::Message()
                     << length << " places, " << (ring ? "a ring" : "open") << ", " << threads);
        constexpr int end = 9;
        std::vector<Number> results(static_cast<std::size_t>(end * length)), plain;
        std::vector<Number> memory(words_for_lines(Mixing::words, Mixing::reach, length));
        const Mixing law{ring, length, results.data()};
        CpuExec exec(threads);
        for_each_line_in_turn(exec, 0, end, length, memory.data(), law);
        EXPECT_EQ(results, expected(law, 0, end));
        for_each_line_in_turn(exec, 0, end, length, memory.data(),
                              LineWithEnds(law, MixingEnds{law}, length));
        EXPECT_EQ(results, expected(MixingWithEnds{law}, 0, end)) << "with ends";
        const Completing completing{law};
        for_each_line_in_turn(exec, 0, end, length, memory.data(), completing);
        EXPECT_EQ(results, expected(completing, 0, end)) << "completed";
      }
}

}  // namespace
}  // namespace desert_sim
