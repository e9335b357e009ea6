/// Says which set of instructions this processor has (DesertInstructions.cmake).
#include <cstdio>

#include "kernels/backend/instruction_set.hpp"

int main() {
  std::fputs(desert_sim::instruction_set_name(desert_sim::widest_instructions()), stdout);
}
