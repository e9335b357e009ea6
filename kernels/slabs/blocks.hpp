#pragma once
/// A division of a lattice into blocks of four colours, so that those of one colour can be worked on at once:
/// two of them lie at least `least_side` cells apart. It lies elsewhere in each step.

#include <algorithm>
#include <cmath>

#include "kernels/field/dice.hpp"
#include "kernels/field/math.hpp"
#include "kernels/field/quanta.hpp"

namespace desert_sim::slabs {

constexpr int least_side = 8;

/// The blocks of an axis. Two colours alternate; a periodic axis has an even number of blocks, or one.
struct BlockAxis {
  int cells;
  bool periodic;
  int parts;  ///< of about equal size, from 8 to 16 cells; an axis of fewer than 16 cells has one

  BlockAxis() = default;
  DESERT_HD BlockAxis(int n, bool is_periodic)
      : cells(n), periodic(is_periodic), parts(n < 2 * least_side ? 1 : n / (2 * least_side) * 2) {}

  /// On an open axis the parts are shifted, too: what they leave at its beginning is one more block.
  DESERT_HD int blocks() const { return parts == 1 || periodic ? parts : parts + 1; }
  DESERT_HD int of_colour(int colour) const { return (blocks() + 1 - colour) / 2; }
  DESERT_HD int most_of_a_colour() const { return of_colour(0); }
  /// Of a random word.
  DESERT_HD int shift(std::uint32_t word) const {
    if (parts == 1) return 0;
    return static_cast<int>(multiply_high(word, static_cast<std::uint32_t>(periodic ? cells : least_side)));
  }
  DESERT_HD int part_begin(int part) const {
    return static_cast<int>(static_cast<long long>(part) * cells / parts);
  }
  DESERT_HD int most_cells() const { return (cells + parts - 1) / parts; }
  struct Interval {
    int begin, size;  ///< the begin may lie beyond the end of a periodic axis, by less than a round
  };
  DESERT_HD Interval interval(int block, int shifted) const {
    if (parts == 1 || periodic) {
      const int begin = part_begin(block);
      return {begin + shifted, part_begin(block + 1) - begin};
    }
    const int begin = block == 0 ? 0 : part_begin(block - 1) + shifted;
    const int end = block == parts ? cells : part_begin(block) + shifted;
    return {begin, end - begin};
  }
};

/// A block: `lines` × `places` cells from (line, place) on.
struct Block {
  int line, place, lines, places;

  DESERT_HD int cells() const { return lines * places; }
  /// The row of the nth cell, without a division: n / places = n · row_factor() / 2¹⁶ for so few cells.
  DESERT_HD int row_factor() const { return 65536 / places + 1; }
  DESERT_HD int row(int n, int factor) const { return (n * factor) >> 16; }
  /// How far a cell lies outside, along either axis.
  DESERT_HD int beyond(int l, int p) const {
    const int before_lines = line - l, after_lines = l - (line + lines - 1);
    const int before_places = place - p, after_places = p - (place + places - 1);
    const int along = before_lines > after_lines ? before_lines : after_lines;
    const int across = before_places > after_places ? before_places : after_places;
    const int most = along > across ? along : across;
    return most > 0 ? most : 0;
  }
};

/// All blocks. A turn is that of one colour.
struct Blocks {
  BlockAxis along, across;
  Die die;  ///< of the division: two words for its shift, one for the order of colours

  static constexpr int colours = 4;
  DESERT_HD int most_of_a_colour() const { return along.most_of_a_colour() * across.most_of_a_colour(); }
  /// Of a block.
  DESERT_HD int most_cells() const { return along.most_cells() * across.most_cells(); }
  /// The nth block of the turn's colour; of no cells if there are fewer.
  DESERT_HD Block block(int turn, int n) const {
    const int colour = (turn ^ static_cast<int>(die.word(2) >> 30)) & 3;
    const int per_row = across.most_of_a_colour(), row = n / per_row, column = n - row * per_row;
    if (row >= along.of_colour(colour >> 1) || column >= across.of_colour(colour & 1)) return {0, 0, 0, 0};
    const BlockAxis::Interval lines = along.interval(2 * row + (colour >> 1), along.shift(die.word(0))),
                              places = across.interval(2 * column + (colour & 1), across.shift(die.word(1)));
    return {lines.begin, places.begin, lines.size, places.size};
  }
};

/// Polls of a block of so many cells, of which each is polled `per_cell` times [2⁻²⁰], are hardly ever more:
/// by a permutation of the next power of two, or at random (mean and six standard deviations).
inline int most_polls(int cells, std::uint32_t per_cell) {
  double numbers = 1;
  while (numbers < cells) numbers *= 2;
  const double share = static_cast<double>(per_cell) / 1048576.0, mean = share * cells;
  return static_cast<int>(std::max(share * numbers, mean + 6 * std::sqrt(mean))) + 4;
}

/// A permutation of 0 … 2^bits − 1 for each key: steps that each can be undone.
DESERT_HD int permuted(int n, int bits, std::uint32_t key) {
  const std::uint32_t mask = (1u << bits) - 1u;
  const int half = (bits + 1) / 2;
  std::uint32_t k = static_cast<std::uint32_t>(n);
  for (int round = 0; round < 3; ++round) {
    key = scrambled(key + 0x9e3779b9u);
    k = (k * (2u * key + 1u) + (key >> 16)) & mask;
    k ^= k >> half;
  }
  return static_cast<int>(k);
}

}  // namespace desert_sim::slabs
