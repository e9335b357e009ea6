# Third-party libraries: yaml-cpp and threads of every build; of the simulation OpenMP, FFTW3 (single precision), xxHash,
# Random123, JSON by nlohmann, CLI11, Eigen, OMPL.
find_package(Threads REQUIRED)
find_package(yaml-cpp QUIET)
if(NOT yaml-cpp_FOUND)
  message(FATAL_ERROR "desert_sim needs yaml-cpp: install libyaml-cpp-dev (the whole list is in scripts/dependencies.txt)")
endif()
add_library(desert::yaml_cpp INTERFACE IMPORTED GLOBAL)
if(TARGET yaml-cpp::yaml-cpp)
  set_property(TARGET desert::yaml_cpp PROPERTY INTERFACE_LINK_LIBRARIES yaml-cpp::yaml-cpp)
else()
  set_property(TARGET desert::yaml_cpp PROPERTY INTERFACE_LINK_LIBRARIES yaml-cpp)
endif()
if(DESERT_PARTS STREQUAL "client")
  return()
endif()

find_package(OpenMP REQUIRED COMPONENTS CXX)

# desert_find(<target> <header> <library or ""> <Debian package>): an imported target from a header and a library.
function(desert_find name header library package)
  find_path(DESERT_${name}_INCLUDE ${header} PATH_SUFFIXES eigen3)
  set(missing ${header})
  if(library)
    find_library(DESERT_${name}_LIBRARY ${library})
    set(missing "${header} or lib${library}")
  endif()
  mark_as_advanced(DESERT_${name}_INCLUDE DESERT_${name}_LIBRARY)
  if(NOT DESERT_${name}_INCLUDE OR (library AND NOT DESERT_${name}_LIBRARY))
    message(FATAL_ERROR "desert_sim needs ${missing}: install ${package} (the whole list is in scripts/dependencies.txt)")
  endif()
  add_library(desert::${name} INTERFACE IMPORTED GLOBAL)
  set_target_properties(desert::${name} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${DESERT_${name}_INCLUDE})
  if(library)
    set_target_properties(desert::${name} PROPERTIES INTERFACE_LINK_LIBRARIES ${DESERT_${name}_LIBRARY})
  endif()
endfunction()

desert_find(random123 Random123/philox.h "" librandom123-dev)
desert_find(nlohmann_json nlohmann/json.hpp "" nlohmann-json3-dev)
desert_find(cli11 CLI/CLI.hpp "" "libcli11-dev (Ubuntu 20.04 has no such package: put the folder include/CLI of \
github.com/CLIUtils/CLI11, version 1.9 or later, into /usr/local/include)")
desert_find(eigen Eigen/Core "" libeigen3-dev)
desert_find(xxhash xxhash.h xxhash libxxhash-dev)
file(STRINGS ${DESERT_xxhash_INCLUDE}/xxhash.h xxhash_minor REGEX "define XXH_VERSION_MINOR +[0-9]+")
if(xxhash_minor MATCHES " [0-7]$") # Ubuntu 20.04: XXH3 is there, but was not final, and shows on request only
  set(DESERT_OLD_XXHASH ON)
  set_property(TARGET desert::xxhash PROPERTY INTERFACE_COMPILE_DEFINITIONS XXH_STATIC_LINKING_ONLY)
  message(STATUS "desert_sim: xxHash is older than 0.8: state hashes differ from those of newer systems")
endif()
desert_find(fftw3f fftw3.h fftw3f libfftw3-dev)
find_library(DESERT_fftw3f_threads NAMES fftw3f_omp fftw3f_threads) # one thread without it
mark_as_advanced(DESERT_fftw3f_threads)
if(DESERT_fftw3f_threads)
  set_property(TARGET desert::fftw3f PROPERTY INTERFACE_LINK_LIBRARIES ${DESERT_fftw3f_threads} ${DESERT_fftw3f_LIBRARY})
endif()

# Not ${OMPL_LIBRARIES}, which on Debian name a library that is not installed with it; not /usr/include as a system's
# folder of its own, which would hide that of the compiler.
find_package(ompl QUIET)
find_library(DESERT_ompl_LIBRARY ompl HINTS ${OMPL_LIBRARY_DIRS})
mark_as_advanced(DESERT_ompl_LIBRARY)
if(ompl_FOUND AND DESERT_ompl_LIBRARY)
  # Debian 13 names folders of MPI that are not there, which CMake refuses.
  set(include_folders "")
  foreach(folder IN LISTS OMPL_INCLUDE_DIRS)
    if(IS_DIRECTORY "${folder}" AND NOT folder STREQUAL "/usr/include")
      list(APPEND include_folders "${folder}")
    endif()
  endforeach()
  add_library(desert::ompl INTERFACE IMPORTED GLOBAL)
  set_target_properties(desert::ompl PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${include_folders}"
    INTERFACE_LINK_LIBRARIES ${DESERT_ompl_LIBRARY})
elseif(DESERT_WITH_ROS)
  message(FATAL_ERROR "desert_sim needs OMPL: install libompl-dev (the whole list is in scripts/dependencies.txt)")
else() # a bare server with a GPU needs no planner
  desert_leave_out(desert_planner "no OMPL")
endif()
