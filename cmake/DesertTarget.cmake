# How targets are made: one set of flags and one header path for all of them.
include(GNUInstallDirs)

option(DESERT_WERROR "Warnings are errors, as in CI: every compiler has warnings of its own" OFF)
option(DESERT_UNITY_BUILD "Compile sources many at a time where that takes half as long" ON)
option(DESERT_PORTABLE "Compile the loops of the physics for all processors; OFF: for the one that builds" ON)
option(DESERT_NATIVE "Use the instructions of the CPU that builds (-march=native); results stay the same bits" OFF)

set(DESERT_SANITIZE "" CACHE STRING "Sanitizers for all of the project's own code: address,undefined or thread")
# `undefined` leaves out the overflow that heights and depths could meet on their way to quanta.
string(REPLACE "undefined" "undefined,float-cast-overflow" DESERT_SANITIZERS "${DESERT_SANITIZE}")

# Headers are included by their path from the root of the repository: #include "kernels/wind/wind.hpp". Those of include/
# include each other as they are installed: #include "desert_sim/client/layer_map.hpp". What CMake generates
# (desert_sim/config.hpp, the presets) is below DESERT_GENERATED_DIR.
set(DESERT_GENERATED_DIR ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${DESERT_GENERATED_DIR}/desert_sim)

# Only loops over cells become faster with -O3; the rest compiles in a fifth less time without.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
if(NOT DESERT_SANITIZE)
  set(DESERT_LOOP_OPTIONS $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<NOT:$<CONFIG:Debug>>>:-O3>)
endif()

# Faster loops in the physics without changing a result: no errno from sqrt(), no floating-point traps.
set(DESERT_PHYSICS_OPTIONS
  $<$<COMPILE_LANGUAGE:CXX>:-fno-math-errno>
  $<$<COMPILE_LANGUAGE:CXX>:-fno-trapping-math>
  $<$<COMPILE_LANG_AND_ID:CXX,Clang>:-Wno-pass-failed> # not every law's loop can be one of vectors
  ${DESERT_LOOP_OPTIONS})
# Loop unswitching: a condition that no cell changes (whether there is a layer) is evaluated before a loop, of which
# there is then one for each outcome. doc/notebook/kernel_experiments.md, "Loop unswitching", says what it brings to which sources,
# and what it costs the compiler.
set(DESERT_UNSWITCH_OPTIONS $<$<CXX_COMPILER_ID:GNU>:--param=max-unswitch-insns=300>)

# desert_target(<target>): language, warnings and floating-point rules. No contraction, no fast-math:
# the CPU and the GPU round alike.
function(desert_target target)
  set_target_properties(${target} PROPERTIES
    CXX_STANDARD 17 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF
    POSITION_INDEPENDENT_CODE ON
    DEFINE_SYMBOL "" # a precompiled header of one library then serves others
    INSTALL_RPATH_USE_LINK_PATH ON
    INSTALL_RPATH "$ORIGIN;$ORIGIN/..;$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<BUILD_INTERFACE:${DESERT_GENERATED_DIR}>)

  set(host -Wall -Wextra -Wshadow -ffp-contract=off)
  if(DESERT_WERROR)
    list(APPEND host -Werror)
  endif()
  if(DESERT_NATIVE)
    list(APPEND host -march=native)
  endif()
  if(DESERT_SANITIZE)
    list(APPEND host -fsanitize=${DESERT_SANITIZERS} -fno-sanitize-recover=all -fno-omit-frame-pointer
      -D_GLIBCXX_ASSERTIONS)
    target_link_options(${target} PRIVATE -fsanitize=${DESERT_SANITIZERS})
  endif()
  target_compile_options(${target} PRIVATE "$<$<COMPILE_LANGUAGE:CXX>:${host}>")

  if(DESERT_WITH_CUDA)
    list(APPEND host -Wno-parentheses) # the host code that nvcc writes puts them round member pointers
    string(REPLACE ";" "," host "${host}")
    set(device -Xcompiler=${host} -fmad=false -prec-div=true -prec-sqrt=true --expt-relaxed-constexpr -lineinfo
      -Wno-deprecated-gpu-targets ${DESERT_CUDA_OPTIONS})
    if(DESERT_WERROR)
      list(APPEND device --Werror=all-warnings)
    endif()
    target_compile_options(${target} PRIVATE "$<$<COMPILE_LANGUAGE:CUDA>:${device}>")
  endif()
endfunction()

# Links what exists: without GDAL and OpenCV there is no desert_io, and so on.
function(desert_link target)
  set(scope PUBLIC)
  foreach(item IN LISTS ARGN)
    if(item MATCHES "^(PUBLIC|PRIVATE)$")
      set(scope ${item})
    elseif(TARGET ${item} OR NOT item MATCHES "^desert_")
      target_link_libraries(${target} ${scope} ${item})
    endif()
  endforeach()
endfunction()

# desert_unity(<target> <count>): so many of its sources become one translation unit, because most of their compile time
# goes into headers and templates that all of them use.
function(desert_unity target count)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${DESERT_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE ${count})
endfunction()

# desert_library(<target> [STATIC] [SEPARATE [<regex>]] FOLDERS <folder>... [EXCLUDE <regex>] [ONLY <regex>]
#                [LINK [PUBLIC|PRIVATE] <library>...])
# A library of all sources in and below the folders (.cu ones with CUDA only); none while the folders are empty.
# SEPARATE: its sources, or those that match, define the same names in namespaces of their own, or differ in options.
function(desert_library target)
  cmake_parse_arguments(arg "STATIC" "EXCLUDE;ONLY" "SEPARATE;FOLDERS;LINK" ${ARGN})
  set(sources "")
  foreach(folder IN LISTS arg_FOLDERS)
    file(GLOB_RECURSE found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
    list(APPEND sources ${found})
    if(DESERT_WITH_CUDA)
      file(GLOB_RECURSE found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cu)
      list(APPEND sources ${found})
    endif()
  endforeach()
  if(arg_EXCLUDE)
    list(FILTER sources EXCLUDE REGEX ${arg_EXCLUDE})
  endif()
  if(arg_ONLY)
    list(FILTER sources INCLUDE REGEX ${arg_ONLY})
  endif()
  if(NOT sources)
    message(STATUS "desert_sim: ${target} left out: no sources in ${arg_FOLDERS}")
    return()
  endif()
  if(arg_STATIC)
    add_library(${target} STATIC ${sources})
  else()
    add_library(${target} SHARED ${sources})
    set_property(GLOBAL APPEND PROPERTY DESERT_LIBRARIES ${target})
  endif()
  desert_target(${target})
  desert_link(${target} ${arg_LINK})
  if(NOT "SEPARATE" IN_LIST arg_KEYWORDS_MISSING_VALUES)
    desert_unity(${target} 24) # without a precompiled header, which would take as long as two of these units
    if(arg_SEPARATE)
      list(FILTER sources INCLUDE REGEX ${arg_SEPARATE})
      set_source_files_properties(${sources} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endif()
endfunction()

# desert_program(<target> SOURCE <file> LINK <library>...)
function(desert_program target)
  cmake_parse_arguments(arg "" "SOURCE" "LINK" ${ARGN})
  file(GLOB source CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${arg_SOURCE})
  if(NOT source)
    message(STATUS "desert_sim: ${target} left out: no ${arg_SOURCE}")
    return()
  endif()
  add_executable(${target} ${source})
  set_property(GLOBAL APPEND PROPERTY DESERT_PROGRAMS ${target})
  desert_target(${target})
  desert_link(${target} PRIVATE ${arg_LINK})
endfunction()

# desert_leave_out(<test> <why>): for the summary.
function(desert_leave_out test why)
  set_property(GLOBAL APPEND PROPERTY DESERT_LEFT_OUT "${test} (${why})")
endfunction()

# One line: what this build has, and why it lacks the rest; another one for tests that need more than is here.
function(desert_summary)
  foreach(part IN ITEMS CUDA IO ROS RVIZ)
    if(DESERT_WITH_${part})
      list(APPEND parts "${part} on (${DESERT_${part}_ABOUT})")
    else()
      list(APPEND parts "${part} OFF (${DESERT_${part}_ABOUT})")
    endif()
  endforeach()
  string(REPLACE ";" ", " parts "${parts}")
  message(STATUS "desert_sim ${PROJECT_VERSION}, ${CMAKE_BUILD_TYPE}: CPU on${DESERT_CPU_ABOUT}, ${parts}")
  get_property(left_out GLOBAL PROPERTY DESERT_LEFT_OUT)
  if(left_out)
    string(REPLACE ";" ", " left_out "${left_out}")
    message(STATUS "desert_sim: tests left out: ${left_out}")
  endif()
endfunction()
