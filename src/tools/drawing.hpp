#pragma once
/// Pictures of results, drawn by the Python scripts python/roofline.py and python/plot_run.py with
/// matplotlib.

#include <string>
#include <vector>

namespace desert_sim {

/// Runs `script`, which draws `picture` (PNG) from JSON results. The script is searched for in the program's
/// folder, then in the source tree. Throws ConfigError that names `option` if the script or python3 is
/// missing, or if the script fails.
void run_plot_script(const std::string& option, const std::string& script, const std::string& picture,
                     const std::vector<std::string>& results);

}  // namespace desert_sim
