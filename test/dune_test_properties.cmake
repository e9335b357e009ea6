# Properties of single tests of dunes, which gtest_discover_tests() cannot set. ctest reads this file after the list of
# tests that the programs of dunes have.
foreach(test IN LISTS kernels_dunes_tests_NAMES scenarios_dunes_tests_NAMES)
  if(test MATCHES "Barchans\\.OfOneSeed")
    set_tests_properties(${test} PROPERTIES FIXTURES_SETUP barchans COST 3)
  elseif(test MATCHES "Dunes\\.Barchan$")
    set_tests_properties(${test} PROPERTIES FIXTURES_REQUIRED "sanitizers;barchans")
  elseif(test MATCHES "Schemes\\.") # eight threads, one a seed
    set_tests_properties(${test} PROPERTIES PROCESSORS 2 COST 20)
  endif()
endforeach()
