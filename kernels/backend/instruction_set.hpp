#pragma once
/// The sets of instructions that loops on the CPU are compiled for, and which one is used (for_each_cpu.hpp).

#include <cstdlib>
#include <string>

namespace desert_sim {

// ---- Instruction sets: inner loops are compiled for several ones, and the widest that the processor has is
// chosen at run time. The compiler fuses no multiplication with an addition on any of them
// (-ffp-contract=off), so all give the same bits. An explicit fused() is one instruction on all but the
// generic one.

enum class InstructionSet { generic, avx2, avx512 };

constexpr const char* instruction_set_name(InstructionSet set) {
  return set == InstructionSet::generic ? "generic" : set == InstructionSet::avx2 ? "avx2" : "avx512";
}

/// Whether loops are compiled for it: with DESERT_PORTABLE=OFF for one set alone.
constexpr bool is_compiled(InstructionSet set) {
#if defined(DESERT_ONLY_INSTRUCTIONS)
  return set == InstructionSet::DESERT_ONLY_INSTRUCTIONS;
#else
  return set == InstructionSet::generic || set == InstructionSet::avx2 || set == InstructionSet::avx512;
#endif
}

inline InstructionSet widest_instructions() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return InstructionSet::generic;
  for (bool has : {__builtin_cpu_supports("avx512f") != 0, __builtin_cpu_supports("avx512dq") != 0,
                   __builtin_cpu_supports("avx512bw") != 0, __builtin_cpu_supports("avx512vl") != 0})
    if (!has) return InstructionSet::avx2;
  return InstructionSet::avx512;
#else
  return InstructionSet::generic;
#endif
}
/// The set that the environment's variable DESERT_CPU names (generic, avx2, avx512, or native: the widest
/// that the processor has, which is the default). All give the same bits; tests and benchmarks choose one.
inline InstructionSet chosen_instructions() {
  const char* const variable = std::getenv("DESERT_CPU");
  const std::string named = variable ? variable : "native";
  for (InstructionSet set : {InstructionSet::generic, InstructionSet::avx2, InstructionSet::avx512})
    if (named == instruction_set_name(set)) return set;
  return widest_instructions();
}
inline const InstructionSet instruction_set = chosen_instructions();

/// Why the loops of this build cannot run here; empty if they can.
inline std::string problem_with_instructions() {
  const char* const variable = std::getenv("DESERT_CPU");
  const std::string named = variable ? variable : "native", set = instruction_set_name(instruction_set);
  if (named != "native" && named != set)
    return "DESERT_CPU: '" + named + "' is not one of generic, avx2, avx512, native";
  if (instruction_set > widest_instructions())
    return "DESERT_CPU: this processor does not have the instructions '" + set + "' (it has '" +
           instruction_set_name(widest_instructions()) + "')";
  if (is_compiled(instruction_set)) return "";
  return "the loops of this build are not compiled for the instructions '" + set +
         "', which are this processor's, or those of DESERT_CPU: scripts/demo builds for the processor that "
         "it runs on; scripts/test, or cmake with -DDESERT_PORTABLE=ON, builds for all";
}

#if defined(__x86_64__)
#define DESERT_FOR_AVX2 __attribute__((noinline, target("avx2,fma")))
#define DESERT_AVX512 "avx512f,avx512dq,avx512bw,avx512vl,avx2,fma"
#define DESERT_FOR_AVX512 __attribute__((noinline, target(DESERT_AVX512)))
#if defined(__clang__)
#define DESERT_FOR_AVX512_MASKS DESERT_FOR_AVX2  // Clang has no attribute for the preferred width
#else
#define DESERT_FOR_AVX512_MASKS __attribute__((noinline, target(DESERT_AVX512 ",prefer-vector-width=256")))
#endif
#else
#define DESERT_FOR_AVX2
#define DESERT_FOR_AVX512
#define DESERT_FOR_AVX512_MASKS
#endif

}  // namespace desert_sim
