# DESERT_PARTS=client: what a robot's computer needs to talk to a simulation elsewhere, and no more: messages,
# TerrainClient, the testing kit and the Python module, without physics, GDAL, OpenCV, OMPL, NLopt, NetCDF and rviz.
set(DESERT_PARTS all CACHE STRING "all, or client: messages, TerrainClient, testing kit and Python module alone")
set_property(CACHE DESERT_PARTS PROPERTY STRINGS all client)
if(NOT DESERT_PARTS MATCHES "^(all|client)$")
  message(FATAL_ERROR "DESERT_PARTS: '${DESERT_PARTS}' is not one of all, client")
endif()

# Parts that a build may lack: CUDA, IO (GDAL, OpenCV), ROS, RVIZ (plugins). Each has DESERT_WITH_<part> = AUTO (there if its needs
# are, looked for anew by each configuration), ON (an error without them) or OFF.
foreach(part IN ITEMS CUDA IO ROS RVIZ)
  set(DESERT_WITH_${part} AUTO CACHE STRING "AUTO, ON or OFF")
  set_property(CACHE DESERT_WITH_${part} PROPERTY STRINGS AUTO ON OFF)
endforeach()

if(DESERT_PARTS STREQUAL "client")
  foreach(part IN ITEMS CUDA IO RVIZ)
    set(DESERT_WITH_${part} OFF) # not in the cache, which keeps what was asked of a whole build
  endforeach()
  set(DESERT_WITH_ROS ON)
endif()

# desert_decide(<part> <missing> <about>): makes DESERT_WITH_<part> ON or OFF, and DESERT_<part>_ABOUT say why.
macro(desert_decide part missing about)
  if(NOT DESERT_WITH_${part})
    set(DESERT_${part}_ABOUT "switched off")
    set(DESERT_WITH_${part} OFF)
  elseif("${missing}" STREQUAL "")
    set(DESERT_${part}_ABOUT "${about}")
    set(DESERT_WITH_${part} ON)
  elseif(DESERT_WITH_${part} STREQUAL "AUTO")
    set(DESERT_${part}_ABOUT "not found: ${missing}")
    set(DESERT_WITH_${part} OFF)
  else()
    message(FATAL_ERROR "desert_sim: DESERT_WITH_${part} is ON, but not found: ${missing}")
  endif()
endmacro()
