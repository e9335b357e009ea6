# Properties of single tests of dunes, which gtest_discover_tests() cannot set. ctest reads this file after the list of
# tests that the programs of dunes have.
set(number 0)
foreach(test IN LISTS kernels_dunes_tests_NAMES scenarios_dunes_tests_NAMES tools_dunes_tests_NAMES)
  math(EXPR cost "10 + (${number} % 20)") # tests of nodes, which have the same ones, run meanwhile
  math(EXPR number "${number} + 1")
  set_tests_properties(${test} PROPERTIES COST ${cost})
  if(test MATCHES "Barchans\\.OfOneSeed")
    set_tests_properties(${test} PROPERTIES FIXTURES_SETUP barchans)
  elseif(test MATCHES "Dunes\\.Barchan$")
    set_tests_properties(${test} PROPERTIES FIXTURES_REQUIRED "sanitizers;barchans")
  elseif(test MATCHES "Schemes\\.") # eight threads, one a seed. With PROCESSORS 2 ctest would start it last: never are two free
    set_tests_properties(${test} PROPERTIES COST 50)
  endif()
endforeach()
