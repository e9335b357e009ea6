#pragma once
/// Pictures of results, drawn by scripts in Python with matplotlib: test/bench/roofline.py, plot_run.py.

#include <string>
#include <vector>

namespace desert_sim {

/// Has `script` write `picture` (PNG) from JSON results; the script is looked for beside the program, then
/// where the program was built from. Throws ConfigError that names `option` if it is not there, if there is
/// no python3, or if it fails.
void draw(const std::string& option, const std::string& script, const std::string& picture,
          const std::vector<std::string>& results);

}  // namespace desert_sim
