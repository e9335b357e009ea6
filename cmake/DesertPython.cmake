# catkin runs the first python3 of PATH. Where that one lacks catkin's modules (pyenv, conda) and the system's
# has them, take the system's. PYTHON_EXECUTABLE, when given, is left alone.
if(NOT DEFINED PYTHON_EXECUTABLE)
  foreach(python IN ITEMS python3 /usr/bin/python3)
    execute_process(COMMAND ${python} -c "import catkin_pkg, em, sys; print(sys.executable)"
      RESULT_VARIABLE failed OUTPUT_VARIABLE executable OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(failed EQUAL 0)
      set(PYTHON_EXECUTABLE ${executable} CACHE FILEPATH "The python3 that catkin runs")
      set(Python3_EXECUTABLE ${executable} CACHE FILEPATH "The python3 that catkin runs")
      break()
    endif()
  endforeach()
endif()

# Debian's own ROS packages have no setup.bash that would set these.
if(NOT DEFINED ENV{ROS_VERSION})
  set(ENV{ROS_VERSION} 1)
endif()
if(NOT DEFINED ENV{ROS_PYTHON_VERSION})
  set(ENV{ROS_PYTHON_VERSION} 3)
endif()
if(DEFINED ENV{ROS_DISTRO} AND NOT IS_DIRECTORY "/opt/ros/$ENV{ROS_DISTRO}")
  unset(ENV{ROS_DISTRO}) # Debian's catkin refuses a distribution that is not installed
endif()
