# The simulation: all that DESERT_PARTS=client leaves out. Libraries, one a part, and programs.
include(cmake/DesertInstructions.cmake) # DESERT_ONLY_INSTRUCTIONS
include(cmake/DesertPresets.cmake) # config/species, climates, rovers and growth_curves, in desert_core

# ---- Libraries: one a part, sources by folder ---------------------------------------------------
desert_library(desert_physics SEPARATE FOLDERS kernels
  LINK PUBLIC desert_base OpenMP::OpenMP_CXX desert::random123 PRIVATE desert::fftw3f)
if(TARGET desert_physics)
  # What nearly all of its sources include, and half of the time that most of them take.
  target_precompile_headers(desert_physics PRIVATE <vector> ${PROJECT_SOURCE_DIR}/kernels/backend/loops.hpp
    ${PROJECT_SOURCE_DIR}/kernels/field/layers.hpp ${PROJECT_SOURCE_DIR}/src/core/parameter_table.hpp)
  target_compile_options(desert_physics PRIVATE ${DESERT_PHYSICS_OPTIONS})
  target_compile_definitions(desert_physics PRIVATE ${DESERT_ONLY_INSTRUCTIONS})
  set_source_files_properties(kernels/avalanching/avalanching.cpp kernels/avalanching/tile.cpp kernels/sand/saltation.cpp
    kernels/water/hydraulic_erosion.cpp kernels/water/shallow_water.cpp kernels/water/virtual_pipes.cpp
    kernels/wind/wind.cpp
    PROPERTIES COMPILE_OPTIONS "${DESERT_UNSWITCH_OPTIONS}"
    SKIP_PRECOMPILE_HEADERS ON) # GCC would take the --param of the header, and not say so
  target_link_libraries(desert_physics PUBLIC ${DESERT_CUDA_LIBRARIES})
  if(DESERT_WITH_CUDA)
    add_subdirectory(kernels)
    target_sources(desert_physics PRIVATE $<TARGET_OBJECTS:desert_physics_cuda>)
  endif()
endif()

desert_library(desert_core SEPARATE "/material_return\\.cpp$" FOLDERS src/terrain src/scenario src/simulation
  LINK PUBLIC desert_physics desert::eigen PRIVATE desert::xxhash)
if(TARGET desert_core)
  target_precompile_headers(desert_core PRIVATE <yaml-cpp/yaml.h> ${PROJECT_SOURCE_DIR}/src/scenario/scenario.hpp)
endif()

desert_library(desert_command_line STATIC FOLDERS src/command_line LINK PUBLIC desert_base PRIVATE desert::cli11)

desert_library(desert_dune_metrics SEPARATE FOLDERS src/metrics LINK PUBLIC desert_core) # what is measured of dunes: no ROS

desert_library(desert_rover FOLDERS src/rover LINK PUBLIC desert_core PRIVATE desert::xxhash) # rovers: no ROS

# Paths: no ROS, no physics. What follows them needs OMPL, and desert_run does not.
set(needs_ompl "/(navigator|navigator_planning|ompl_planner|pure_pursuit)\\.cpp$")
desert_library(desert_paths FOLDERS src/planner EXCLUDE ${needs_ompl} LINK PUBLIC desert_base)
if(TARGET desert::ompl)
  desert_library(desert_planner FOLDERS src/planner ONLY ${needs_ompl} LINK PUBLIC desert_paths PRIVATE desert::ompl)
endif()

desert_library(desert_render FOLDERS src/render LINK PUBLIC desert::eigen) # meshes and colours: no ROS, OGRE or Qt

if(DESERT_WITH_IO)
  desert_library(desert_io SEPARATE "/netcdf_file\\.cpp$" FOLDERS src/io
    LINK PUBLIC desert_core desert_render GDAL::GDAL desert::opencv)
  target_compile_definitions(desert_io PRIVATE DESERT_WITH_NETCDF=${DESERT_WITH_NETCDF})
  if(DESERT_WITH_NETCDF)
    target_link_libraries(desert_io PRIVATE desert::netcdf)
  endif()
endif()

set(left_out "")
if(NOT DESERT_WITH_IO)
  list(APPEND left_out mesh_obj height_files gazebo_world)
endif()
if(NOT DESERT_WITH_TINYGLTF)
  list(APPEND left_out mesh_glb)
endif()
string(REPLACE ";" "|" left_out "${left_out}")
desert_library(desert_export FOLDERS src/export EXCLUDE "/(${left_out})\\.cpp$" # for other programs
  LINK PUBLIC desert_core desert_render PRIVATE desert_io)
if(TARGET desert_export)
  target_compile_definitions(desert_export PRIVATE
    DESERT_WITH_IO=$<TARGET_EXISTS:desert_io> DESERT_WITH_TINYGLTF=${DESERT_WITH_TINYGLTF})
  if(DESERT_WITH_TINYGLTF)
    target_link_libraries(desert_export PRIVATE desert::tinygltf)
  endif()
endif()

if(DESERT_WITH_ROS)
  desert_library(desert_grid_map FOLDERS src/grid_map LINK PUBLIC desert_io) # for desert_run too: no roscpp
  desert_use_ros(desert_grid_map ${rosbag_storage_LIBRARIES} ${roscpp_serialization_LIBRARIES})
  desert_library(desert_ros FOLDERS src/ros EXCLUDE "/(desert_(sim|rover|planner)_(node|nodelet)|nav_core_plugin)\\.cpp$"
    LINK PUBLIC desert_command_line desert_export desert_grid_map desert_planner desert_rover desert_client)
  if(TARGET desert_ros)
    desert_use_ros(desert_ros)
    # GCC 12 takes empty functions of Boost, which clients of actions copy, for uninitialised ones.
    target_compile_options(desert_ros PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
    # It hands on what other libraries compute; -O2 takes a third longer to compile.
    target_compile_options(desert_ros PRIVATE $<$<CONFIG:Release>:-O1>)
    set_source_files_properties(src/ros/topics/layer_tile_message.cpp PROPERTIES COMPILE_OPTIONS "${DESERT_LOOP_OPTIONS}")
    desert_unity(desert_ros 37) # two units, one for each of two processors, because most of their time is ROS's headers
  endif()
  # Apart from desert_ros: what registers a plugin may only be loaded by who looks for plugins.
  desert_library(desert_nodelet FOLDERS src/ros/nodelet LINK PUBLIC desert_ros)
  find_package(nav_core QUIET)
  find_package(costmap_2d QUIET)
  if(nav_core_FOUND AND costmap_2d_FOUND) # the plugin for move_base, which nav_core_plugins.xml names
    desert_library(desert_nav_core FOLDERS src/ros/planner EXCLUDE "/(planner_|desert_).*" LINK PUBLIC desert_ros)
    target_include_directories(desert_nav_core SYSTEM PRIVATE ${nav_core_INCLUDE_DIRS} ${costmap_2d_INCLUDE_DIRS})
    target_link_libraries(desert_nav_core PRIVATE ${costmap_2d_LIBRARIES})
  endif()
endif()

if(DESERT_WITH_RVIZ) # one library of all plugins, which rviz_plugins.xml names
  desert_library(desert_rviz FOLDERS src/rviz LINK PUBLIC desert_client desert_render desert_base
    PRIVATE desert::random123 desert::yaml_cpp)
  desert_use_rviz(desert_rviz)
  desert_unity(desert_rviz 37)
endif()

# ---- Programs -----------------------------------------------------------------------------------
desert_library(desert_tools STATIC FOLDERS src/tools EXCLUDE "/desert_(run|bench|dunes|metrics|calibrate)\\.cpp$"
  LINK PUBLIC desert_command_line desert_core desert_dune_metrics desert_rover desert_paths desert_render desert_export
  desert_io desert_grid_map desert::nlohmann_json PRIVATE desert::xxhash)
if(TARGET desert_tools)
  target_compile_definitions(desert_tools PUBLIC
    DESERT_WITH_IO=$<TARGET_EXISTS:desert_io> DESERT_WITH_BAGS=$<TARGET_EXISTS:desert_grid_map>
    DESERT_WITH_NLOPT=${DESERT_WITH_NLOPT})
  if(DESERT_WITH_NLOPT)
    target_link_libraries(desert_tools PRIVATE desert::nlopt)
  endif()
  target_compile_definitions(desert_tools PRIVATE DESERT_PLOT_SCRIPTS="${PROJECT_SOURCE_DIR}/python")
endif()
desert_program(desert_run SOURCE src/tools/desert_run.cpp LINK desert_tools desert_io desert_core)
desert_program(desert_bench SOURCE src/tools/desert_bench.cpp LINK desert_tools desert_io desert_core)
desert_program(desert_dunes SOURCE src/tools/desert_dunes.cpp LINK desert_tools desert_io desert_core)
desert_program(desert_metrics SOURCE src/tools/desert_metrics.cpp LINK desert_tools desert_io desert_core)
desert_program(desert_calibrate SOURCE src/tools/desert_calibrate.cpp LINK desert_tools desert_io desert_core)
# desert_compare is a program in Python, which finds its modules beside itself, and the others beside this link.
file(MAKE_DIRECTORY ${DESERT_BIN_FOLDER})
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/python/desert_compare ${DESERT_BIN_FOLDER}/desert_compare SYMBOLIC)
if(DESERT_WITH_ROS)
  desert_program(desert_sim_node SOURCE src/ros/node/desert_sim_node.cpp LINK desert_ros)
  desert_program(desert_rover_node SOURCE src/ros/rover/desert_rover_node.cpp LINK desert_ros)
  desert_program(desert_planner_node SOURCE src/ros/planner/desert_planner_node.cpp LINK desert_ros)
endif()

# ---- What scripts/demo builds; with a display desert_rviz, too ------------------------------------
if(DESERT_WITH_ROS)
  add_custom_target(demo)
  add_dependencies(demo desert_sim_node desert_rover_node desert_planner_node ${PROJECT_NAME}_generate_messages)
endif()

# ---- Install, beside libraries, programs and config/ ---------------------------------------------
# For desert_bench --roofline, desert_run --plot and desert_dunes --plot.
install(PROGRAMS python/roofline.py python/plot_run.py python/plot_dunes.py DESTINATION ${DESERT_BIN_DESTINATION})
install(PROGRAMS python/desert_compare DESTINATION ${DESERT_BIN_DESTINATION})
install(DIRECTORY python/desert_comparison DESTINATION ${DESERT_BIN_DESTINATION}
  FILES_MATCHING PATTERN "*.py" PATTERN "page.html" PATTERN "Snakefile" PATTERN "__pycache__" EXCLUDE)
install(DIRECTORY launch rviz icons DESTINATION ${DESERT_SHARE_DESTINATION} USE_SOURCE_PERMISSIONS)
if(DESERT_WITH_ROS)
  install(FILES nav_core_plugins.xml nodelet_plugins.xml rviz_plugins.xml DESTINATION ${DESERT_SHARE_DESTINATION})
  catkin_install_python(PROGRAMS scripts/demo_headless.py scripts/demo_rover.py scripts/start_rviz.py
    scripts/teleop.py scripts/check_launch_arguments.py
    DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endif()
