# API reference: `cmake --build build --target api`, with Debian's doxygen. No part of the default build.
find_program(DOXYGEN doxygen)
if(NOT DOXYGEN)
  message(STATUS "twinbench API reference: left out (no doxygen)")
  return()
endif()
configure_file(docs/api/Doxyfile.in ${CMAKE_BINARY_DIR}/api/Doxyfile @ONLY)
add_custom_target(api
  COMMAND ${DOXYGEN} ${CMAKE_BINARY_DIR}/api/Doxyfile
  COMMAND ${CMAKE_COMMAND} -DLIST=${CMAKE_BINARY_DIR}/api/undocumented.txt -DPAGES=${CMAKE_BINARY_DIR}/api/html/index.html
          -P ${PROJECT_SOURCE_DIR}/cmake/api_told.cmake
  COMMENT "Writing the API reference" VERBATIM)
if(TWINBENCH_TESTS)  # some 3 s of one core
  add_test(NAME api COMMAND ${CMAKE_COMMAND} -DDOXYGEN=${DOXYGEN} -DCONFIGURATION=${CMAKE_BINARY_DIR}/api/Doxyfile
    -DPAGES=${CMAKE_BINARY_DIR}/api -P ${PROJECT_SOURCE_DIR}/cmake/api_check.cmake)
  set_tests_properties(api PROPERTIES LABELS "fast;api" TIMEOUT 300 PROCESSORS 2)
endif()
