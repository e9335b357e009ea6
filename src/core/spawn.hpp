#pragma once
/// Programs as child processes.

#include <spawn.h>
#include <sys/types.h>

#include <string>
#include <vector>

namespace desert_sim {

/// The group of a child: Ctrl-C in a terminal interrupts all processes of the group in front.
enum class ProcessGroup { of_parent, own };

/// Starts a program, which is searched for in $PATH, with its arguments and with these files, which are
/// destroyed. Returns 0 and sets `child`, or the error of posix_spawnp(3).
int spawn_program(pid_t& child, std::vector<std::string> words, posix_spawn_file_actions_t& files,
                  ProcessGroup group = ProcessGroup::of_parent);

}  // namespace desert_sim
