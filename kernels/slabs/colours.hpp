#pragma once
/// A division of the lattice into colours, so that all cells of one colour can be worked on at once: no cell
/// is a neighbour of two of them. There are eight on lines and places that are multiples of four,
///
///   colour = 4 (line mod 2) + (place + 2 ⌊line/2⌋) mod 4
///
/// and the up to three lines and places that are left over on a ring have further colours of their own.

#include "kernels/base/math.hpp"

namespace desert_sim::slabs {

/// Cells of an axis: the regular ones, and those left over.
struct ColourAxis {
  int cells;
  bool periodic;

  DESERT_HD int regular() const { return periodic ? cells & ~3 : cells; }
  DESERT_HD int left_over() const { return cells - regular(); }
  /// Regular cells n with n mod 4 = r.
  DESERT_HD int of_residue(int r) const { return (regular() - r + 3) >> 2; }
};

/// Cells (line, place + 4 n) for n = 0 … count − 1. They lie beside each other in memory; see Lattice.
struct Run {
  int line, place, count;
};

struct Colours {
  ColourAxis along, across;

  static constexpr int regular = 8, longest_run = 16;

  DESERT_HD int count() const {
    return regular + 4 * (across.left_over() + along.left_over()) + along.left_over() * across.left_over();
  }
  /// Runs of a colour: columns × rows. All runs of a row lie in one line.
  DESERT_HD int columns(int colour) const {
    if (colour < regular) return (across.of_residue(0) + longest_run - 1) / longest_run;
    const int n = colour - regular - 4 * across.left_over();
    return n >= 0 && n < 4 * along.left_over() ? across.of_residue(n & 3) : 1;
  }
  DESERT_HD int rows(int colour) const {
    if (colour < regular) return (along.regular() - (colour >> 2) + 1) / 2;
    const int n = colour - regular;
    return n < 4 * across.left_over() ? along.of_residue(n & 3) : 1;
  }
  DESERT_HD Run run(int colour, int column, int row) const {
    if (colour < regular) {
      const int line = 2 * row + (colour >> 2), residue = (colour + 2 * (line >> 1)) & 3;
      const int first = column * longest_run, left = across.of_residue(residue) - first;
      return {line, 4 * first + residue, left < longest_run ? left : longest_run};
    }
    int n = colour - regular;
    if (n < 4 * across.left_over()) return {4 * row + (n & 3), across.regular() + (n >> 2), 1};
    n -= 4 * across.left_over();
    if (n < 4 * along.left_over()) return {along.regular() + (n >> 2), 4 * column + (n & 3), 1};
    n -= 4 * along.left_over();
    return {along.regular() + n / across.left_over(), across.regular() + n % across.left_over(), 1};
  }
};

}  // namespace desert_sim::slabs
