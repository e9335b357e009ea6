# Sets DESERT_WITH_ROS from what find_package(catkin) found.
set(ros_missing "")
if(DESERT_WITH_ROS)
  if(catkin_FOUND)
    foreach(component IN LISTS DESERT_ROS_COMPONENTS)
      if(NOT ${component}_FOUND)
        string(APPEND ros_missing " ${component}")
      endif()
    endforeach()
  else()
    set(ros_missing catkin)
  endif()
  if(NOT DESERT_WITH_IO AND NOT DESERT_PARTS STREQUAL "client")
    string(APPEND ros_missing " desert_io")
  endif()
  string(STRIP "${ros_missing}" ros_missing)
endif()
desert_decide(ROS "${ros_missing}" "catkin ${catkin_VERSION}, roscpp ${roscpp_VERSION}")

# catkin takes a snapshot of the environment for tests before the folders below exist, and then leaves them out
# of it (no `import desert_sim`): make them, and let it look again.
if(DESERT_WITH_ROS AND NOT IS_DIRECTORY "${CATKIN_DEVEL_PREFIX}/${PYTHON_INSTALL_DIR}")
  file(MAKE_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib ${CATKIN_DEVEL_PREFIX}/${PYTHON_INSTALL_DIR})
  safe_execute_process(COMMAND ${GENERATE_ENVIRONMENT_CACHE_COMMAND})
endif()

# desert_use_ros(<target> [<library>...]): ROS headers (as system ones), this package's messages, and the libraries;
# without any those of all components.
function(desert_use_ros target)
  set(libraries ${ARGN})
  if(NOT libraries)
    set(libraries ${catkin_LIBRARIES})
  endif()
  target_include_directories(${target} SYSTEM PUBLIC ${CATKIN_DEVEL_PREFIX}/include ${catkin_INCLUDE_DIRS})
  target_link_libraries(${target} PUBLIC ${libraries})
  foreach(dependency IN LISTS ${PROJECT_NAME}_EXPORTED_TARGETS catkin_EXPORTED_TARGETS)
    add_dependencies(${target} ${dependency})
  endforeach()
endfunction()
