#pragma once
/// Ledger of the mass balance: what has entered and left each material, in quanta. For every material
///
///   final − initial − in + out = 0
///
/// holds exactly. A conversion (such as abrasion, from bedrock to sand) counts as out of one material and
/// into another.

#include "kernels/backend/atomics.hpp"
#include "kernels/base/quanta.hpp"

namespace desert_sim {

enum class Material : int { bedrock, soil, sand, water, sediment, moisture };
constexpr int material_count = 6;
constexpr const char* material_names[material_count] = {"bedrock", "soil",     "sand",
                                                        "water",   "sediment", "moisture"};

/// Each account is spread over several words (striped), so that cells which book at the same time rarely add
/// to the same word.
struct LedgerView {
  static constexpr int stripes = 256;
  static constexpr int words = material_count * 2 * stripes;
  long long* words_on_device = nullptr;

  DESERT_HD void book_in(Material m, int cell, Quanta amount) const { book(m, 0, cell, amount); }
  DESERT_HD void book_out(Material m, int cell, Quanta amount) const { book(m, 1, cell, amount); }
  DESERT_HD void convert(Material from, Material to, int cell, Quanta amount) const {
    book_out(from, cell, amount);
    book_in(to, cell, amount);
  }

 private:
  DESERT_HD void book(Material m, int side, int cell, Quanta amount) const {
    if (amount == 0) return;
    const int account = static_cast<int>(m) * 2 + side;
    add_to_spread_sum(words_on_device + account * stripes, stripes, account, cell, amount);
  }
};

}  // namespace desert_sim
