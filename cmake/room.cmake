# twinbench_room(<name> SOURCES a.cc ... [ROOMS upstream ...] [LIBRARIES public ...] [PRIVATE_LIBRARIES ...])
#
# One folder, one static library. ROOMS are the rooms it may include; tests/layers checks that the includes agree.
function(twinbench_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;ROOMS;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  add_library(twinbench_${name} STATIC ${ROOM_SOURCES})
  target_include_directories(twinbench_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  foreach(room IN LISTS ROOM_ROOMS)
    target_link_libraries(twinbench_${name} PUBLIC twinbench_${room})
  endforeach()
  target_link_libraries(twinbench_${name} PUBLIC ${ROOM_LIBRARIES} PRIVATE ${ROOM_PRIVATE_LIBRARIES})
endfunction()

# twinbench_test(<name> SOURCES a_test.cc ... ROOMS room ... [LIBRARIES ...])
#
# One test program a room; ctest sees every TEST of it.
function(twinbench_test name)
  cmake_parse_arguments(TEST "" "" "SOURCES;ROOMS;LIBRARIES" ${ARGN})
  add_executable(test_${name} ${TEST_SOURCES})
  target_compile_definitions(test_${name} PRIVATE
    TWINBENCH_SOURCE_DIR="${PROJECT_SOURCE_DIR}" TWINBENCH_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data")
  foreach(room IN LISTS TEST_ROOMS)
    target_link_libraries(test_${name} PRIVATE twinbench_${room})
  endforeach()
  target_link_libraries(test_${name} PRIVATE ${TEST_LIBRARIES} GTest::gmock GTest::gtest_main)
  # Values as they print hold addresses where a type has no printer: names would differ from build to build.
  gtest_discover_tests(test_${name} TEST_PREFIX ${name}. NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60)
endfunction()

include(GoogleTest)
