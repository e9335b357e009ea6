#pragma once
/// Names and priorities of threads. The threads of the CPU backend are started by the thread that makes
/// steps, and inherit both.

namespace desert_sim {

/// Sets the name (for top -H) and the niceness of the calling thread, unless it is as high already.
void set_name_and_niceness(const char* name, int niceness);

}  // namespace desert_sim
