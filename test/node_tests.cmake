# Node tests: launch files that rostest runs. Each has a ROS master, parameters and files of its own. What measures
# rates or latencies has a name that ends in _timing, and the label `timing`.
find_package(rostest REQUIRED)

# desert_patient_launch(<out> <launch>): the launch file whose time limit is multiplied. A manager of nodelets, which is
# not built with AddressSanitizer, gets its runtime.
function(desert_patient_launch out launch)
  set(${out} ${launch} PARENT_SCOPE)
  file(STRINGS ${launch} limit REGEX "time-limit=\"[0-9]+\"")
  if(DESERT_PATIENCE EQUAL 1 OR NOT limit)
    return()
  endif()
  string(REGEX REPLACE ".*time-limit=\"([0-9]+)\".*" "\\1" limit "${limit}")
  math(EXPR longer "${limit} * ${DESERT_PATIENCE}")
  file(READ ${launch} text)
  string(REPLACE "time-limit=\"${limit}\"" "time-limit=\"${longer}\"" text "${text}")
  if(DESERT_SANITIZE MATCHES "address")
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=libclang_rt.asan-x86_64.so
      OUTPUT_VARIABLE runtime OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(REPLACE "args=\"manager\"" "args=\"manager\" launch-prefix=\"env LD_PRELOAD=${runtime}\"" text "${text}")
  endif()
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/${launch} "${text}")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${launch})
  set(${out} ${CMAKE_CURRENT_BINARY_DIR}/${launch} PARENT_SCOPE)
endfunction()

# desert_node_test(<launch> [DEPENDENCIES <target>...]): runs a launch file, its path relative to this folder.
function(desert_node_test launch)
  get_property(before DIRECTORY PROPERTY TESTS)
  desert_patient_launch(patient ${launch})
  add_rostest(${patient} ${ARGN})
  get_property(added DIRECTORY PROPERTY TESTS)
  list(REMOVE_ITEM added ${before})
  # rostest takes a test in Python that was killed, whose file of results is empty, for one without failures. A test
  # whose process does not heed its time limit is ended by ctest.
  file(STRINGS ${launch} limit REGEX "time-limit=\"[0-9]+\"" LIMIT_COUNT 1)
  string(REGEX REPLACE ".*time-limit=\"([0-9]+)\".*" "\\1" limit "${limit}")
  math(EXPR longest "(${limit} + 300) * ${DESERT_PATIENCE}")
  set_tests_properties(${added} PROPERTIES FAIL_REGULAR_EXPRESSION "test result file is empty;TESTS: 0" TIMEOUT ${longest})
  if(launch MATCHES "_timing\\.test$")
    set_tests_properties(${added} PROPERTIES LABELS timing RUN_SERIAL ON)
  else()
    # The longest begin first. Tests of nodes wait and tests of dunes compute: in the order of these costs they alternate,
    # see dune_test_properties.cmake.
    get_property(number GLOBAL PROPERTY DESERT_NODE_TESTS)
    if(NOT number)
      set(number 0)
    endif()
    math(EXPR cost "10 + (${number} % 20)")
    math(EXPR number "${number} + 1")
    set_property(GLOBAL PROPERTY DESERT_NODE_TESTS ${number})
    set_tests_properties(${added} PROPERTIES LABELS ros COST ${cost})
  endif()
endfunction()

# desert_node_program(<target>): what a GoogleTest node is built with. All use the precompiled header of
# desert_node_test_headers, which is therefore compiled as they are.
function(desert_node_program target)
  desert_test_target(${target})
  desert_use_ros(${target})
  desert_link(${target} PUBLIC desert_ros desert_client desert_testing)
  target_compile_definitions(${target} PRIVATE
    DESERT_NODE_BINARY="$<TARGET_FILE:desert_sim_node>" DESERT_ROVER_BINARY="$<TARGET_FILE:desert_rover_node>"
    DESERT_PLANNER_BINARY="$<TARGET_FILE:desert_planner_node>")
  # They wait for nodes: a fifth of their compile time would go into optimisation.
  if(NOT DESERT_SANITIZE)
    target_compile_options(${target} PRIVATE -O0)
  endif()
  # GCC 12 sees uninitialised memory in boost::function where that comes from a precompiled header.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  add_dependencies(${target} desert_sim_node desert_rover_node desert_planner_node)
endfunction()
add_library(desert_node_test_headers STATIC EXCLUDE_FROM_ALL support/ros/service_tests.cpp)
desert_node_program(desert_node_test_headers)
set_target_properties(desert_node_test_headers PROPERTIES POSITION_INDEPENDENT_CODE OFF)
target_compile_options(desert_node_test_headers PRIVATE -fPIE)
target_precompile_headers(desert_node_test_headers PRIVATE
  <tf2_geometry_msgs/tf2_geometry_msgs.h> <tf2_ros/transform_listener.h> support/ros/service_tests.hpp)

file(GLOB_RECURSE launches RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS src/*.test python/*.test
  launch/*.test examples/*.test)
list(FILTER launches EXCLUDE REGEX "grid_map_clients/|src/rviz/")
file(GLOB_RECURSE nodes CONFIGURE_DEPENDS src/*.cpp)
# Tests for which not every system has the packages.
set(move_base_plans_NEEDS costmap_2d navfn move_base)
set(move_base_rover_NEEDS ${move_base_plans_NEEDS} dwa_local_planner rotate_recovery)
foreach(launch IN LISTS launches)
  get_filename_component(name ${launch} NAME_WE)
  get_filename_component(folder ${launch} DIRECTORY)
  set(missing "")
  foreach(package IN LISTS ${name}_NEEDS)
    find_package(${package} QUIET)
    if(NOT ${package}_FOUND)
      string(APPEND missing " ${package}")
    endif()
  endforeach()
  if(missing)
    desert_leave_out(${name} "not found:${missing}")
    continue()
  endif()
  set(node ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/${name}.cpp)
  if(node IN_LIST nodes)
    add_executable(${name} EXCLUDE_FROM_ALL ${node})
    desert_node_program(${name})
    target_precompile_headers(${name} REUSE_FROM desert_node_test_headers)
    if(name STREQUAL nodelets)
      add_dependencies(${name} desert_nodelet) # which it loads by name
    endif()
    if(name MATCHES "_timing$")
      add_dependencies(timing_tests ${name})
    else()
      add_dependencies(tests ${name})
    endif()
    desert_node_test(${launch} DEPENDENCIES ${name})
  else()
    desert_node_test(${launch})
  endif()
endforeach()
