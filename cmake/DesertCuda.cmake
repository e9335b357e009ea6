# Finds the CUDA toolkit, also where nvcc is not in PATH, and sets
#   DESERT_WITH_CUDA, DESERT_CUDA_ABOUT, DESERT_CUDA_LIBRARIES (runtime, cuFFT), DESERT_CUDA_OPTIONS (for nvcc).
include(CheckLanguage)
set(DESERT_CUDA_LIBRARIES "")
set(DESERT_CUDA_OPTIONS "")

set(cuda_missing "")
if(DESERT_WITH_CUDA)
  if(NOT CMAKE_CUDA_COMPILER)
    unset(CMAKE_CUDA_COMPILER CACHE) # look again
  endif()
  if(NOT CMAKE_CUDA_COMPILER AND NOT DEFINED ENV{CUDACXX})
    find_program(DESERT_NVCC nvcc HINTS $ENV{CUDA_PATH}/bin $ENV{CUDA_HOME}/bin /usr/local/cuda/bin /opt/cuda/bin)
    mark_as_advanced(DESERT_NVCC)
    if(DESERT_NVCC)
      set(ENV{CUDACXX} ${DESERT_NVCC})
    endif()
  endif()
  check_language(CUDA)
  if(NOT CMAKE_CUDA_COMPILER)
    set(cuda_missing "an nvcc that works (CUDACXX says where it is)")
  endif()
endif()
desert_decide(CUDA "${cuda_missing}" "")
if(NOT DESERT_WITH_CUDA)
  return()
endif()

# Architectures: what the user says; else the GPU of this machine; else 75, with PTX for all later ones.
if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES AND NOT DEFINED ENV{CUDAARCHS})
  set(architectures 75)
  if(NOT CMAKE_VERSION VERSION_LESS 3.24)
    execute_process(COMMAND nvidia-smi -L RESULT_VARIABLE no_gpu OUTPUT_QUIET ERROR_QUIET)
    if(no_gpu EQUAL 0)
      set(architectures native)
    endif()
  endif()
  set(CMAKE_CUDA_ARCHITECTURES ${architectures} CACHE STRING "GPU architectures to build for")
endif()
enable_language(CUDA)
set(CMAKE_CUDA_RUNTIME_LIBRARY Shared)
set(DESERT_CUDA_ABOUT "${CMAKE_CUDA_COMPILER_VERSION}, architectures ${CMAKE_CUDA_ARCHITECTURES}")

if(CMAKE_VERSION VERSION_LESS 3.18) # knows neither architectures nor C++17 for nvcc
  list(APPEND DESERT_CUDA_OPTIONS -std=c++17)
  foreach(architecture IN LISTS CMAKE_CUDA_ARCHITECTURES)
    list(APPEND DESERT_CUDA_OPTIONS
      "--generate-code=arch=compute_${architecture},code=[compute_${architecture},sm_${architecture}]")
  endforeach()
else()
  set(CMAKE_CUDA_STANDARD 17)
  set(CMAKE_CUDA_STANDARD_REQUIRED ON)
endif()

if(NOT CMAKE_VERSION VERSION_LESS 3.17)
  find_package(CUDAToolkit REQUIRED)
else() # FindCUDAToolkit came with CMake 3.17
  get_filename_component(cuda_bin ${CMAKE_CUDA_COMPILER} DIRECTORY)
  foreach(library IN ITEMS cudart cufft)
    find_library(DESERT_${library} ${library} HINTS ${cuda_bin}/../lib64 ${cuda_bin}/../lib)
    add_library(CUDA::${library} UNKNOWN IMPORTED)
    set_target_properties(CUDA::${library} PROPERTIES
      IMPORTED_LOCATION ${DESERT_${library}}
      INTERFACE_INCLUDE_DIRECTORIES "${CMAKE_CUDA_TOOLKIT_INCLUDE_DIRECTORIES}")
  endforeach()
endif()
set(DESERT_CUDA_LIBRARIES CUDA::cudart CUDA::cufft)
