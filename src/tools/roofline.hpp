#pragma once
/// A picture of results of desert_bench, drawn by test/bench/roofline.py (Python with matplotlib).

#include <string>
#include <vector>

namespace desert_sim {

/// Writes `picture` (PNG) from JSON results; the script is looked for beside the program, then where the
/// program was built from. Throws ConfigError if it is not there, if there is no python3, or if it fails.
void draw_roofline(const std::string& picture, const std::vector<std::string>& results);

}  // namespace desert_sim
