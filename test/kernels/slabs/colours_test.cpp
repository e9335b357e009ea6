// Colours of slab models: each cell has one, and no cell is a neighbour of two of the same.

#include <gtest/gtest.h>

#include <vector>

#include "kernels/base/grid.hpp"
#include "kernels/slabs/rolling.hpp"

namespace desert_sim::slabs {
namespace {

/// The colour of each cell, line by line.
std::vector<int> colours_of(int lines, int length, bool periodic) {
  const Colours colours{{lines, periodic}, {length, periodic}};
  std::vector<int> found(static_cast<std::size_t>(lines * length), -1);
  for (int colour = 0; colour < colours.count(); ++colour)
    for (int row = 0; row < colours.rows(colour); ++row)
      for (int column = 0, line = -1; column < colours.columns(colour); ++column) {
        const Run run = colours.run(colour, column, row);
        EXPECT_LE(run.count, Colours::longest_run);
        if (run.count <= 0) continue;
        EXPECT_TRUE(line == -1 || line == run.line) << "a row lies in one line";
        line = run.line;
        for (int n = 0; n < run.count; ++n) {
          const int place = run.place + 4 * n;
          if (run.line >= lines || place >= length) {
            ADD_FAILURE() << "beyond the lattice: " << run.line << ", " << place;
            continue;
          }
          int& cell = found[static_cast<std::size_t>(run.line * length + place)];
          EXPECT_EQ(cell, -1) << "two colours";
          cell = colour;
        }
      }
  return found;
}

void expect_no_shared_neighbour(int lines, int length, bool periodic) {
  const std::vector<int> found = colours_of(lines, length, periodic);
  const int steps[5][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  for (int line = 0; line < lines; ++line)
    for (int place = 0; place < length; ++place) {
      std::vector<int> around, cells;
      for (const auto& step : steps) {
        int l = line + step[0], p = place + step[1];
        if (periodic) {
          l = wrap(l, lines);
          p = wrap(p, length);
        } else if (l < 0 || l >= lines || p < 0 || p >= length) {
          continue;
        }
        const int cell = l * length + p;
        ASSERT_GE(found[static_cast<std::size_t>(cell)], 0) << "no colour: " << l << ", " << p;
        bool again = false;
        for (int known : cells) again = again || known == cell;  // narrow rings
        if (again) continue;
        for (int other : around)
          ASSERT_NE(other, found[static_cast<std::size_t>(cell)]) << lines << " x " << length;
        around.push_back(found[static_cast<std::size_t>(cell)]);
        cells.push_back(cell);
      }
    }
}

TEST(SlabColours, NoCellIsANeighbourOfTwoOfOne) {
  const int sizes[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 62, 64, 66, 67, 131};
  for (int lines : sizes)
    for (int length : sizes)
      for (bool periodic : {false, true}) expect_no_shared_neighbour(lines, length, periodic);
}

TEST(SlabColours, NeighboursAreFoundInMemory) {
  Lattice lattice{Downwind(Grid{24, 18, 1.0f, true, true}, {1, 0}),
                  0,
                  1,
                  1,
                  nullptr,
                  nullptr,
                  nullptr,
                  nullptr,
                  nullptr,
                  Lattice::quarter_of(18),
                  4 * Lattice::quarter_of(18),
                  nullptr,
                  1,
                  1};
  const Colours colours{{24, true}, {18, true}};
  std::vector<int> seen(Lattice::words(24, 18));
  for (int line = 0; line < 24; ++line)
    for (int place = 0; place < 18; ++place) {
      const int n = lattice.slot(line, place);
      EXPECT_EQ(seen[static_cast<std::size_t>(n)]++, 0);
      EXPECT_EQ(lattice.place_of_slot(n - line * lattice.pitch), place);
    }
  for (int colour = 0; colour < colours.count(); ++colour)
    for (int row = 0; row < colours.rows(colour); ++row)
      for (int column = 0; column < colours.columns(colour); ++column) {
        const auto run = colours.run(colour, column, row);
        for (int n = 0; n < run.count; ++n) {
          const int place = run.place + 4 * n, side = ((run.line ^ run.place) & 1) != 0 ? -1 : 1;
          const int expected[] = {
              lattice.slot_within(run.line + 1, place), lattice.slot_within(run.line, place + side),
              lattice.slot_within(run.line, place - side), lattice.slot_within(run.line - 1, place)};
          with_rolling(lattice, run, [&](const auto& rolling) {
            EXPECT_EQ(rolling.first + n, lattice.slot(run.line, place));
            for (int k = 0; k < 4; ++k)
              EXPECT_EQ(rolling.beside(n, k), expected[k]) << run.line << " " << place;
          });
        }
      }
}

}  // namespace
}  // namespace desert_sim::slabs
