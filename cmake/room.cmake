# twinbench_headers(<name> [OPTIONS ...] [HEADERS ...]): what nearly every source includes, read once for all targets that are
# compiled with the same options. Its definitions must be those of all of them.
function(twinbench_headers name)
  cmake_parse_arguments(HEADERS "" "" "OPTIONS;HEADERS" ${ARGN})
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/${name}.cc CONTENT "")
  add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/${name}.cc)
  target_compile_options(${name} PRIVATE ${HEADERS_OPTIONS})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json)
  target_precompile_headers(${name} PRIVATE
    <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory> <optional> <set> <span> <sstream> <string> <variant> <vector>
    <Eigen/Cholesky> <Eigen/Geometry> <fmt/format.h> ${PROJECT_SOURCE_DIR}/cmake/json_without_literals.h ${HEADERS_HEADERS})
endfunction()
get_target_property(fmt_definitions fmt::fmt INTERFACE_COMPILE_DEFINITIONS)
add_compile_definitions(${fmt_definitions})

# Optimised for a run; and where no loop sets a pace, in four fifths of the time.
set(TWINBENCH_UNHURRIED $<$<CONFIG:Release>:-O1>)
twinbench_headers(twinbench_headers_room)
twinbench_headers(twinbench_headers_unhurried OPTIONS ${TWINBENCH_UNHURRIED})

# twinbench_room(<name> [UNHURRIED] SOURCES a.cc ... [KERNELS b.cc ...] [ROOMS upstream ...] [LIBRARIES public ...]
#                [PRIVATE_LIBRARIES ...])
#
# One folder, one static library. ROOMS are the rooms it may include; tests/layers checks that the includes agree.
# KERNELS are sources whose loops set the pace of a run: compiled at -O3. The thread sanitizer does not look into them: which of a
# function's clones is taken is decided before it is up, and calling it then is a crash. libFuzzer does not count their branches,
# which tell it nothing. UNHURRIED: no loop here sets a pace.
function(twinbench_room name)
  cmake_parse_arguments(ROOM "UNHURRIED" "" "SOURCES;KERNELS;ROOMS;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  list(TRANSFORM ROOM_ROOMS PREPEND twinbench_)
  add_library(twinbench_${name} STATIC ${ROOM_SOURCES})
  list(LENGTH ROOM_SOURCES sources)
  if(sources GREATER CMAKE_UNITY_BUILD_BATCH_SIZE)  # batches of one size: a few sources left over would read all headers again
    math(EXPR batches "(${sources} + ${CMAKE_UNITY_BUILD_BATCH_SIZE} / 2) / ${CMAKE_UNITY_BUILD_BATCH_SIZE}")
    math(EXPR batch "(${sources} + ${batches} - 1) / ${batches}")
    set_target_properties(twinbench_${name} PROPERTIES UNITY_BUILD_BATCH_SIZE ${batch})
  endif()
  if(ROOM_KERNELS)
    add_library(twinbench_${name}_kernels OBJECT ${ROOM_KERNELS})
    target_include_directories(twinbench_${name}_kernels PRIVATE ${PROJECT_SOURCE_DIR})
    target_compile_options(twinbench_${name}_kernels PRIVATE
      $<IF:$<BOOL:${TWINBENCH_FUZZ}>,-O3;-fno-sanitize=fuzzer-no-link,$<$<CONFIG:Release>:-O3>> -fno-sanitize=thread)
    target_link_libraries(twinbench_${name}_kernels PRIVATE ${ROOM_ROOMS} ${ROOM_LIBRARIES} ${ROOM_PRIVATE_LIBRARIES})
    target_sources(twinbench_${name} PRIVATE $<TARGET_OBJECTS:twinbench_${name}_kernels>)
  endif()
  target_include_directories(twinbench_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/twinbench>)
  target_compile_features(twinbench_${name} INTERFACE cxx_std_20)
  set_target_properties(twinbench_${name} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY TWINBENCH_ROOMS twinbench_${name})
  target_link_libraries(twinbench_${name} PUBLIC ${ROOM_ROOMS} ${ROOM_LIBRARIES} PRIVATE ${ROOM_PRIVATE_LIBRARIES})
  if(ROOM_UNHURRIED)
    twinbench_unhurried(twinbench_${name})
  else()
    target_precompile_headers(twinbench_${name} REUSE_FROM twinbench_headers_room)
  endif()
endfunction()

# twinbench_unhurried(<target>): of a target that is no room.
function(twinbench_unhurried target)
  target_compile_options(${target} PRIVATE ${TWINBENCH_UNHURRIED})
  target_precompile_headers(${target} REUSE_FROM twinbench_headers_unhurried)
endfunction()

# twinbench_bench(<name> TEXT ... PROCEDURE ... TWIN ... SOURCES ...)
#
# A bench is a folder of four parts, and what each may include is checked by tests/layers: TEXT (names, keys, columns,
# effects) goes to the library bench_formats; PROCEDURE, how it is driven; TWIN, its simulation; SOURCES, all that is
# done with its readings, which sees of the twin only the header that makes it.
function(twinbench_bench name)
  cmake_parse_arguments(BENCH "" "" "TEXT;PROCEDURE;TWIN;SOURCES" ${ARGN})
  list(TRANSFORM BENCH_TEXT PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  target_sources(twinbench_bench_formats PRIVATE ${BENCH_TEXT})
  twinbench_room(${name}_procedure UNHURRIED SOURCES ${BENCH_PROCEDURE} ROOMS core procedure)
  twinbench_room(${name}_twin SOURCES ${BENCH_TWIN} ROOMS ${name}_procedure model sim
    PRIVATE_LIBRARIES nlohmann_json::nlohmann_json)
  twinbench_room(${name} SOURCES ${BENCH_SOURCES} ROOMS ${name}_twin plausible separate uncertainty plan diagnose report
    LIBRARIES nlohmann_json::nlohmann_json PRIVATE_LIBRARIES fmt::fmt Ceres::ceres)
endfunction()

# twinbench_test(<name> SOURCES a_test.cc ... [LIBRARIES ...] [SHARDS n] [COMPUTES] [SLOW] [WAITS] [ENVIRONMENT a=b ...])
#
# One test program a room, of the whole program as tests/CMakeLists.txt puts it together. ctest runs it in one process, or in SHARDS
# processes <name>.1, <name>.2 ... side by side. COMPUTES: works for seconds itself, and so is optimised after all. SLOW, WAITS,
# ENVIRONMENT: of twinbench_entry.
function(twinbench_test name)
  cmake_parse_arguments(TEST "COMPUTES;SLOW;WAITS" "SHARDS" "SOURCES;LIBRARIES;ENVIRONMENT" ${ARGN})
  add_executable(test_${name} ${TEST_SOURCES})
  target_link_libraries(test_${name} PRIVATE ${TEST_LIBRARIES} twinbench_kept_text GTest::gtest_main)
  twinbench_test_target(test_${name})
  if(TEST_COMPUTES)
    target_compile_options(test_${name} PRIVATE ${TWINBENCH_UNHURRIED})
    set_target_properties(test_${name} PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)
  endif()
  if(NOT TEST_SLOW)
    add_dependencies(fast_tests test_${name})
  endif()

  set(flags)
  foreach(flag SLOW WAITS)
    if(TEST_${flag})
      list(APPEND flags ${flag})
    endif()
  endforeach()
  if(NOT TEST_SHARDS)
    twinbench_entry(${name} ${flags} COMMAND test_${name} ENVIRONMENT ${TEST_ENVIRONMENT})
    return()
  endif()
  foreach(shard RANGE 1 ${TEST_SHARDS})
    math(EXPR index "${shard} - 1")
    twinbench_entry(${name}.${shard} ${flags} COMMAND test_${name}
      ENVIRONMENT ${TEST_ENVIRONMENT} GTEST_TOTAL_SHARDS=${TEST_SHARDS} GTEST_SHARD_INDEX=${index})
  endforeach()
endfunction()

# twinbench_test_target(<target>): a program or library of tests that uses the whole program. Not optimised: of a template that it has
# and the program too, each keeps its own.
function(twinbench_test_target target)
  target_link_libraries(${target} PUBLIC twinbench_whole GTest::gmock)
  target_compile_options(${target} PRIVATE ${TWINBENCH_OF_TESTS})
  target_precompile_headers(${target} REUSE_FROM twinbench_headers_of_tests)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
endfunction()

# twinbench_entry(<name> [SLOW] [WAITS] COMMAND program arguments ... [ENVIRONMENT a=b ...])
#
# One process of ctest. SLOW: above some 20 s; begun before the others, so that none is left alone at the end, and left out by
# `ctest -L fast`. WAITS: sleeps for most of its time (held clocks, watchdogs, servers), so it runs beside those that compute:
# it takes one of ctest's places and they two, and of 2 n + 1 places (tools/test) n compute while one waits. The time limit is
# for a process that hangs.
function(twinbench_entry name)
  cmake_parse_arguments(ENTRY "SLOW;WAITS" "" "COMMAND;ENVIRONMENT" ${ARGN})
  add_test(NAME ${name} COMMAND ${ENTRY_COMMAND})
  set(label fast)
  set(limit_s 600)
  if(TWINBENCH_FUZZ)
    set(limit_s 3600)
  endif()
  set(cost 0)
  set(places PROCESSORS 2)
  if(ENTRY_SLOW)
    set(label slow)
    math(EXPR limit_s "3 * ${limit_s}")
    set(cost 100)
  endif()
  if(ENTRY_WAITS)
    set(cost 200)
    set(places PROCESSORS 1 RESOURCE_LOCK waiting)
  endif()
  set_tests_properties(${name} PROPERTIES LABELS ${label} TIMEOUT ${limit_s} COST ${cost} ${places})
  set_tests_properties(${name} PROPERTIES ENVIRONMENT "${ENTRY_ENVIRONMENT}")
endfunction()
