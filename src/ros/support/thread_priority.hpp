#pragma once
/// Names and priorities of threads. The threads of the CPU backend are started by the thread that makes
/// steps, and inherit both.

namespace desert_sim {

/// Sets the name (for top -H) and the niceness of the calling thread, unless it is as high already.
void set_name_and_niceness(const char* name, int niceness);
/// Sets the name of the calling thread, and lets it run only where no other thread wants to (SCHED_IDLE of
/// sched(7)): below every niceness.
void set_name_and_lowest_priority(const char* name);

}  // namespace desert_sim
