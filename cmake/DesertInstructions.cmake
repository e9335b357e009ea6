# With DESERT_PORTABLE=OFF the loops of the physics are compiled for one set of instructions, the widest of the processor
# that builds, which takes half the time: DESERT_ONLY_INSTRUCTIONS is the definition that says so.
set(DESERT_ONLY_INSTRUCTIONS "")
set(DESERT_CPU_ABOUT " (for all processors)")
if(NOT DESERT_PORTABLE)
  try_run(instructions_run instructions_compiled ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR}/cmake/widest_instructions.cpp
    CMAKE_FLAGS -DINCLUDE_DIRECTORIES=${PROJECT_SOURCE_DIR} -DCMAKE_CXX_STANDARD=17
    RUN_OUTPUT_VARIABLE instructions)
  if(NOT instructions MATCHES "^(generic|avx2|avx512)$")
    message(FATAL_ERROR "desert_sim: DESERT_PORTABLE=OFF: cmake/widest_instructions.cpp does not say what this processor has")
  endif()
  unset(instructions_run CACHE) # looked for anew by each configuration
  set(DESERT_ONLY_INSTRUCTIONS DESERT_ONLY_INSTRUCTIONS=${instructions})
  set(DESERT_CPU_ABOUT " (for processors with ${instructions} only)")
endif()
