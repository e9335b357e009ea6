# What is installed, as packages outside find it.
# desert_outside_package(<name> <folder>): builds the package and runs its tests.
function(desert_outside_package name folder)
  add_test(NAME installed_package.${name}
    COMMAND ${CMAKE_CTEST_COMMAND}
      --build-and-test ${folder} ${CMAKE_CURRENT_BINARY_DIR}/installed_package_${name}
      --build-generator ${CMAKE_GENERATOR}
      --build-options -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} -DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}
        -DPYTHON_EXECUTABLE=${PYTHON_EXECUTABLE}
        "-DCMAKE_PREFIX_PATH=${prefixes}"
      --test-command sh -c
        "${CMAKE_COMMAND} --build . --target tests && ${CMAKE_CTEST_COMMAND} --output-on-failure --no-tests=error")
  set_tests_properties(installed_package.${name} PROPERTIES LABELS process TIMEOUT ${DESERT_TEST_TIMEOUT} COST 60)
endfunction()

# Not in the build folder: where that lies in the package, roslaunch would find each launch file twice.
string(MD5 build_id ${PROJECT_BINARY_DIR})
set(installed /tmp/desert_sim_installed_${build_id})
# By DESTDIR: wherever --prefix leads, catkin installs setup.bash and its like in the prefix of the configuration, which
# needs rights that testers may lack.
set(prefix ${installed}${CMAKE_INSTALL_PREFIX})
string(REPLACE ":" ";" prefixes "${prefix}:$ENV{CMAKE_PREFIX_PATH}")
add_test(NAME installed_package.install
  COMMAND ${CMAKE_COMMAND} -E env DESTDIR=${installed} ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR})
# The example, copied as its README says: nothing in it depends on where it lies.
set(example ${installed}_my_driver)
add_test(NAME installed_package.example_is_copied
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${PROJECT_SOURCE_DIR}/examples/my_driver ${example})
desert_outside_package(is_found ${CMAKE_CURRENT_SOURCE_DIR}/external_package)
desert_outside_package(my_driver ${example})
add_test(NAME installed_package.removed COMMAND ${CMAKE_COMMAND} -E remove_directory ${installed} ${example})
set_tests_properties(installed_package.install installed_package.example_is_copied PROPERTIES
  FIXTURES_SETUP installed_package)
set_tests_properties(installed_package.is_found installed_package.my_driver PROPERTIES
  FIXTURES_REQUIRED installed_package)
set_tests_properties(installed_package.removed PROPERTIES FIXTURES_CLEANUP installed_package)
