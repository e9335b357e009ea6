# shellcheck shell=bash
# Sourced by scripts/test for --sanitize: a build of its own with sanitizers, how they work and where they report.
# Every process reports into files, for nobody sees the exit status of a node; the test sanitizers.no_report, the
# last one, shows them and fails if there is any.

# Labels of tests that are too slow with sanitizers, or that have nothing for them to see: dunes (thousands of steps for
# statistics; the code is that of the other tests), timing. installed_package.* is left out, too: an outsider's program,
# built without sanitizers, cannot link what is built with them.
# shellcheck disable=SC2034 # for scripts/test
DESERT_SANITIZE_WITHOUT='^(dunes|timing)$'

desert_sanitize() { # address,undefined or thread: sets BUILD, DESERT_SANITIZE_CONFIGURE and the environment
  local reports known=$DESERT_ROOT/test/sanitizers
  export DESERT_PATIENCE=5 # everything takes its time
  BUILD=$BUILD-${1//,/-}
  reports=$BUILD/sanitizer_reports
  rm -rf "$reports"
  mkdir -p "$reports"
  # clang, because its OpenMP tells ThreadSanitizer which thread waits for which (Archer); that of GCC does not.
  # -O1 with the inlining of -O2 builds soon and runs well enough; asserts are on. clang warns of loops that it does
  # not vectorise when they are watched.
  DESERT_SANITIZE_CONFIGURE=("-DDESERT_SANITIZE=$1" -DDESERT_WITH_CUDA=OFF -DCMAKE_CXX_COMPILER=clang++
    "-DDESERT_PATIENCE=$DESERT_PATIENCE" -DDESERT_WERROR=OFF -DCMAKE_BUILD_TYPE=RelWithDebInfo "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -finline-functions -g1")
  export ASAN_OPTIONS="log_path=$reports/report:detect_stack_use_after_return=1:strict_string_checks=1"
  ASAN_OPTIONS+=:quarantine_size_mb=64 # of freed memory: a flood of 10 MB requests is to fit beside it
  export LSAN_OPTIONS="suppressions=$known/leak.supp:print_suppressions=0"
  export UBSAN_OPTIONS="log_path=$reports/report:print_stacktrace=1"
  # Libraries built without ThreadSanitizer: their locks count, but not what they read and write themselves, which they
  # order by atomic counters out of its sight. Our own code stays watched, also when they call it.
  export TSAN_OPTIONS="ignore_noninstrumented_modules=1:log_path=$reports/report:suppressions=$known/thread.supp:second_deadlock_stack=1"
}
