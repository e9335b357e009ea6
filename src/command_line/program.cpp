#include "src/command_line/program.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>

#include "src/core/error.hpp"

namespace desert_sim {

namespace {

/// How often a waiting thread looks for work before it sleeps: for about a tenth of a millisecond, as long as
/// most waits take. One that sleeps at once is late when it is woken, by a slice of any other program on its
/// processor.
constexpr const char* spins = "5000";

/// Does nothing if the user has chosen how threads wait, by OpenMP's variable or by one of GCC's runtime.
void make_waits_short(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
  // By its path, not by the link: the process would be called "exe" for those who look for it by its name.
  std::error_code missing;
  const std::string program = std::filesystem::read_symlink("/proc/self/exe", missing).string();
  if (setenv("OMP_WAIT_POLICY", "passive", 0) == 0 && setenv("GOMP_SPINCOUNT", spins, 0) == 0)
    execv(program.c_str(), argv);
  throw Error(std::string("the program cannot be executed anew with OMP_WAIT_POLICY=passive: ") +
              std::strerror(errno) + " (set OMP_WAIT_POLICY in the environment)");
}

void require_output_written() {
  std::cout.flush();
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  if (flushed && !std::ferror(stdout) && std::cout) return;
  throw Error(std::string("the standard output cannot be written") +
              (errno ? std::string(": ") + std::strerror(errno) : ""));
}

}  // namespace

int run_main(Options options, int argc, char** argv, const std::function<int(const Options&)>& body) {
  const char* const name = options.program().c_str();
  try {
    make_waits_short(argv);
    options.parse(argc, argv);
    int status = 0;
    if (options.help())
      std::cout << options.usage();
    else
      status = body(options);
    require_output_written();
    return status;
  } catch (const ConfigError& e) {
    std::fprintf(stderr, "%s: %s\n", name, e.what());
    return 2;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "%s: the host has not enough memory\n", name);
    return 3;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", name, e.what());
    return 3;
  }
}

}  // namespace desert_sim
